// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cells/cells.h"

/// Inside the room: dividing tets at a plane of polycube space, and joining crumbs.
namespace decomp::cells {

/// Divides every tet that has corners strictly on both sides of the plane `axis` = coordinate.
/// Points within `on_plane` of it are moved onto it in polycube space. Edges are bisected in the
/// order of their ends, so neighbours agree on their common faces.
void divide_at(CellComplex& complex, int axis, double coordinate, double on_plane);

/// Joins cells below `least_mm3`, smallest first, with the neighbour that they touch most, and
/// numbers the cells anew. Needs `contacts`, and leaves them as they were.
void absorb_small(CellComplex& complex, double least_mm3);

}  // namespace decomp::cells
