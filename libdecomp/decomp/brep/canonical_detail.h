// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace decomp::brep {

/// The same STEP file with its entities renumbered from its roots down, in an order that their
/// contents alone decide: the kernel orders styles by their addresses in memory. Lines are wrapped
/// anew. The text must be as the kernel writes it. O(n log n)
[[nodiscard]] std::string canonical_step(std::string_view text);

}  // namespace decomp::brep
