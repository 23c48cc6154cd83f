// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cells/cells.h"
#include "decomp/cut/complex.h"
#include "decomp/part/part.h"
#include "decomp/sheets/sheets.h"

#include <cstdint>
#include <vector>

/// Inside the room: what the map says about regions of the complex.
namespace decomp::partition {

/// A point of the shape that knows its box.
struct Vote {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double weight_mm3 = 0;
    std::int32_t box = -1;
};

/// Votes for each box.
using Tally = std::vector<double>;

/// The box with most votes, the first of equals.
[[nodiscard]] std::int32_t winner(const Tally& tally);

/// A region with its surface and the votes in it.
struct Atom {
    std::int32_t region = -1;
    part::Part part;
    std::vector<std::uint32_t> votes;
    Tally tally;
};

/// All votes, and where they lie.
class Ballot {
  public:
    /// One vote for each sub-tet at its centre; flipped ones have next to none.
    Ballot(const cells::CellComplex& cells, const sheets::Sheets& sheets);

    [[nodiscard]] const std::vector<Vote>& votes() const { return votes_; }

    [[nodiscard]] double total_mm3() const { return total_mm3_; }

    /// Of each box, wherever its votes lie.
    [[nodiscard]] const Tally& of_boxes() const { return of_boxes_; }

    /// All votes as candidates for the regions.
    [[nodiscard]] std::vector<Atom> placed(const cut::Complex& complex,
                                           const std::vector<std::int32_t>& regions) const;

    /// These votes among these regions. When `plane` is given and there are two regions, the first
    /// below and the second above it, the plane alone decides.
    [[nodiscard]] std::vector<Atom> placed(const cut::Complex& complex,
                                           const std::vector<std::int32_t>& regions,
                                           const std::vector<std::uint32_t>& votes,
                                           const part::Plane* plane) const;

  private:
    std::vector<Vote> votes_;
    double total_mm3_ = 0;
    Tally of_boxes_;
};

}  // namespace decomp::partition
