// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <functional>
#include <string>

namespace decomp::tets {

/// Runs `body` in a forked copy of this process and gives back the bytes that it returns. What it
/// changes, allocates or breaks dies with the copy. Only the calling thread lives on in the copy:
/// `body` must not wait for another one.
/// @error tets.failed  the copy could not be made, or it crashed
[[nodiscard]] Result<std::string> in_child_process(const std::function<std::string()>& body);

}  // namespace decomp::tets
