// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/journal/journal.h"
#include "decomp/base/assert.h"
#include "decomp/base/file.h"

#include <array>
#include <charconv>
#include <cstdio>

namespace cam::journal {

namespace {

constexpr std::size_t kChecksumDigits = 8;

constexpr std::array<std::uint32_t, 256> crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t value = byte;
        for (int bit = 0; bit < 8; ++bit) {
            value = (value & 1U) != 0 ? 0xEDB88320U ^ (value >> 1U) : value >> 1U;
        }
        table.at(byte) = value;
    }
    return table;
}

/// CRC-32 of ISO 3309.
std::uint32_t crc32(std::string_view bytes) {
    static constexpr std::array<std::uint32_t, 256> kTable = crc_table();
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char byte : bytes) {
        crc = kTable.at((crc ^ static_cast<unsigned char>(byte)) & 0xFFU) ^ (crc >> 8U);
    }
    return ~crc;
}

/// The text of a record, if the line is record `number`.
bool read_line(std::string_view line, std::uint64_t number, std::string& text) {
    if (line.size() < kChecksumDigits + 2 || line[kChecksumDigits] != ' ') {
        return false;
    }
    std::uint32_t told = 0;
    const auto checksum = std::from_chars(line.data(), line.data() + kChecksumDigits, told, 16);
    const std::string_view rest = line.substr(kChecksumDigits + 1);
    if (checksum.ptr != line.data() + kChecksumDigits || told != crc32(rest)) {
        return false;
    }
    std::uint64_t counted = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), counted);
    if (error != std::errc{} || counted != number || end == rest.data() + rest.size() ||
        *end != ' ') {
        return false;
    }
    text = std::string(rest.substr(static_cast<std::size_t>(end - rest.data()) + 1));
    return true;
}

}  // namespace

std::string record_line(std::uint64_t number, std::string_view text) {
    DECOMP_ASSERT(text.find('\n') == std::string_view::npos);
    const std::string rest = std::to_string(number) + " " + std::string(text);
    std::array<char, 16> checksum{};
    std::snprintf(checksum.data(), checksum.size(), "%08x ", crc32(rest));
    return checksum.data() + rest + "\n";
}

Contents read_records(std::string_view bytes) {
    Contents contents;
    while (contents.whole_bytes < bytes.size()) {
        const std::string_view rest = bytes.substr(contents.whole_bytes);
        const std::size_t end = rest.find('\n');
        std::string text;
        if (end == std::string_view::npos ||
            !read_line(rest.substr(0, end), contents.records.size(), text)) {
            break;
        }
        contents.records.push_back(std::move(text));
        contents.whole_bytes += end + 1;
    }
    contents.torn_bytes = bytes.size() - contents.whole_bytes;
    return contents;
}

decomp::Result<Contents> read_journal(const std::filesystem::path& path) {
    const auto bytes = decomp::read_file(path);
    if (!bytes) {
        return decomp::fail(bytes.error());
    }
    return read_records(*bytes);
}

}  // namespace cam::journal
