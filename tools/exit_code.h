// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/error.h"

namespace tools {

inline constexpr int kOk = 0;
inline constexpr int kInternal = 1;
inline constexpr int kUsage = 2;
inline constexpr int kBadInput = 3;
inline constexpr int kInfeasible = 4;
inline constexpr int kProofFailed = 5;
inline constexpr int kInputOutput = 6;
inline constexpr int kDevice = 7;
inline constexpr int kCancelled = 130;

/// The exit code that stands for an error, by its dotted code: the longest entry of one table that
/// begins it.
[[nodiscard]] int exit_code(const decomp::Error& error);

}  // namespace tools
