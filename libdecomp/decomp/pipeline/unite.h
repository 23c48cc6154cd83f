// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"
#include "decomp/cut/complex.h"
#include "decomp/part/judge.h"
#include "decomp/part/part.h"

#include <cstdint>
#include <vector>

/// Inside the room: uniting neighbours with whose union the judge is content.
namespace decomp::pipeline {

/// A finished region of the complex.
struct Finished {
    std::int32_t region = 0;
    part::Part part;  ///< sources name regions as neighbours
    part::Verdict verdict;
};

/// Merges greedily, largest interface first, until no pair is left: the union must satisfy the
/// judge and need hardly more support, in proportion, than the two did apart. The result lists the
/// surviving regions.
/// @return number of merges
int unite_neighbours(cut::Complex& complex, std::vector<Finished>& finished,
                     const part::Judge& judge, Run& run);

}  // namespace decomp::pipeline
