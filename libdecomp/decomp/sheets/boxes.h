// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cells/cells.h"

#include <array>
#include <cstdint>
#include <vector>

namespace decomp::sheets {

/// How far a plane through a concave edge sweeps.
enum class Sweep {
    Local,   ///< until the face of the lattice that it runs in ends
    Global,  ///< through the whole lattice
};

/// All faces of the lattice between two cells.
struct LatticeFace {
    std::int32_t lower = -1;
    std::int32_t upper = -1;
    int axis = 0;
    int plane = 0;
    std::int32_t flood = -1;  ///< faces of one number hang together across their edges
    bool marked = false;      ///< the sweep cuts here
};

/// A box of the swept polycube.
struct Box {
    double volume_mm3 = 0;  ///< of its cells, in the shape
    std::array<int, 3> low{};
    std::array<int, 3> high{};  ///< one past the last cell
};

struct Boxes {
    std::vector<LatticeFace> faces;  ///< sorted by (lower, upper)
    std::vector<std::int32_t> box_of_cell;
    std::vector<Box> boxes;
};

/// Cuts the cells at every concave edge along both of its planes (the sweep) and groups what stays
/// together. Every box is convex in the lattice.
/// @param least_contact  cells that touch by less than this share of the smaller one's volume^(2/3)
/// are no neighbours
/// Cost O(faces^2) in the worst case, a few hundred faces. Deterministic.
[[nodiscard]] Boxes sweep(const cells::CellComplex& cells, Sweep how, double least_contact = 0.02);

}  // namespace decomp::sheets
