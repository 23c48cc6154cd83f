// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/maps.h"

#include "cam/tool/outline.h"

#include <algorithm>
#include <cmath>

namespace cam::mill {

namespace {

using check::HeightMap;
using decomp::Result;

constexpr double kBelowAll = 50;     // mm under the floor: the target where there is none
constexpr int kBodyCells = 4;        // of the map in one of the maps of shank and holder
constexpr int kBodyRounds = 2;       // stock that the holder leaves keeps the holder up in turn
constexpr double kOpenMarginMm = 1;  // beyond the stock, where its sides are open

double largest_radius(const MillTask& task) {
    double radius = 0;
    for (const Cutter& cutter : task.cutters) {
        radius = std::max(radius, cutter.tool.radius_mm());
    }
    return radius;
}

template <class Function>
void for_nodes(const HeightMap& map, const Function& visit) {
    for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
            visit(map.index(column, row),
                  Eigen::Vector2d(map.low_mm + map.cell_mm * Eigen::Vector2d(column, row)));
        }
    }
}

HeightMap outline_tips(const HeightMap& map, const tool::Outline& outline) {
    HeightMap tips =
        check::lowest_tips(map, outline.radius, [&](double r) { return outline.height(r); });
    for (float& z : tips.z_mm) {
        z -= static_cast<float>(outline.z);
    }
    return tips;
}

}  // namespace

Eigen::AlignedBox2d axis_room(const Bench& bench, const tool::Tool& tool) {
    const double by = bench.open ? tool.radius_mm() + kOpenMarginMm : -tool.radius_mm();
    const Eigen::Vector2d grow(by, by);
    return {Eigen::Vector2d(bench.room.min() - grow), Eigen::Vector2d(bench.room.max() + grow)};
}

Result<StockMaps> untouched(const Bench& bench, const MillTask& task) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : bench.target.points) {
        box.extend(p);
    }
    const Eigen::AlignedBox3d& stock = bench.program.stock;
    const double beside = std::max((box.min() - stock.min()).head<2>().maxCoeff(),
                                   (stock.max() - box.max()).head<2>().maxCoeff());
    const double border =
        std::max(0.0, beside) + 2 * largest_radius(task) + kOpenMarginMm + 2 * task.cell_mm;
    auto target = check::raster(bench.target, bench.target.points,
                                {.cell_mm = task.cell_mm, .border_mm = border});
    if (!target) {
        return decomp::fail(target.error());
    }
    StockMaps maps{*target, *target};
    const auto below = static_cast<float>(bench.floor_z - kBelowAll);
    for_nodes(maps.target, [&](std::size_t i, const Eigen::Vector2d& at) {
        maps.target.z_mm[i] = std::max(maps.target.z_mm[i], below);
        const bool in_stock = (at - stock.min().head<2>()).minCoeff() > -task.cell_mm &&
                              (stock.max().head<2>() - at).minCoeff() > -task.cell_mm;
        maps.stock.z_mm[i] = in_stock ? static_cast<float>(stock.max().z()) : below;
    });
    return maps;
}

HeightMap body_tips(const HeightMap& stock, const tool::Tool& tool, const MillTask& task) {
    const HeightMap coarse = check::coarser(stock, kBodyCells);
    HeightMap out = coarse;
    std::fill(out.z_mm.begin(), out.z_mm.end(), check::kNothing);
    for (tool::Outline outline :
         tool::body_outlines(tool, task.shank_clearance_mm, task.holder_clearance_mm)) {
        const bool is_shank_inside = outline.radius <= tool.radius_mm() + task.shank_clearance_mm;
        if (is_shank_inside) {
            continue;  // passes wherever the cutter has passed
        }
        outline.radius += coarse.cell_mm;
        outline.flat += coarse.cell_mm;
        const HeightMap tips = outline_tips(coarse, outline);
        for (std::size_t i = 0; i < out.z_mm.size(); ++i) {
            out.z_mm[i] = std::max(out.z_mm[i], tips.z_mm[i]);
        }
    }
    return out;
}

HeightMap air_tips(const HeightMap& stock, const tool::Tool& tool) {
    return outline_tips(stock, tool::outline_of(tool));
}

void remove(HeightMap& stock, const HeightMap& tips, const tool::Tool& tool) {
    // What is left above s: the lowest of tip(q) + profile(|q - s|), a drop upside down.
    HeightMap turned = tips;
    for (float& z : turned.z_mm) {
        z = -z;
    }
    const tool::Outline outline = tool::outline_of(tool);
    const HeightMap left =
        check::lowest_tips(turned, outline.radius, [&](double r) { return outline.height(r); });
    for (std::size_t i = 0; i < stock.z_mm.size(); ++i) {
        stock.z_mm[i] = std::min(stock.z_mm[i], -left.z_mm[i]);
    }
}

HeightMap lowest_tips_over(const StockMaps& maps, const Bench& bench, const tool::Tool& tool,
                           double allowance_mm, const MillTask& task) {
    // A map is low by up to a cell beside a wall: the grown tool makes up for it.
    const double by = allowance_mm + task.cell_mm;
    HeightMap tips = outline_tips(maps.target, tool::grown(tool::outline_of(tool), by));
    const Eigen::AlignedBox2d room = axis_room(bench, tool);
    const auto floor = static_cast<float>(bench.floor_z);
    const auto top = static_cast<float>(bench.program.stock.max().z() + task.safe_mm);
    for_nodes(tips, [&](std::size_t i, const Eigen::Vector2d& at) {
        tips.z_mm[i] = room.contains(at)
                           ? std::max(floor, tips.z_mm[i] - static_cast<float>(task.cell_mm))
                           : top;
    });
    for (int round = 0; round < kBodyRounds; ++round) {
        HeightMap left = maps.stock;
        remove(left, tips, tool);
        const HeightMap body = body_tips(left, tool, task);
        for_nodes(tips, [&](std::size_t i, const Eigen::Vector2d& at) {
            tips.z_mm[i] =
                std::min(top, std::max(tips.z_mm[i], static_cast<float>(highest_near(body, at))));
        });
    }
    return tips;
}

double highest_near(const HeightMap& map, const Eigen::Vector2d& at) {
    const Eigen::Vector2d place = (at - map.low_mm) / map.cell_mm;
    const int column = static_cast<int>(std::floor(place.x()));
    const int row = static_cast<int>(std::floor(place.y()));
    float highest = check::kNothing;
    for (const int r : {row, row + 1}) {
        for (const int c : {column, column + 1}) {
            if (map.holds(c, r)) {
                highest = std::max(highest, map.at(c, r));
            }
        }
    }
    return highest;
}

}  // namespace cam::mill
