// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/stream/stream_program.h"
#include "decomp/base/result.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tools {

/// What was asked for on the command line.
struct StreamTarget {
    std::filesystem::path job;  ///< a job directory, or a program
    std::string plate;          ///< of a directory; empty: its only one
    std::string machine;        ///< empty: that of the job
    std::string material;
    std::vector<std::string> settings;
    std::string link;  ///< empty: the machine's own
    std::string port;  ///< "auto": the only one that fits
};

/// Program, proof hash, limits and link of a target; decisions of the operator are left alone.
/// @error job.*, profile.*, usage.stream, transport.not_found (no or several ports fit)
[[nodiscard]] decomp::Result<cam::stream::Request> stream_request(const StreamTarget& target);

}  // namespace tools
