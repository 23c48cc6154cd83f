// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/read_brep.h"
#include "decomp/io/formats.h"
#include "decomp/io/text_scanner.h"

#include <array>
#include <cstring>

namespace decomp::io {

namespace {

std::string extension_of(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    std::string out;
    if (dot != std::string_view::npos && name.find('/', dot) == std::string_view::npos) {
        for (const char c : name.substr(dot)) {
            out += lower(c);
        }
    }
    return out;
}

bool has_exact_stl_size(std::string_view bytes) {
    std::uint32_t count = 0;
    if (bytes.size() < 84) {
        return false;
    }
    std::memcpy(&count, bytes.data() + 80, 4);
    return bytes.size() == 84 + std::size_t{50} * count;
}

bool looks_like_text(std::string_view bytes) {
    for (const char c : bytes.substr(0, 512)) {
        if (c == '\0') {
            return false;
        }
    }
    return true;
}

bool looks_like_obj(std::string_view bytes, std::string_view name) {
    constexpr std::array<std::string_view, 10> kStatements{"v", "vn", "vt", "f",      "o",
                                                           "g", "s",  "l",  "mtllib", "usemtl"};
    const std::string_view word = TextScanner(bytes, name).word();
    for (const std::string_view statement : kStatements) {
        if (word == statement) {
            return true;
        }
    }
    return false;
}

}  // namespace

Result<Format> detect_format(std::string_view bytes, std::string_view name) {
    const std::string extension = extension_of(name);
    if (bytes.empty()) {
        return fail("io.empty", "the file is empty", std::string(name));
    }
    if (bytes.starts_with("PK\x03\x04")) {
        return Format::Threemf;
    }
    // A binary STL may begin with any 80 bytes, "solid" and "ply" among them: its length gives it
    // away.
    if (has_exact_stl_size(bytes)) {
        return Format::StlBinary;
    }
    if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) {
        return Format::Ply;
    }
    if (const auto kind = brep::kind_of(bytes)) {
        return *kind == brep::FileKind::Step ? Format::Step : Format::Brep;
    }
    if (extension == ".igs" || extension == ".iges") {
        return fail("io.unsupported", "IGES files are not read", std::string(name),
                    "save it as STEP");
    }
    if (extension == ".meshb") {
        return fail("io.unsupported", "binary Medit files are not read", std::string(name),
                    "save it as ASCII .mesh");
    }
    if (looks_like_text(bytes)) {
        const std::string_view word = TextScanner(bytes, name).word();
        if (word == "MeshVersionFormatted") {
            return Format::Medit;
        }
        if (word.ends_with("OFF") && word.size() <= 8) {
            return Format::Off;
        }
        if (equals_ignoring_case(word, "solid") || equals_ignoring_case(word, "facet")) {
            return Format::StlAscii;
        }
        if (extension == ".obj" || looks_like_obj(bytes, name)) {
            return Format::Obj;
        }
        if (extension == ".off") {
            return Format::Off;
        }
        if (extension == ".mesh") {
            return Format::Medit;
        }
    }
    if (extension == ".stl") {
        return Format::StlBinary;
    }
    return fail("io.unknown_format",
                "the content is none of STL, OBJ, OFF, PLY, 3MF, Medit, STEP and BREP",
                std::string(name), "convert it to one of these");
}

}  // namespace decomp::io
