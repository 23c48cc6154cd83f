// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/job_lines.h"
#include "cam/stream/modal.h"
#include "decomp/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace cam::stream {

/// What of the machine decides how its lines look.
struct WireOptions {
    Flavour flavour = Flavour::Print;
    std::size_t longest_line = 70;   ///< characters, without number and checksum
    double rapid_mm_per_min = 6000;  ///< for the time of moves without a feed
    bool parks = false;              ///< mills rise before a change of tool …
    double park_z_mm = 0;            ///< … to here, in machine coordinates
    double spin_up_s = 4;
};

/// A program as it goes over the wire.
struct WireJob {
    protocol::JobLines lines;
    /// Estimated seconds from the beginning to the end of every kTimeStep-th line, for the time
    /// that is left: straight moves at their feed, no acceleration, no heating.
    std::vector<float> seconds;
    double total_seconds = 0;
    ModalState end;  ///< after the last line

    static constexpr std::size_t kTimeStep = 64;

    /// Estimated seconds of the first `lines` lines.
    [[nodiscard]] double seconds_until(std::size_t lines) const;
};

/// Turns a program into what is sent: comments, numbers and spaces go; pauses (M0, M1) and changes
/// of tool (M6 on mills) become questions to the operator with the machine at rest, spindle and
/// coolant off and on again; at the end all motion is waited for and the position compared.
/// O(length).
/// @error stream.unreadable_line, stream.line_too_long, stream.forbidden_command (M110 and the
/// like, which would break the conversation; `$` lines), stream.relative_tool_change, stream.empty
[[nodiscard]] decomp::Result<WireJob> prepare(std::string_view program, const WireOptions& options);

/// As prepare(), for the lines from `first_line` (1-based) on, begun in the modes `state` that the
/// lines before have set; `preamble` goes ahead of them.
[[nodiscard]] decomp::Result<WireJob> prepare_rest(std::string_view program,
                                                   const WireOptions& options, long first_line,
                                                   const ModalState& state,
                                                   const std::vector<std::string>& preamble);

}  // namespace cam::stream
