// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cells/cells.h"
#include "decomp/sheets/sheets.h"
#include "decomp/tets/tet_mesh.h"

namespace decomp::sheets {

/// The boxes with a plane for each side between two of them, after section 5 of "Fabrication
/// Oriented Shape Decomposition Using Polycube Mapping": the four corners of every side are mapped
/// back through the tets by barycentric coordinates, then sides are flattened one after the other,
/// from the largest to its neighbours. A plane runs through the corners that lie on an earlier
/// plane (one: about that corner; two: about the pivot edge; three: it is given) and fits the free
/// ones; free corners are projected on it, corners on one earlier plane go to the common line,
/// corners on two to the common point. What the paper leaves open: where four corners are fixed
/// already, the plane fits them and they stay; a corner stays too where the planes are within 10
/// degrees of parallel or it would have to run farther than 5 % of the diagonal; a side whose
/// corners lie within 0.1 % of the diagonal of an earlier plane of its level takes that plane.
/// Sheets carry the corners as they ended, and their residual is that of these four corners. Cost
/// O(sides * tets) for the back-mapping.
[[nodiscard]] Sheets paper_sheets(const cells::CellComplex& cells, const tets::Lattice& lattice,
                                  const SheetOptions& options);

}  // namespace decomp::sheets
