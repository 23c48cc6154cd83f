// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/tets/tet_mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace decomp::cells {

struct CellOptions {
    double absorb_share = 0.01;  ///< of the volume: smaller cells join a neighbour
};

/// A block of the lattice as it lies in the shape: connected.
struct Cell {
    std::array<int, 3> index{};  ///< counted from 0 along each axis of polycube space
    double volume_mm3 = 0;
};

/// A piece of a tet that lies in one cell.
struct SubTet {
    tets::Tet corners{};
    std::int32_t cell = -1;
    double volume_mm3 = 0;
    bool flipped = false;  ///< inverted or flat in polycube space: no witness of where it belongs
};

/// A triangle between two cells that follow each other along one axis: a piece of the surface to
/// which a plane of the lattice is mapped.
struct SheetPiece {
    std::array<std::uint32_t, 3> corners{};
    int axis = 0;
    int plane = 0;            ///< index in Lattice::planes[axis]
    std::int32_t lower = -1;  ///< cell below the plane
    std::int32_t upper = -1;  ///< cell above it
    double area_mm2 = 0;
};

/// Two cells that touch.
struct Contact {
    std::int32_t a = -1;
    std::int32_t b = -1;  ///< a < b
    double area_mm2 = 0;
};

struct CellComplex {
    std::vector<Eigen::Vector3d> shape;     ///< mm, model frame
    std::vector<Eigen::Vector3d> polycube;  ///< one point for each of `shape`
    std::vector<SubTet> tets;
    std::vector<Cell> cells;
    std::vector<SheetPiece> pieces;
    std::vector<Contact> contacts;  ///< sorted by (a, b); of regular and irregular neighbours
    double volume_mm3 = 0;
    double fragment_share = 0;  ///< of the volume: in cells that were absorbed
    int fragments = 0;          ///< cells that were absorbed
    double flipped_share = 0;   ///< of the volume: in flipped tets
    int flipped = 0;            ///< tets of the pair that are flipped
};

/// Divides the pair at the inner planes of the lattice and groups what lies in one block. A pair
/// that is mirrored as a whole counts as unflipped.
/// @error cells.bad_pair     no tets, points of different number, an index out of range, or a
/// coordinate that is not finite
/// @error cells.bad_lattice  planes that are not ascending, or fewer than two along an axis
/// Cost O(n log n) in the sub-tets, about 10 ms for 10k tets. Serial.
[[nodiscard]] Result<CellComplex> cells_of(const tets::Pair& pair, const tets::Lattice& lattice,
                                           const CellOptions& options);

}  // namespace decomp::cells
