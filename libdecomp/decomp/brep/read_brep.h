// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace decomp::brep {

enum class FileKind {
    Step,  ///< ISO 10303-21 text
    Brep,  ///< CASCADE topology, text
};

/// What the first bytes say; nothing for any other file. Loads nothing.
[[nodiscard]] std::optional<FileKind> kind_of(std::string_view bytes);

struct BrepReadOptions {
    std::optional<double> deflection_mm{};  ///< chord error at most; default_deflection_mm() unless
                                            ///< given; 1e-4 to 100
    double angle = 0.35;                    ///< turn between neighbouring chords at most, radians
    std::string body;                       ///< name of the body wanted; empty or "all": every one
    bool measured = false;                  ///< fill in Body::figures
};

/// What the kernel says of a body before it is cut into triangles.
struct BodyFigures {
    bool valid = false;   ///< the kernel's own check of topology and geometry
    bool closed = false;  ///< every shell is
    double volume_mm3 = 0;
    double area_mm2 = 0;
    Eigen::Vector3d min_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d max_mm = Eigen::Vector3d::Zero();
    std::size_t faces = 0;
    std::size_t planes = 0;
    std::size_t cylinders = 0;
    std::size_t cones = 0;
    std::vector<double> cylinder_radii_mm;  ///< one for each cylindrical face, sorted
};

/// One solid, placed where its assembly puts it.
struct Body {
    std::string name;  ///< the product's, made unique by " (2)"; "body 1" where the file has none
    std::optional<std::array<double, 3>> colour;  ///< sRGB, 0 to 1
    mesh::TriMesh mesh;                           ///< mm; closed wherever the solid is
    BodyFigures figures;                          ///< see BrepReadOptions::measured
};

/// A ten-thousandth of the diagonal, within 0.005 and 0.1 mm.
[[nodiscard]] inline double default_deflection_mm(double diagonal_mm) {
    constexpr double kOfDiagonal = 1e-4;
    return std::clamp(kOfDiagonal * diagonal_mm, 0.005, 0.1);
}

/// Reads the solids of a STEP file (AP203, AP214, AP242; any unit, turned into mm) or of a CASCADE
/// .brep file (numbers are taken as mm) and cuts them into triangles. Triangles of neighbouring
/// faces share the points of their common edge by topology, never by distance. Sheets and wires
/// beside solids are left out with a warning. Loads the geometry kernel on first use. The order of
/// bodies is the file's; the same file gives the same triangles.
/// @error brep.kernel, brep.truncated, brep.unreadable, brep.no_solid, brep.no_such_body,
/// brep.not_meshed, run.cancelled
/// Cost about 0.1 ms a face and 5 us a triangle.
[[nodiscard]] Result<std::vector<Body>> read_brep(std::string_view bytes, std::string_view name,
                                                  const BrepReadOptions& options, const Run& run);

}  // namespace decomp::brep
