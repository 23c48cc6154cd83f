// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/cut/cells.h"

namespace decomp::cut {

/// Fills empty cells with a volume; see Complex::from_volume.
[[nodiscard]] Status build_cells(const mesh::TriMesh& volume, Cells& cells);

}  // namespace decomp::cut
