// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/brep/read_brep.h"
#include "decomp/brep/write_step.h"

#include <mutex>

class TopoDS_Shape;

/// Inside the module: what its files share.
namespace decomp::brep {

/// Sets the kernel up once for the process: silent, millimetres, and the reader's repair without
/// its quadratic steps. Gives the lock under which the kernel must be used: it keeps its parameters
/// in statics.
[[nodiscard]] std::unique_lock<std::mutex> prepare_occt();

[[nodiscard]] Result<std::vector<Body>> read_with_occt(std::string_view bytes, FileKind kind,
                                                       std::string_view name,
                                                       const BrepReadOptions& options,
                                                       const Run& run);

[[nodiscard]] Result<StepFile> write_with_occt(const std::vector<StepBody>& bodies,
                                               const std::string& title, StepSchema schema,
                                               const Run& run);

/// The kernel's shape of a solid: a solid, or a compound where it has several outer shells.
[[nodiscard]] TopoDS_Shape shape_of(const solid::Solid& solid);

/// Cuts a solid into triangles which share points along common edges.
/// @error brep.not_meshed a face defies the mesher
[[nodiscard]] Result<mesh::TriMesh> triangles_of(const TopoDS_Shape& solid, double deflection_mm,
                                                 double angle, const std::string& where);

[[nodiscard]] BodyFigures figures_of(const TopoDS_Shape& solid);

}  // namespace decomp::brep
