// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/cut/complex.h"
#include "decomp/part/judge.h"
#include "decomp/pipeline/decompose.h"

#include <cstdint>
#include <vector>

/// Inside the room: from regions to numbered parts, the same way whoever cut them.
namespace decomp::pipeline {

/// The regions bottom up, then left to right, then front to back: how a person would number them.
[[nodiscard]] std::vector<std::int32_t> reading_order(const cut::Complex& complex,
                                                      double diagonal_mm, const Run& run);

/// The regions as parts, in this order, with the judge's word on each, which need not be good,
/// and the necks of their interfaces.
/// @error those of cut::Complex::assemble()
[[nodiscard]] Result<Decomposition> as_parts(const cut::Complex& complex,
                                             const std::vector<std::int32_t>& order,
                                             const part::Judge& judge, const Run& run);

}  // namespace decomp::pipeline
