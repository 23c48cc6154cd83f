// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/step_text_detail.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <string>
#include <vector>

namespace decomp::brep {

namespace {

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

struct Reference {
    std::uint64_t id = 0;
    std::size_t at = 0;
};

/// Reads the statements one after another; text in quotes and comments is passed over.
class StepText {
  public:
    StepText(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {}

    Status check() {
        at_ = bytes_.find("DATA");
        if (at_ == std::string_view::npos) {
            return fault("brep.unreadable", "the file has no data section", 0);
        }
        at_ = std::min(bytes_.find(';', at_), bytes_.size());
        while (at_ + 1 < bytes_.size()) {
            ++at_;
            skip_blanks();
            const std::size_t start = at_;
            if (bytes_.substr(at_).starts_with("ENDSEC")) {
                return check_references();
            }
            if (const Status read = statement(); !read) {
                return fault(read.error().code, read.error().message, start);
            }
        }
        return fault("brep.truncated", "the data section has no end", at_);
    }

  private:
    [[nodiscard]] Status fault(const std::string& code, const std::string& message,
                               std::size_t at) const {
        const auto lines = std::count(
            bytes_.begin(),
            bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(at, bytes_.size())), '\n');
        Error error{code,
                    message,
                    std::string(name_) + ":" + std::to_string(lines + 1),
                    "export or download the file again",
                    {}};
        return tl::unexpected<Error>(std::move(error));
    }

    void skip_blanks() {
        while (at_ < bytes_.size()) {
            if (is_blank(bytes_[at_])) {
                ++at_;
            } else if (bytes_.substr(at_).starts_with("/*")) {
                const std::size_t end = bytes_.find("*/", at_ + 2);
                at_ = end == std::string_view::npos ? bytes_.size() : end + 2;
            } else {
                return;
            }
        }
    }

    /// The number after '#', which stands at at_.
    bool number(std::uint64_t& id) {
        const char* begin = bytes_.data() + at_ + 1;
        const auto [end, error] = std::from_chars(begin, bytes_.data() + bytes_.size(), id);
        at_ += static_cast<std::size_t>(end - begin);
        return error == std::errc{};
    }

    /// "#12 = NAME(...)", up to its semicolon.
    Status statement() {
        std::uint64_t id = 0;
        if (at_ >= bytes_.size() || bytes_[at_] != '#' || !number(id)) {
            return fail("brep.unreadable", "no entity stands where one should");
        }
        defined_.push_back(id);
        ++at_;
        long depth = 0;
        char last = '\0';
        for (; at_ < bytes_.size(); ++at_) {
            const char c = bytes_[at_];
            if (c == '\'') {
                at_ = std::min(bytes_.find('\'', at_ + 1), bytes_.size());
            } else if (c == '/' && bytes_.substr(at_).starts_with("/*")) {
                skip_blanks();
                --at_;
            } else if (c == ';') {
                break;
            } else if (c == '#') {
                Reference reference{0, at_};
                if (!number(reference.id)) {
                    return fail("brep.unreadable", "a reference has no number");
                }
                references_.push_back(reference);
                last = '#';
            } else if (!is_blank(c)) {
                depth += c == '(' ? 1 : (c == ')' ? -1 : 0);
                last = c;
            }
        }
        if (at_ >= bytes_.size() || depth != 0 || last != ')') {
            return fail("brep.truncated", "entity #" + std::to_string(id) + " is not whole");
        }
        return {};
    }

    Status check_references() {
        std::sort(defined_.begin(), defined_.end());
        for (const Reference& reference : references_) {
            if (!std::binary_search(defined_.begin(), defined_.end(), reference.id)) {
                return fault("brep.unreadable",
                             "entity #" + std::to_string(reference.id) +
                                 " is referred to, but is not in the file",
                             reference.at);
            }
        }
        return {};
    }

    std::string_view bytes_;
    std::string_view name_;
    std::size_t at_ = 0;
    std::vector<std::uint64_t> defined_;
    std::vector<Reference> references_;
};

}  // namespace

Status check_step_text(std::string_view bytes, std::string_view name) {
    return StepText(bytes, name).check();
}

}  // namespace decomp::brep
