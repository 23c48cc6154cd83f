// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace cam::stream {

/// Everything that went over the wire, with the time in microseconds since the beginning: a line
/// "TIME > TEXT" for what was sent and "TIME < TEXT" for what came, control bytes escaped. `hew sim
/// replay` plays the machine's side of it. When the file has grown to `most_bytes` it is renamed to
/// PATH.1 and begun anew.
class RawLog {
  public:
    /// Begins a log; an older one of that name is replaced. @error file.unwritable
    [[nodiscard]] static decomp::Result<std::unique_ptr<RawLog>> open(
        const std::filesystem::path& path, std::uint64_t most_bytes = 64U << 20U);

    RawLog(const RawLog&) = delete;
    RawLog& operator=(const RawLog&) = delete;
    RawLog(RawLog&&) = delete;
    RawLog& operator=(RawLog&&) = delete;
    ~RawLog();

    void sent(std::string_view bytes, std::chrono::nanoseconds since_start);
    void received(std::string_view bytes, std::chrono::nanoseconds since_start);

  private:
    explicit RawLog(std::filesystem::path path, std::uint64_t most_bytes)
        : path_(std::move(path)), most_bytes_(most_bytes) {}

    void write(char direction, std::string_view bytes, std::chrono::nanoseconds since_start);

    std::filesystem::path path_;
    std::uint64_t most_bytes_;
    std::uint64_t bytes_ = 0;
    std::FILE* file_ = nullptr;
};

}  // namespace cam::stream
