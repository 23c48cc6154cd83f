// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/height_map.h"

#include "decomp/base/number.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace cam::check {

using decomp::mesh::TriMesh;

namespace {

constexpr double kMostCells = 64e6;
constexpr double kOnEdge = 1e-9;  // of a triangle's area: grid points on an edge belong to it
constexpr int kBlock = 16;        // cells of a row that are treated together
constexpr float kBeyond = std::numeric_limits<float>::infinity();

/// One row of a kernel: heights of the profile at offsets -reach ... reach, padded to whole blocks.
struct KernelRow {
    int offset = 0;  ///< rows between tip and surface
    std::vector<float> height;
    std::vector<float> least;  ///< of each block of offsets
};

struct Kernel {
    int reach = 0;                ///< cells, a multiple of kBlock
    std::vector<KernelRow> rows;  ///< nearest first
};

Kernel kernel_of(double radius_mm, double cell_mm, const std::function<double(double)>& profile) {
    const int cells = static_cast<int>(std::floor(radius_mm / cell_mm));
    Kernel kernel;
    kernel.reach = (cells / kBlock + 1) * kBlock;
    for (int k = 0; k <= 2 * cells; ++k) {
        KernelRow row;
        row.offset = k % 2 == 0 ? k / 2 : -(k + 1) / 2;
        for (int i = -kernel.reach; i < kernel.reach; ++i) {
            const double r = std::hypot(i, row.offset) * cell_mm;
            row.height.push_back(r <= radius_mm ? static_cast<float>(profile(r)) : kBeyond);
        }
        for (auto block = row.height.begin(); block != row.height.end(); block += kBlock) {
            row.least.push_back(*std::min_element(block, block + kBlock));
        }
        kernel.rows.push_back(std::move(row));
    }
    return kernel;
}

/// Rows of a map with kNothing before and after, and the highest value of each pair of blocks.
class PaddedRows {
  public:
    PaddedRows(const HeightMap& map, int pad)
        : blocks_((map.columns + kBlock - 1) / kBlock + 2 * pad / kBlock + 2),
          values_(static_cast<std::size_t>(blocks_) * kBlock * static_cast<std::size_t>(map.rows),
                  kNothing),
          highest_(static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(map.rows),
                   kNothing) {
        for (int row = 0; row < map.rows; ++row) {
            std::copy_n(map.z_mm.data() + map.index(0, row), map.columns, values(row) + pad);
            const float* from = values(row);
            for (int block = 0; block < blocks_; ++block) {
                const float* first = from + std::ptrdiff_t{block} * kBlock;
                const int width = block + 1 < blocks_ ? 2 * kBlock : kBlock;
                highest_[at(row, block)] = *std::max_element(first, first + width);
            }
        }
    }

    /// The value of column i stands at values(row)[pad + i].
    [[nodiscard]] float* values(int row) {
        return values_.data() +
               static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks_) * kBlock;
    }

    /// Highest of this block and the next.
    [[nodiscard]] float highest(int row, int block) const { return highest_[at(row, block)]; }

  private:
    [[nodiscard]] std::size_t at(int row, int block) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks_) +
               static_cast<std::size_t>(block);
    }

    int blocks_;
    std::vector<float> values_;
    std::vector<float> highest_;
};

/// out[i] = max(out[i], from[i + k] - height[k]) for one block of outputs and one of offsets.
void raise(float* out, const float* from, const float* height) {
    for (int k = 0; k < kBlock; ++k) {
        const float lower = height[k];
        for (int i = 0; i < kBlock; ++i) {
            const float value = from[i + k] - lower;
            out[i] = out[i] > value ? out[i] : value;
        }
    }
}

/// A block of outputs, from the column `first` on.
struct Block {
    int first = 0;
    std::array<float, kBlock> best{};
    float worst = kNothing;  ///< of `best`
};

/// Raises a block by one row of the kernel, which lies over the row `source`.
void raise_block(Block& block, PaddedRows& rows, int source, const KernelRow& line) {
    const int chunks = static_cast<int>(line.least.size());
    for (int c = 0; c < chunks; ++c) {
        // Offsets of this chunk reach from block (first / kBlock + c) into the next.
        const float top = rows.highest(source, block.first / kBlock + c);
        if (!(top - line.least[static_cast<std::size_t>(c)] > block.worst)) {
            continue;
        }
        const std::ptrdiff_t offset = std::ptrdiff_t{c} * kBlock;
        raise(block.best.data(), rows.values(source) + block.first + offset,
              line.height.data() + offset);
        block.worst = *std::min_element(block.best.begin(), block.best.end());
    }
}

void raise_row(HeightMap& out, int row, PaddedRows& rows, const Kernel& kernel) {
    for (int first = 0; first < out.columns; first += kBlock) {
        Block block;
        block.first = first;
        block.best.fill(kNothing);
        for (const KernelRow& line : kernel.rows) {
            const int source = row + line.offset;
            if (source >= 0 && source < out.rows) {
                raise_block(block, rows, source, line);
            }
        }
        std::copy_n(block.best.data(), std::min(kBlock, out.columns - first),
                    out.z_mm.data() + out.index(first, row));
    }
}

/// A map around a box with nothing in it yet.
decomp::Result<HeightMap> empty_map(const Eigen::AlignedBox3d& box, const RasterOptions& options) {
    HeightMap map;
    map.cell_mm = options.cell_mm;
    if (box.isEmpty()) {
        return map;
    }
    map.low_mm = box.min().head<2>().array() - options.border_mm;
    const Eigen::Array2d size = box.sizes().head<2>().array() + 2 * options.border_mm;
    const Eigen::Array2d cells = (size / options.cell_mm).ceil() + 1;
    if (cells.prod() > kMostCells) {
        return decomp::fail("check.raster_too_large",
                            "a height map of cells of " + decomp::decimal(options.cell_mm, 3) +
                                " mm would have " + decomp::decimal(cells.prod() / 1e6, 0) +
                                " million of them",
                            {},
                            "choose larger cells: --set reach.cell_mm=0.3 --set "
                            "reach.tolerance_mm=0.3");
    }
    map.columns = static_cast<int>(cells.x());
    map.rows = static_cast<int>(cells.y());
    map.z_mm.assign(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows),
                    kNothing);
    return map;
}

/// Raises a map to the points of one triangle.
void raise_triangle(HeightMap& map, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                    const Eigen::Vector3d& c) {
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (!(area > 0)) {
        return;  // faces down or is a wall: something else is higher
    }
    const auto first = [&](int axis) {
        const double low = std::min({a[axis], b[axis], c[axis]}) - map.low_mm[axis];
        return static_cast<int>(std::ceil(low / map.cell_mm - kOnEdge));
    };
    const auto last = [&](int axis) {
        const double high = std::max({a[axis], b[axis], c[axis]}) - map.low_mm[axis];
        return static_cast<int>(std::floor(high / map.cell_mm + kOnEdge));
    };
    const int last_row = std::min(last(1), map.rows - 1);
    const int last_column = std::min(last(0), map.columns - 1);
    for (int row = std::max(0, first(1)); row <= last_row; ++row) {
        const double y = map.low_mm.y() + row * map.cell_mm;
        for (int column = std::max(0, first(0)); column <= last_column; ++column) {
            const double x = map.low_mm.x() + column * map.cell_mm;
            const double u = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
            const double w = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
            if (u < -kOnEdge || w < -kOnEdge || u + w > 1 + kOnEdge) {
                continue;
            }
            float& z = map.z_mm[map.index(column, row)];
            z = std::max(z, static_cast<float>(a.z() + u * (b.z() - a.z()) + w * (c.z() - a.z())));
        }
    }
}

}  // namespace

Eigen::Matrix3d frame_looking_down(const Eigen::Vector3d& up) {
    // The model axis that is farthest from `up` gives the right, so that equal directions give
    // equal frames.
    int axis = 0;
    up.cwiseAbs().minCoeff(&axis);
    const Eigen::Vector3d right = (Eigen::Vector3d::Unit(axis) - up[axis] * up).normalized();
    Eigen::Matrix3d frame;
    frame.row(0) = right;
    frame.row(1) = up.cross(right);
    frame.row(2) = up;
    return frame;
}

decomp::Result<HeightMap> raster(const TriMesh& mesh, const std::vector<Eigen::Vector3d>& points,
                                 const RasterOptions& options) {
    Eigen::AlignedBox3d box;
    for (const auto& t : mesh.triangles) {
        for (const std::uint32_t v : t) {
            box.extend(points[v]);
        }
    }
    auto map = empty_map(box, options);
    if (!map) {
        return map;
    }
    for (const auto& t : mesh.triangles) {
        raise_triangle(*map, points[t[0]], points[t[1]], points[t[2]]);
    }
    return map;
}

HeightMap lowest_tips(const HeightMap& map, double radius_mm,
                      const std::function<double(double r_mm)>& profile) {
    const Kernel kernel = kernel_of(radius_mm, map.cell_mm, profile);
    PaddedRows rows(map, kernel.reach);
    HeightMap out = map;
    for (int row = 0; row < map.rows; ++row) {
        raise_row(out, row, rows, kernel);
    }
    return out;
}

HeightMap highest_in_disc(const HeightMap& map, double radius_mm) {
    const int cells = static_cast<int>(std::floor(radius_mm / map.cell_mm));
    HeightMap out = map;
    std::fill(out.z_mm.begin(), out.z_mm.end(), kNothing);
    // Windows of 2^p cells; a window of any width is two of them that overlap.
    const auto reach = static_cast<std::size_t>(cells);
    const std::size_t width = static_cast<std::size_t>(map.columns) + 2 * reach + 1;
    std::vector<std::vector<float>> windows;
    for (int source = 0; source < map.rows; ++source) {
        windows.assign(1, std::vector<float>(width, kNothing));
        std::copy_n(map.z_mm.data() + map.index(0, source), map.columns, windows[0].data() + cells);
        for (std::size_t span = 1; span <= reach; span *= 2) {
            const std::vector<float>& half = windows.back();
            std::vector<float> next(half);
            for (std::size_t i = 0; i + span < width; ++i) {
                next[i] = std::max(half[i], half[i + span]);
            }
            windows.push_back(std::move(next));
        }
        for (int offset = -cells; offset <= cells; ++offset) {
            const int row = source + offset;
            if (row < 0 || row >= map.rows) {
                continue;
            }
            const int half = static_cast<int>(
                std::floor(std::sqrt(std::max(0.0, std::pow(radius_mm / map.cell_mm, 2) -
                                                       static_cast<double>(offset) * offset))));
            std::size_t power = 0;
            while ((2 << power) <= 2 * half + 1) {
                ++power;
            }
            const float* left = windows[power].data() + cells - half;
            const float* right = windows[power].data() + cells + half + 1 - (1 << power);
            float* to = out.z_mm.data() + out.index(0, row);
            for (int i = 0; i < map.columns; ++i) {
                const float value = left[i] > right[i] ? left[i] : right[i];
                to[i] = to[i] > value ? to[i] : value;
            }
        }
    }
    return out;
}

HeightMap coarser(const HeightMap& map, int factor) {
    HeightMap out;
    out.cell_mm = map.cell_mm * factor;
    out.columns = (map.columns + factor - 1) / factor;
    out.rows = (map.rows + factor - 1) / factor;
    out.low_mm = map.low_mm.array() + (factor - 1) * map.cell_mm / 2;
    out.z_mm.assign(static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows),
                    kNothing);
    for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
            float& z = out.z_mm[out.index(column / factor, row / factor)];
            z = std::max(z, map.at(column, row));
        }
    }
    return out;
}

}  // namespace cam::check
