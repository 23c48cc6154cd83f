// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/zip_directory.h"

#include <cstring>

namespace decomp::io {

namespace {

constexpr std::string_view kEnd("PK\x05\x06", 4);
constexpr std::string_view kEnd64("PK\x06\x06", 4);
constexpr std::string_view kEntry("PK\x01\x02", 4);
constexpr std::size_t kEntryBytes = 46;
constexpr std::uint32_t kSeeZip64 = 0xFFFFFFFF;

/// A little-endian number; nothing beyond the end.
template <class T>
std::optional<T> number_at(std::string_view bytes, std::size_t at) {
    if (at > bytes.size() || bytes.size() - at < sizeof(T)) {
        return std::nullopt;
    }
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

std::optional<std::uint64_t> start_of_directory(std::string_view archive) {
    const std::size_t end = archive.rfind(kEnd);
    if (end == std::string_view::npos) {
        return std::nullopt;
    }
    const auto start = number_at<std::uint32_t>(archive, end + 16);
    if (start != kSeeZip64) {
        return start;
    }
    const std::size_t end64 = archive.rfind(kEnd64);
    return end64 == std::string_view::npos ? std::nullopt
                                           : number_at<std::uint64_t>(archive, end64 + 48);
}

/// The unpacked size of one entry, which stands first in the zip64 field (id 1) when the short one
/// is full.
std::optional<std::uint64_t> size_of_entry(std::string_view archive, std::size_t entry,
                                           std::size_t name_bytes) {
    const auto size = number_at<std::uint32_t>(archive, entry + 24);
    if (size != kSeeZip64) {
        return size;
    }
    const std::size_t extra = entry + kEntryBytes + name_bytes;
    return number_at<std::uint16_t>(archive, extra) == 1
               ? number_at<std::uint64_t>(archive, extra + 4)
               : std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> unpacked_size(std::string_view archive) {
    const auto start = start_of_directory(archive);
    if (!start || *start > archive.size()) {
        return std::nullopt;
    }
    std::uint64_t sum = 0;
    auto at = static_cast<std::size_t>(*start);
    while (archive.substr(at, 4) == kEntry) {
        const auto name = number_at<std::uint16_t>(archive, at + 28);
        const auto extra = number_at<std::uint16_t>(archive, at + 30);
        const auto comment = number_at<std::uint16_t>(archive, at + 32);
        const auto size = size_of_entry(archive, at, name.value_or(0));
        if (!name || !extra || !comment || !size || *size > ~sum) {
            return std::nullopt;
        }
        sum += *size;
        at += kEntryBytes + *name + *extra + *comment;
        if (at > archive.size()) {
            return std::nullopt;
        }
    }
    return sum;
}

}  // namespace decomp::io
