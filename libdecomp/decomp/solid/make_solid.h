// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/part/part.h"
#include "decomp/solid/solid.h"

#include <string>
#include <vector>

namespace decomp::solid {

/// What is looked for in a mesh besides its triangles.
enum class Detail {
    CutsAlone,  ///< the faces that cuts have made
    Flat,       ///< and flat regions
    Curved,     ///< and cylinders, cones and tori
};

struct SolidOptions {
    double tolerance_mm = 0.05;  ///< the solid stays within this of the mesh; above 0
    std::size_t max_faces =
        6000;  ///< triangles are joined, within the tolerance, until this is met
    Detail detail = Detail::Curved;
    bool force = false;  ///< more faces than max_faces are no error
};

/// How a solid came out of its mesh.
struct SolidReport {
    std::size_t triangles = 0;  ///< of the mesh
    std::size_t faces = 0;
    std::size_t planes = 0;  ///< faces of more than one triangle
    std::size_t cylinders = 0;
    std::size_t cones = 0;
    std::size_t tori = 0;
    std::size_t removed_points = 0;  ///< by joining triangles; 0: the mesh is kept as it is
    double decimation_mm = 0;        ///< largest distance between the mesh before and after that
    double moved_mm = 0;             ///< largest move of a vertex onto its surfaces
    double sagitta_mm = 0;  ///< largest distance between a recognised surface and its chords
};

struct MadeSolid {
    Solid solid;
    SolidReport report;
};

/// Makes a solid of a part's mesh: each cut face and each flat region becomes one planar face with
/// holes, strips that chord a cylinder or cone and bands that chord a torus become that surface,
/// every other triangle is a planar face. Edges are shared as in the mesh. Where surfaces cannot be
/// made to meet along lines, circles and ellipses within the tolerance, a region goes back to its
/// bands, strips or triangles. `part.sources` may be empty.
/// @error solid.not_closed, solid.too_many_faces, solid.unsound, run.cancelled
/// Cost O(n log n), about 20 us a triangle.
[[nodiscard]] Result<MadeSolid> make_solid(const part::Part& part, const SolidOptions& options,
                                           const Run& run);

}  // namespace decomp::solid
