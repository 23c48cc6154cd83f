// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

/// A shape seen along one direction, as heights on a grid, and what tools make of it. Good for
/// reach, never for the points of a path: a height map misses what lies between its samples.
namespace cam::check {

inline constexpr float kNothing = -std::numeric_limits<float>::infinity();

/// Heights at the points low + cell * (column, row); kNothing where the shape is not.
struct HeightMap {
    int columns = 0;
    int rows = 0;
    double cell_mm = 0.1;
    Eigen::Vector2d low_mm = Eigen::Vector2d::Zero();
    std::vector<float> z_mm;  ///< row by row

    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }

    [[nodiscard]] bool holds(int column, int row) const {
        return column >= 0 && row >= 0 && column < columns && row < rows;
    }

    [[nodiscard]] float at(int column, int row) const { return z_mm[index(column, row)]; }
};

/// Whether a direction is up or down in a frame whose rows are right, ahead, up (right-handed).
[[nodiscard]] Eigen::Matrix3d frame_looking_down(const Eigen::Vector3d& up);

struct RasterOptions {
    double cell_mm = 0.1;
    double border_mm = 0;  ///< kept free around the shape
};

/// The highest point of a closed mesh above each grid point, in the frame of `points`.
/// @param points  of the mesh, in a frame whose Z points to the tool
/// @error check.raster_too_large  more than 64 million cells
/// O(n + cells covered).
[[nodiscard]] decomp::Result<HeightMap> raster(const decomp::mesh::TriMesh& mesh,
                                               const std::vector<Eigen::Vector3d>& points,
                                               const RasterOptions& options);

/// How low the tip of a tool may go at each point: max over s of z(s) - profile(|q - s|), for a
/// profile that never falls with the radius, up to `radius_mm`. Exact on the grid. Blocks that
/// cannot raise the result are passed over.
[[nodiscard]] HeightMap lowest_tips(const HeightMap& map, double radius_mm,
                                    const std::function<double(double r_mm)>& profile);

/// The same for a flat disc, in O(cells * radius): max over a disc.
[[nodiscard]] HeightMap highest_in_disc(const HeightMap& map, double radius_mm);

/// The map at `factor` times the cell: the highest of each block.
[[nodiscard]] HeightMap coarser(const HeightMap& map, int factor);

}  // namespace cam::check
