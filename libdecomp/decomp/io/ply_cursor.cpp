// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/ply_cursor.h"

#include <algorithm>
#include <array>
#include <utility>

namespace decomp::io {

namespace {

template <class T>
double value_of(const char* bytes, bool swap) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes, sizeof(T));
    if (swap) {
        std::reverse(raw.begin(), raw.end());
    }
    return static_cast<double>(std::bit_cast<T>(raw));
}

std::size_t size_of(PlyType type) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes.at(static_cast<std::size_t>(type));
}

double decode(PlyType type, const char* bytes, bool swap) {
    switch (type) {
        case PlyType::Char:
            return value_of<std::int8_t>(bytes, false);
        case PlyType::UChar:
            return value_of<std::uint8_t>(bytes, false);
        case PlyType::Short:
            return value_of<std::int16_t>(bytes, swap);
        case PlyType::UShort:
            return value_of<std::uint16_t>(bytes, swap);
        case PlyType::Int:
            return value_of<std::int32_t>(bytes, swap);
        case PlyType::UInt:
            return value_of<std::uint32_t>(bytes, swap);
        case PlyType::Float:
            return value_of<float>(bytes, swap);
        case PlyType::Double:
            break;
    }
    return value_of<double>(bytes, swap);
}

}  // namespace

bool ply_type(std::string_view word, PlyType& out) {
    constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{
        {{"char", PlyType::Char},
         {"int8", PlyType::Char},
         {"uchar", PlyType::UChar},
         {"uint8", PlyType::UChar},
         {"short", PlyType::Short},
         {"int16", PlyType::Short},
         {"ushort", PlyType::UShort},
         {"uint16", PlyType::UShort},
         {"int", PlyType::Int},
         {"int32", PlyType::Int},
         {"uint", PlyType::UInt},
         {"uint32", PlyType::UInt},
         {"float", PlyType::Float},
         {"float32", PlyType::Float},
         {"double", PlyType::Double},
         {"float64", PlyType::Double}}};
    for (const auto& [name, type] : kNames) {
        if (name == word) {
            out = type;
            return true;
        }
    }
    return false;
}

bool ply_encoding(std::string_view word, PlyEncoding& out) {
    if (word == "ascii") {
        out = PlyEncoding::Ascii;
    } else if (word == "binary_little_endian") {
        out = PlyEncoding::LittleEndian;
    } else if (word == "binary_big_endian") {
        out = PlyEncoding::BigEndian;
    } else {
        return false;
    }
    return true;
}

bool PlyCursor::read(PlyType type, double& out) {
    if (encoding_ == PlyEncoding::Ascii) {
        return text_.number(out);
    }
    const std::size_t size = size_of(type);
    if (bytes_.size() - at_ < size) {
        return false;
    }
    const bool file_is_little = encoding_ == PlyEncoding::LittleEndian;
    out = decode(type, bytes_.data() + at_,
                 file_is_little != (std::endian::native == std::endian::little));
    at_ += size;
    return true;
}

tl::unexpected<Error> PlyCursor::unreadable() const {
    if (absurd_list_) {
        return error("io.syntax", "a list with a negative length, or longer than the file");
    }
    if (encoding_ == PlyEncoding::Ascii) {
        return text_.expected("a number");
    }
    return fail("io.truncated", "the file ends within its data", where(),
                "save or download the file again");
}

}  // namespace decomp::io
