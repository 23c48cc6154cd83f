// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/reach.h"

#include "cam/check/height_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace cam::check {

using decomp::Result;
using decomp::mesh::Facets;
using decomp::mesh::TriMesh;

namespace {

constexpr double kWall = 1e-6;        // cosine: facets this far from facing up are walls
constexpr double kAnyTilt = 1e-9;     // a normal so near to the axis has no side
constexpr float kRoundingMm = 1e-4F;  // heights are float32
constexpr int kHolderFactor = 4;      // cells of the holder's map per cell
constexpr int kConeSteps = 4;         // discs that stand for a cone of the holder

/// Lowest places of the tip: of the cutter alone, and of shank and holder.
struct Tips {
    HeightMap cutter;
    HeightMap stem;  ///< shank and holder
};

void lower_to(HeightMap& map, const HeightMap& other, double by_mm) {
    for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
            const int factor = static_cast<int>(std::lround(other.cell_mm / map.cell_mm));
            const float value = other.at(column / factor, row / factor);
            float& z = map.z_mm[map.index(column, row)];
            z = std::max(z, value - static_cast<float>(by_mm));
        }
    }
}

/// The holder as discs: radius and height above the tip.
struct Disc {
    double radius_mm;
    double height_mm;
};

std::vector<Disc> holder_discs(const tool::Tool& tool, double clearance_mm) {
    std::vector<Disc> discs;
    double z = tool.stickout_mm - clearance_mm;
    for (const tool::HolderSection& section : tool.holder) {
        const double lower = section.lower_diameter_mm / 2 + clearance_mm;
        const double upper = section.upper_diameter_mm / 2 + clearance_mm;
        discs.push_back({lower, z});
        // A widening cone: each step as low as it begins, as wide as it ends.
        for (int step = 0; upper > lower && step < kConeSteps; ++step) {
            discs.push_back({lower + (upper - lower) * (step + 1) / kConeSteps,
                             z + section.length_mm * step / kConeSteps});
        }
        z += section.length_mm;
    }
    return discs;
}

Tips tips_of(const HeightMap& map, const tool::Tool& tool, const ReachOptions& options) {
    Tips tips;
    tips.cutter =
        tool.shape == tool::Shape::Flat
            ? highest_in_disc(map, tool.radius_mm())
            : lowest_tips(map, tool.radius_mm(), [&](double r) {
                  return tool::cutter_height_mm(tool, std::min(r, tool.radius_mm())).value_or(0);
              });
    tips.stem = map;
    std::fill(tips.stem.z_mm.begin(), tips.stem.z_mm.end(), kNothing);
    // The tool is tried the tolerance away from the surface; clearances count from where it cuts.
    const double shank =
        tool.shank_diameter_mm / 2 + options.shank_clearance_mm + options.tolerance_mm;
    lower_to(tips.stem, highest_in_disc(map, shank), tool.flute_mm);
    const HeightMap coarse = coarser(map, kHolderFactor);
    for (const Disc& disc :
         holder_discs(tool, options.holder_clearance_mm + options.tolerance_mm)) {
        lower_to(tips.stem, highest_in_disc(coarse, disc.radius_mm), disc.height_mm);
    }
    return tips;
}

class Judge {
  public:
    Judge(const HeightMap& map, const Tips& tips, const tool::Tool& tool)
        : map_(map), tips_(tips), tool_(tool) {
        // Heights of the cutting surface by squared distance would need a table per offset of the
        // point; radii in hundredths of a cell are fine enough.
        const auto count =
            static_cast<std::size_t>(std::ceil(tool.radius_mm() / radius_step())) + 2;
        for (std::size_t i = 0; i < count; ++i) {
            const double r = std::min(static_cast<double>(i) * radius_step(), tool.radius_mm());
            heights_.push_back(static_cast<float>(tool::cutter_height_mm(tool, r).value_or(0)));
        }
    }

    /// @param point   to be swept, in the map's frame
    /// @param normal  of its facet
    void judge(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, char& cutter,
               char& whole) const {
        const auto here = nearest(point.head<2>());
        const auto z = static_cast<float>(point.z()) + kRoundingMm;
        if (map_.holds(here.x(), here.y()) && map_.at(here.x(), here.y()) > z) {
            return;  // something lies above it
        }
        const tool::Contact at = tool::contact(
            tool_, decomp::Angle::radians(std::acos(std::clamp(normal.z(), 0.0, 1.0))));
        const double side = normal.head<2>().norm();
        const Eigen::Vector2d outward =
            side > kAnyTilt ? Eigen::Vector2d(normal.head<2>() / side) : Eigen::Vector2d(0, 0);
        const Eigen::Vector2i tip = nearest(point.head<2>() + at.r_mm * outward);
        const float contact = z - static_cast<float>(at.z_mm);
        cutter = below(tips_.cutter, tip, contact) ? 1 : 0;
        whole = cutter != 0 && below(tips_.stem, tip, contact) ? 1 : 0;
        if (whole == 0) {
            search(point, z, cutter, whole);
        }
    }

  private:
    [[nodiscard]] double radius_step() const { return map_.cell_mm / 100; }

    [[nodiscard]] Eigen::Vector2i nearest(const Eigen::Vector2d& at) const {
        return {static_cast<int>(std::lround((at.x() - map_.low_mm.x()) / map_.cell_mm)),
                static_cast<int>(std::lround((at.y() - map_.low_mm.y()) / map_.cell_mm))};
    }

    /// Whether the tip may stand that low; beyond the map there is nothing in its way.
    [[nodiscard]] static bool below(const HeightMap& tips, const Eigen::Vector2i& at, float z) {
        return !tips.holds(at.x(), at.y()) || tips.at(at.x(), at.y()) <= z;
    }

    /// A point as the grid sees it: in cells, not rounded.
    struct Spot {
        double column;
        double row;
        float z;
    };

    /// Every place of the axis from which the cutter covers the point.
    void search(const Eigen::Vector3d& point, float z, char& cutter, char& whole) const {
        const Spot spot{(point.x() - map_.low_mm.x()) / map_.cell_mm,
                        (point.y() - map_.low_mm.y()) / map_.cell_mm, z};
        const double cells = tool_.radius_mm() / map_.cell_mm;
        const int first = std::max(0, static_cast<int>(std::ceil(spot.row - cells)));
        const int last = std::min(map_.rows - 1, static_cast<int>(std::floor(spot.row + cells)));
        for (int row = first; row <= last && whole == 0; ++row) {
            search_row(spot, row, cutter, whole);
        }
    }

    /// The places in one row of the grid, until the whole tool fits one.
    void search_row(const Spot& spot, int row, char& cutter, char& whole) const {
        const double cells = tool_.radius_mm() / map_.cell_mm;
        const double half =
            std::sqrt(std::max(0.0, cells * cells - (row - spot.row) * (row - spot.row)));
        const int from = std::max(0, static_cast<int>(std::ceil(spot.column - half)));
        const int to = std::min(map_.columns - 1, static_cast<int>(std::floor(spot.column + half)));
        for (int column = from; column <= to; ++column) {
            const float lowest = tips_.cutter.at(column, row);
            if (lowest > spot.z) {
                continue;
            }
            const double r = std::sqrt((column - spot.column) * (column - spot.column) +
                                       (row - spot.row) * (row - spot.row)) *
                             map_.cell_mm;
            const double step = r / radius_step() + 0.5;  // the nearest, once truncated
            const float tip = spot.z - heights_[static_cast<std::size_t>(step)];
            if (lowest > tip) {
                continue;
            }
            cutter = 1;
            if (tips_.stem.at(column, row) <= tip) {
                whole = 1;
                return;
            }
        }
    }

    const HeightMap& map_;
    const Tips& tips_;
    const tool::Tool& tool_;
    std::vector<float> heights_;
};

}  // namespace

ReachOptions reach_options(const profile::MillMachine& machine) {
    return {.cell_mm = machine.reach.cell_mm,
            .tolerance_mm = machine.reach.tolerance_mm,
            .shank_clearance_mm = machine.reach.shank_clearance_mm,
            .holder_clearance_mm = machine.reach.holder_clearance_mm};
}

double sample_spacing_mm(const std::vector<tool::Tool>& tools) {
    double least = std::numeric_limits<double>::infinity();
    for (const tool::Tool& tool : tools) {
        least = std::min(least, tool.radius_mm());
    }
    return least;
}

Result<Reach> tool_reach(const TriMesh& mesh, const Facets& points,
                         const Eigen::Vector3d& direction, const tool::Tool& tool,
                         const ReachOptions& options, std::optional<double> floor_mm) {
    const Eigen::Matrix3d frame = frame_looking_down(direction);
    std::vector<Eigen::Vector3d> turned;
    turned.reserve(mesh.points.size());
    for (const Eigen::Vector3d& point : mesh.points) {
        turned.emplace_back(frame * point);
    }
    auto map = raster(mesh, turned,
                      {.cell_mm = options.cell_mm,
                       .border_mm = tool.radius_mm() + options.tolerance_mm + 2 * options.cell_mm});
    if (!map) {
        return decomp::fail(map.error());
    }
    if (floor_mm) {
        for (float& z : map->z_mm) {
            z = std::max(z, static_cast<float>(*floor_mm));
        }
    }
    Reach reach;
    const std::size_t count = points.unit.size();
    reach.cutter.assign(count, 0);
    reach.tool.assign(count, 0);
    const Tips tips = tips_of(*map, tool, options);
    const Judge judge(*map, tips, tool);
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d normal = frame * points.unit[i];
        if (normal.z() >= -kWall && points.area_mm2[i] > 0) {
            judge.judge(frame * points.centre[i] + options.tolerance_mm * normal, normal,
                        reach.cutter[i], reach.tool[i]);
        }
    }
    return reach;
}

}  // namespace cam::check
