// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/brep/read_brep.h"

class TopoDS_Shape;

/// Inside the module: what its files share.
namespace decomp::brep {

/// Sets the kernel up once for the process: silent, millimetres, and the reader's repair without
/// its quadratic steps.
void prepare_occt();

[[nodiscard]] Result<std::vector<Body>> read_with_occt(std::string_view bytes, FileKind kind,
                                                       std::string_view name,
                                                       const BrepReadOptions& options,
                                                       const Run& run);

/// Cuts a solid into triangles which share points along common edges.
/// @error brep.not_meshed a face defies the mesher
[[nodiscard]] Result<mesh::TriMesh> triangles_of(const TopoDS_Shape& solid, double deflection_mm,
                                                 double angle, const std::string& where);

[[nodiscard]] BodyFigures figures_of(const TopoDS_Shape& solid);

}  // namespace decomp::brep
