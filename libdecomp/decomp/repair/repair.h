// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace decomp::repair {

/// How much had to be done, from nothing to everything.
enum class Status {
    Clean,   ///< the surface is the input's; at most equal points were merged or all of it was
             ///< turned inside out
    Fixed,   ///< triangles were removed, added, split apart or turned; what was sound stayed where
             ///< it was
    United,  ///< closed shells that overlap were united exactly
    Wrapped  ///< the input was replaced by a surface wrapped around it; hausdorff_mm says how far
             ///< off it lies
};

/// "clean", "fixed", "united", "wrapped".
[[nodiscard]] std::string_view name_of(Status status);

struct RepairOptions {
    bool allow_wrap = true;  ///< false: what would be wrapped is an error instead
    double largest_hole_share =
        0.05;  ///< holes are closed up to this share of border edges among all edges; 0 to 1
    double near_share =
        1e-3;  ///< border points closer than this share of the diagonal may be merged; 0: never
    double wrap_detail_share =
        1.0 / 120;  ///< detail of a wrap as share of the diagonal; 1/1000 to 1/20
};

struct RepairReport {
    Status status = Status::Clean;
    std::vector<std::string> changes;  ///< each change in words with its figures, in the order made
    double volume_before_mm3 =
        0;  ///< signed sum over the input's triangles; means little where it is open
    double volume_after_mm3 = 0;
    double hausdorff_mm =
        0;  ///< largest distance between the two surfaces, over sample points; see README
    std::size_t shells = 0;  ///< closed surfaces of the result
    std::size_t voids = 0;   ///< those of them that bound a cavity
};

struct Repaired {
    mesh::TriMesh mesh;
    RepairReport report;
};

/// Makes a solid of triangles as they come from a file. The result is closed, 2-manifold, oriented
/// with its cavities inward and free of self-intersection (surfaces may touch in points and edges
/// that they share exactly).
///
/// Shells: closed surfaces are sorted by nesting. The outermost must face outward and is turned,
/// with all it contains, if it does not. Within, a shell that faces inward bounds a cavity; one
/// that faces outward inside solid is material twice and is dropped. Where single triangles had to
/// be turned the senses mean nothing, and nested shells alternate between solid and cavity.
/// @error repair.empty          no triangle with an area
/// @error repair.not_a_solid    the triangles enclose no volume: an open sheet, a Moebius band,
/// scattered triangles
/// @error repair.wrap_needed    only a wrap would close it and options.allow_wrap is false
/// @error repair.failed         a step left a surface that is no solid; nothing is returned
/// @error run.cancelled
/// Cost: 0.1 s for a clean mesh of 70 000 triangles; uniting some seconds; a wrap up to a minute.
/// Deterministic.
[[nodiscard]] Result<Repaired> repair(const mesh::TriMesh& soup, const RepairOptions& options,
                                      const Run& run);

}  // namespace decomp::repair
