// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/cut/cells.h"

#include <cstdint>
#include <vector>

namespace decomp::cut {

/// Splits a region by a plane of the table; see Complex::split. On an error the cells are as
/// before.
[[nodiscard]] Result<std::vector<std::int32_t>> split_region(Cells& cells, std::int32_t region,
                                                             std::int32_t plane);

}  // namespace decomp::cut
