// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/io/text_scanner.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace decomp::io {

enum class PlyType { Char, UChar, Short, UShort, Int, UInt, Float, Double };

enum class PlyEncoding { Ascii, LittleEndian, BigEndian };

/// False where the word names no type.
bool ply_type(std::string_view word, PlyType& out);

bool ply_encoding(std::string_view word, PlyEncoding& out);

/// Reads the numbers of a PLY body one after another, in any of the three encodings.
class PlyCursor {
  public:
    PlyCursor(std::string_view bytes, std::size_t body, std::string_view name, PlyEncoding encoding)
        : bytes_(bytes), name_(name), at_(body), encoding_(encoding), text_(bytes, name, '\0') {
        if (encoding == PlyEncoding::Ascii) {
            text_.skip_to(body);
        }
    }

    bool read(PlyType type, double& out);

    /// Bytes left, an upper bound of the numbers left.
    [[nodiscard]] std::size_t rest() const {
        return encoding_ == PlyEncoding::Ascii ? text_.rest() : bytes_.size() - at_;
    }

    /// The next unreadable() will say that a list was longer than the file.
    void mark_absurd_list() { absurd_list_ = true; }

    [[nodiscard]] tl::unexpected<Error> error(std::string code, std::string message) const {
        return fail(std::move(code), std::move(message), where());
    }

    /// For a number that read() could not give.
    [[nodiscard]] tl::unexpected<Error> unreadable() const;

  private:
    [[nodiscard]] std::string where() const {
        return encoding_ == PlyEncoding::Ascii
                   ? text_.where()
                   : std::string(name_) + ": byte " + std::to_string(at_);
    }

    std::string_view bytes_;
    std::string_view name_;
    std::size_t at_;
    PlyEncoding encoding_;
    TextScanner text_;
    bool absurd_list_ = false;
};

}  // namespace decomp::io
