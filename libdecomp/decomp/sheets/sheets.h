// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cells/cells.h"
#include "decomp/part/plane.h"
#include "decomp/sheets/boxes.h"
#include "decomp/sheets/fit.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace decomp::sheets {

/// Shares are of the diagonal of the shape.
struct SheetOptions {
    Sweep sweep = Sweep::Local;
    double split_rms_share = 0.01;   ///< a sheet of several boxes less flat than this is split
    double share_rms_share = 0.005;  ///< what each sheet of a plane may lose by sharing it
    double snap_angle = 0.0873;      ///< radians from a lattice axis within which planes snap to it
    double snap_rms_share = 0.002;   ///< what each sheet may lose by that
    double most_tilt = 0.8727;  ///< radians: a plane tilted farther off its axis takes the axis
    std::optional<Eigen::Matrix3d> axes =
        std::nullopt;  ///< columns: lattice axes in the model frame; none: axes_of()
};

/// A maximal set of marked faces of one lattice plane that hang together, or the part of it between
/// two boxes.
struct Sheet {
    int axis = 0;
    int level = 0;                    ///< index in Lattice::planes[axis]
    std::vector<std::int32_t> lower;  ///< boxes below it, ascending
    std::vector<std::int32_t> upper;  ///< boxes above it, ascending
    std::int32_t plane = -1;          ///< index in Sheets::planes
    double area_mm2 = 0;
    Residual residual;  ///< from its plane
    std::vector<Sample> samples;
    std::vector<Eigen::Vector3d> corners;  ///< paper_sheets(): the four corners of the side
};

struct SheetPlane {
    part::Plane plane;  ///< unit normal, towards the upper boxes; model frame
    int axis = 0;
    int level = 0;
    bool snapped = false;   ///< perpendicular to a lattice axis, because that costs little
    bool rejected = false;  ///< perpendicular to it, because the fit was tilted too far
};

struct Sheets {
    std::vector<std::int32_t> box_of_cell;
    std::vector<Box> boxes;
    std::vector<Sheet> sheets;
    std::vector<SheetPlane> planes;
    double diagonal_mm = 0;  ///< of the bounds of the pair's shape
};

/// How the axes of polycube space lie in the shape: columns, the rotation nearest to the mean
/// derivative of the map over unflipped tets, or the identity if that turns by less than 5 degrees.
[[nodiscard]] Eigen::Matrix3d axes_of(const cells::CellComplex& cells);

/// The boxes of the polycube, the sheets between them and their planes.
/// Cost O(pieces of sheets), about 10 ms for 20 sheets.
[[nodiscard]] Sheets sheets_of(const cells::CellComplex& cells, const SheetOptions& options);

/// The plane that fits the surface which the polycube plane `axis` = coordinate is mapped to within
/// some boxes. Nothing when it meets no tet of theirs.
[[nodiscard]] std::optional<part::Plane> mapped_plane(const cells::CellComplex& cells,
                                                      const std::vector<char>& cell_wanted,
                                                      int axis, double coordinate);

}  // namespace decomp::sheets
