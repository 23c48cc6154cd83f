// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/part/judge.h"
#include "decomp/part/part.h"
#include "decomp/part/plane.h"

#include <vector>

/// Inside the room: where a part could be cut.
namespace decomp::pipeline {

struct Candidate {
    part::Plane plane;  ///< unit normal
    int direction = 0;  ///< index of the direction: candidates of one direction are alike
    bool natural =
        false;  ///< across a model axis or along a large flat: what a person would try first
    bool shared = false;  ///< cuts a neighbour already
    double event = 0;     ///< strength of the event that it stands at, 0 for an evenly spaced plane
};

/// Planes at events and at even spacing along each direction, the judge's own proposals, and necks
/// with their planes relaxed, the `known` ones, and the `mapped` ones. Deterministic; none touches
/// the ends of the part.
[[nodiscard]] std::vector<Candidate> candidates(const part::Part& part,
                                                const part::Verdict& verdict, int offsets,
                                                const std::vector<part::Plane>& known,
                                                const std::vector<part::Plane>& mapped);

}  // namespace decomp::pipeline
