// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/raw_log.h"

#include <array>
#include <cerrno>
#include <cstring>

namespace cam::stream {

decomp::Result<std::unique_ptr<RawLog>> RawLog::open(const std::filesystem::path& path,
                                                     std::uint64_t most_bytes) {
    std::unique_ptr<RawLog> log(new RawLog(path, most_bytes));
    log->file_ = std::fopen(path.c_str(), "we");
    if (log->file_ == nullptr) {
        return decomp::fail("file.unwritable",
                            std::string("cannot write the log: ") + std::strerror(errno),
                            path.string(), "check the folder, its permissions and the free space");
    }
    return log;
}

RawLog::~RawLog() {
    if (file_ != nullptr) {
        std::fclose(file_);
    }
}

void RawLog::sent(std::string_view bytes, std::chrono::nanoseconds since_start) {
    write('>', bytes, since_start);
}

void RawLog::received(std::string_view bytes, std::chrono::nanoseconds since_start) {
    write('<', bytes, since_start);
}

void RawLog::write(char direction, std::string_view bytes, std::chrono::nanoseconds since_start) {
    if (file_ == nullptr) {
        return;
    }
    std::string line = std::to_string(since_start / std::chrono::microseconds(1));
    line += ' ';
    line += direction;
    line += ' ';
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\n') {
            line += "\\n";
        } else if (c == '\r') {
            line += "\\r";
        } else if (c == '\\') {
            line += "\\\\";
        } else if (byte < 0x20 || byte >= 0x7F) {
            std::array<char, 8> text{};
            std::snprintf(text.data(), text.size(), "\\x%02x", byte);
            line += text.data();
        } else {
            line += c;
        }
    }
    line += '\n';
    std::fwrite(line.data(), 1, line.size(), file_);
    bytes_ += line.size();
    if (bytes_ > most_bytes_) {
        std::fclose(file_);
        std::error_code ignored;
        std::filesystem::rename(path_, path_.string() + ".1", ignored);
        file_ = std::fopen(path_.c_str(), "we");
        bytes_ = 0;
    }
}

}  // namespace cam::stream
