// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/cells/cells.h"
#include "decomp/cut/complex.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/sheets/sheets.h"
#include "decomp/tets/tet_mesh.h"

#include <cstdint>
#include <vector>

namespace decomp::partition {

/// Shares of gain are of the volume, shares of thickness of the diagonal.
struct PartitionOptions {
    cells::CellOptions cells;
    sheets::SheetOptions sheets;
    bool paper = false;  ///< planes of sides flattened one after the other: see paper_sheets()
    double least_gain_share = 0.002;       ///< volume that a cut must put right
    double least_thickness_share = 0.015;  ///< of what a cut puts right, and of a part
    double nudge_share = 3e-5;             ///< of the diagonal: how planes keep off the vertices
    bool limit_cuts = true;     ///< cut only those pieces of a cross-section that gain by it
    bool check_rounded = true;  ///< try other nudges until the rounded parts are sound
};

struct Figures {
    int cuts = 0;
    int limited_cuts = 0;         ///< along some pieces of a cross-section only
    int shifted_cuts = 0;         ///< beside a plane that would have taken off a tongue as well
    int skipped_tongues = 0;      ///< cuts that gain, but too thinly
    int healed = 0;               ///< pieces that went to a neighbour
    double healed_share = 0;      ///< of the volume
    double mislabeled_share = 0;  ///< of the votes: in a part that is not their box
    double lost_share = 0;        ///< of the votes: outside of the volume
    int collapsed_boxes = 0;      ///< boxes that no part stands for
};

/// A part of the partition.
struct BoxPart {
    std::int32_t region = -1;  ///< of Partition::complex
    std::int32_t box = -1;     ///< index in Sheets::boxes; -1: a body that the map does not know
    double votes_share = 0;    ///< of its votes: for its box
};

struct Partition {
    cut::Complex complex;  ///< its regions that are not empty are the parts
    cells::CellComplex cells;
    sheets::Sheets sheets;       ///< planes as they were cut
    std::vector<BoxPart> parts;  ///< by box, then by region
    Figures figures;
};

/// Cuts a volume into the boxes of its polycube. The parts are an exact partition whatever the map
/// is worth; Figures::mislabeled_share says what it was worth.
/// @param volume  closed, manifold, outward, free of self-intersection; need not be the surface of
/// the pair
/// @error those of cells_of() and of cut::Complex; run.cancelled
/// Cost about 0.3 s of CPU for 70k triangles, 20k tets and ten cuts. Serial.
[[nodiscard]] Result<Partition> partition(const mesh::TriMesh& volume, const tets::Pair& pair,
                                          const tets::Lattice& lattice,
                                          const PartitionOptions& options, Run& run);

}  // namespace decomp::partition
