// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/zip_directory.h"

#include <zlib.h>

#include <array>
#include <cstring>

namespace decomp::io {

namespace {

constexpr std::string_view kEnd("PK\x05\x06", 4);
constexpr std::string_view kEnd64("PK\x06\x06", 4);
constexpr std::string_view kEntry("PK\x01\x02", 4);
constexpr std::string_view kLocal("PK\x03\x04", 4);
constexpr std::size_t kEntryBytes = 46;
constexpr std::size_t kLocalBytes = 30;
constexpr std::size_t kPieceBytes = 1 << 16;
constexpr std::uint16_t kStored = 0;
constexpr std::uint16_t kDeflated = 8;
constexpr std::uint16_t kZip64Field = 1;
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

/// The zip64 field (id 1) of an entry: its numbers stand in the order of those that are full.
std::size_t zip64_numbers(std::string_view archive, std::size_t extra, std::size_t extra_bytes) {
    const std::size_t end = extra + extra_bytes;
    while (extra + 4 <= end) {
        const auto id = number_at<std::uint16_t>(archive, extra);
        const auto bytes = number_at<std::uint16_t>(archive, extra + 2);
        if (!id || !bytes) {
            break;
        }
        if (*id == kZip64Field) {
            return extra + 4;
        }
        extra += 4 + std::size_t{*bytes};
    }
    return std::string_view::npos;
}

std::optional<ZipEntry> entry_at(std::string_view archive, std::size_t at, std::size_t name_bytes,
                                 std::size_t extra_bytes) {
    ZipEntry entry;
    const auto method = number_at<std::uint16_t>(archive, at + 10);
    const auto packed = number_at<std::uint32_t>(archive, at + 20);
    const auto unpacked = number_at<std::uint32_t>(archive, at + 24);
    const auto header = number_at<std::uint32_t>(archive, at + 42);
    if (!method || !packed || !unpacked || !header || at + kEntryBytes > archive.size()) {
        return std::nullopt;
    }
    entry.name = archive.substr(at + kEntryBytes, name_bytes);
    entry.method = *method;
    std::size_t wide = zip64_numbers(archive, at + kEntryBytes + name_bytes, extra_bytes);
    const auto whole = [&](std::uint32_t number) -> std::optional<std::uint64_t> {
        if (number != kSeeZip64) {
            return number;
        }
        if (wide == std::string_view::npos) {
            return std::nullopt;
        }
        const auto value = number_at<std::uint64_t>(archive, wide);
        wide += sizeof(std::uint64_t);
        return value;
    };
    const auto whole_unpacked = whole(*unpacked);
    const auto whole_packed = whole(*packed);
    const auto whole_header = whole(*header);
    if (!whole_unpacked || !whole_packed || !whole_header) {
        return std::nullopt;
    }
    entry.unpacked_bytes = *whole_unpacked;
    entry.packed_bytes = *whole_packed;
    entry.header_at = *whole_header;
    return entry;
}

/// The packed bytes of an entry, behind its local header.
std::optional<std::string_view> packed_bytes(std::string_view archive, const ZipEntry& entry) {
    if (entry.header_at > archive.size() ||
        archive.substr(static_cast<std::size_t>(entry.header_at), 4) != kLocal) {
        return std::nullopt;
    }
    const auto at = static_cast<std::size_t>(entry.header_at);
    const auto name = number_at<std::uint16_t>(archive, at + 26);
    const auto extra = number_at<std::uint16_t>(archive, at + 28);
    if (!name || !extra) {
        return std::nullopt;
    }
    const std::size_t begin = at + kLocalBytes + *name + *extra;
    if (begin > archive.size() || entry.packed_bytes > archive.size() - begin) {
        return std::nullopt;
    }
    return archive.substr(begin, static_cast<std::size_t>(entry.packed_bytes));
}

/// A raw deflate stream (RFC 1951).
bool inflate_all(std::string_view packed, std::uint64_t most,
                 const std::function<bool(std::string_view)>& take) {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) {
        return false;
    }
    std::array<char, kPieceBytes> piece{};
    std::uint64_t given = 0;
    std::size_t read = 0;
    int state = Z_OK;
    bool wanted = true;
    while (state == Z_OK && wanted) {
        if (stream.avail_in == 0 && read < packed.size()) {
            const std::size_t next = std::min(packed.size() - read, kPieceBytes);
            // zlib takes the input as writable, and leaves it alone.
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + read));
            stream.avail_in = static_cast<uInt>(next);
            read += next;
        }
        stream.next_out = reinterpret_cast<Bytef*>(piece.data());
        stream.avail_out = static_cast<uInt>(piece.size());
        state = inflate(&stream, Z_NO_FLUSH);
        const std::size_t got = piece.size() - stream.avail_out;
        given += got;
        if (given > most || state == Z_BUF_ERROR) {
            state = Z_DATA_ERROR;
        } else if (got > 0 && (state == Z_OK || state == Z_STREAM_END)) {
            wanted = take(std::string_view(piece.data(), got));
        }
    }
    inflateEnd(&stream);
    return state == Z_STREAM_END || !wanted;
}

}  // namespace

std::optional<std::vector<ZipEntry>> zip_entries(std::string_view archive) {
    const auto start = start_of_directory(archive);
    if (!start || *start > archive.size()) {
        return std::nullopt;
    }
    std::vector<ZipEntry> entries;
    auto at = static_cast<std::size_t>(*start);
    while (archive.substr(at, 4) == kEntry) {
        const auto name = number_at<std::uint16_t>(archive, at + 28);
        const auto extra = number_at<std::uint16_t>(archive, at + 30);
        const auto comment = number_at<std::uint16_t>(archive, at + 32);
        if (!name || !extra || !comment) {
            return std::nullopt;
        }
        std::optional<ZipEntry> entry = entry_at(archive, at, *name, *extra);
        if (!entry) {
            return std::nullopt;
        }
        entries.push_back(std::move(*entry));
        at += kEntryBytes + *name + *extra + *comment;
        if (at > archive.size()) {
            return std::nullopt;
        }
    }
    return entries;
}

bool unpack(std::string_view archive, const ZipEntry& entry,
            const std::function<bool(std::string_view)>& take) {
    const auto packed = packed_bytes(archive, entry);
    if (!packed) {
        return false;
    }
    if (entry.method == kStored) {
        if (packed->size() != entry.unpacked_bytes) {
            return false;
        }
        static_cast<void>(take(*packed));
        return true;
    }
    return entry.method == kDeflated && inflate_all(*packed, entry.unpacked_bytes, take);
}

}  // namespace decomp::io
