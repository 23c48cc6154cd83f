// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"
#include "decomp/part/judge.h"
#include "decomp/part/part.h"
#include "decomp/pipeline/decompose.h"

#include <memory>
#include <vector>

/// Inside the room: the search for planes, on stand-ins and in doubles. What it finds is a
/// proposal: the exact complex makes it true, or the search is asked again.
namespace decomp::pipeline {

struct PlannedCut;

/// A piece that a planned cut will give, and what to do with it.
struct PlannedPiece {
    bool above = false;
    double volume_mm3 = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of its bounds
    std::shared_ptr<PlannedCut> next;                  ///< null: leave it whole
};

struct PlannedCut {
    part::Plane plane;
    std::vector<PlannedPiece> pieces;
    double cost = 0;  ///< parts to come and penalties, summed over everything below
};

/// The shape of which the part is one.
struct Whole {
    double diagonal_mm = 0;
    double volume_mm3 = 0;
};

/// Planes worth a try, from whoever knows more about the part.
struct Hints {
    std::vector<part::Plane> known;   ///< that cut its neighbours
    std::vector<part::Plane> mapped;  ///< of the polycube, within its box
};

/// The best known way to cut a part with which the judge is not content: looks ahead along the most
/// promising planes until every piece is fine. Null when no plane makes progress.
/// @param root  what thinness and smallness are measured by
[[nodiscard]] std::shared_ptr<PlannedCut> plan_cut(const part::Part& part,
                                                   const DecomposeOptions& options,
                                                   const part::Judge& judge, const Whole& root,
                                                   const Hints& hints, Run& run);

}  // namespace decomp::pipeline
