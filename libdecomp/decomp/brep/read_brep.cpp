// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/read_brep.h"

#include "decomp/brep/kernel_detail.h"
#include "decomp/brep/step_text_detail.h"

#include <algorithm>
#include <cctype>

namespace decomp::brep {

namespace {

constexpr std::string_view kStepStart = "ISO-10303-21";
constexpr std::string_view kStepEnd = "END-ISO-10303-21";
constexpr std::string_view kBrepStart = "CASCADE Topology V";
constexpr std::size_t kHead = 256;

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (!text.empty() && blank(text.back())) {
        text.remove_suffix(1);
    }
    while (!text.empty() && blank(text.front())) {
        text.remove_prefix(1);
    }
    return text;
}

bool ends(std::string_view bytes, FileKind kind) {
    if (kind == FileKind::Step) {
        return bytes.rfind(kStepEnd) != std::string_view::npos;
    }
    // The last line names the root: sign and number of the shape, number of its location.
    const std::string_view body = trimmed(bytes);
    const std::string_view line = body.substr(body.rfind('\n') + 1);
    const bool digits = std::all_of(line.begin(), line.end(), [](char c) {
        return (c >= '0' && c <= '9') || c == ' ' || c == '+' || c == '-';
    });
    return digits && line.starts_with('+') && line.find(' ') != std::string_view::npos;
}

}  // namespace

std::optional<FileKind> kind_of(std::string_view bytes) {
    const std::string_view head = trimmed(bytes.substr(0, kHead));
    if (head.starts_with(kStepStart)) {
        return FileKind::Step;
    }
    if (head.starts_with(kBrepStart) ||
        (head.starts_with("DBRep_DrawableShape") && head.find(kBrepStart) != head.npos)) {
        return FileKind::Brep;
    }
    return std::nullopt;
}

Result<std::vector<Body>> read_brep(std::string_view bytes, std::string_view name,
                                    const BrepReadOptions& options, const Run& run) {
    const std::optional<FileKind> kind = kind_of(bytes);
    if (!kind) {
        return fail("brep.unreadable", "neither a STEP nor a CASCADE .brep file",
                    std::string(name));
    }
    if (!ends(bytes, *kind)) {
        return fail("brep.truncated", "the file ends before its contents do", std::string(name),
                    "save or download the file again");
    }
    if (*kind == FileKind::Step) {
        if (const Status whole = check_step_text(bytes, name); !whole) {
            return fail(whole.error());
        }
    }
    const auto loaded = kernel();
    if (!loaded) {
        return fail(loaded.error());
    }
    return (*loaded)->read(bytes, *kind, name, options, run);
}

}  // namespace decomp::brep
