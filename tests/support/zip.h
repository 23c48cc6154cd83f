// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Zip archives built in code (APPNOTE.TXT), for tests of readers.
namespace tests {

enum class ZipPacking { Stored, Deflated };

inline std::string deflated(const std::string& bytes) {
    z_stream stream{};
    deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, bytes.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

inline std::string little_endian(std::uint64_t value, int bytes) {
    std::string out;
    for (int i = 0; i < bytes; ++i) {
        out += static_cast<char>(value >> (8 * i));
    }
    return out;
}

inline std::string zip(const std::vector<std::pair<std::string, std::string>>& files,
                       ZipPacking packing) {
    std::string out;
    std::string directory;
    for (const auto& [name, bytes] : files) {
        const bool pack = packing == ZipPacking::Deflated;
        const std::string packed = pack ? deflated(bytes) : bytes;
        const auto crc =
            crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
        const std::string common =
            little_endian(20, 2) + little_endian(0, 2) + little_endian(pack ? 8 : 0, 2) +
            little_endian(0, 4) + little_endian(crc, 4) + little_endian(packed.size(), 4) +
            little_endian(bytes.size(), 4) + little_endian(name.size(), 2) + little_endian(0, 2);
        directory += "PK\x01\x02" + little_endian(20, 2) + common + little_endian(0, 2) +
                     little_endian(0, 2) + little_endian(0, 2) + little_endian(0, 4) +
                     little_endian(out.size(), 4) + name;
        out += "PK\x03\x04" + common + name + packed;
    }
    const std::size_t start = out.size();
    return out + directory + "PK\x05\x06" + little_endian(0, 4) + little_endian(files.size(), 2) +
           little_endian(files.size(), 2) + little_endian(directory.size(), 4) +
           little_endian(start, 4) + little_endian(0, 2);
}

}  // namespace tests
