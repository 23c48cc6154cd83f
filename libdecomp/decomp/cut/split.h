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

struct SectionPart;

/// The connected pieces of a region's cross-section; see Complex::section. The bodies on either
/// side are numbered in the order of the ids that split_region would return.
[[nodiscard]] Result<std::vector<SectionPart>> section_of(const Cells& cells, std::int32_t region,
                                                          std::int32_t plane);

/// Splits a region along some pieces of its section_of(); see Complex::split.
[[nodiscard]] Result<std::vector<std::int32_t>> split_region_at(
    Cells& cells, std::int32_t region, std::int32_t plane, const std::vector<SectionPart>& section,
    const std::vector<std::int32_t>& pieces);

}  // namespace decomp::cut
