// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <string_view>

namespace decomp::brep {

/// Checks what the kernel takes on trust: every statement of the data section is whole, and every
/// entity that one refers to is there (ISO 10303-21). O(n).
/// @error brep.truncated, brep.unreadable; `where` names the line
[[nodiscard]] Status check_step_text(std::string_view bytes, std::string_view name);

}  // namespace decomp::brep
