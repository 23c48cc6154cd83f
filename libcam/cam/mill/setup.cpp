// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/setup.h"

#include "cam/check/height_map.h"
#include "cam/check/mill3.h"
#include "decomp/base/number.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace cam::mill {

namespace {

using decomp::Result;
using decomp::mesh::TriMesh;
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMostUnseenPercent = 1;  // for one set-up
constexpr double kSideMm = 3;             // of stock beside a part that lies on the table
constexpr double kTopMm = 1;              // of stock to be faced off
constexpr double kBorderMm = 16;          // of stock around two set-ups: room for dowels and clamps
constexpr double kTabWidthMm = 6;
constexpr double kTabHeightMm = 3;
constexpr double kTabRootMm = 2;       // how far a tab reaches into the part
constexpr double kSameSide = 0.3;      // mm from the outermost point that count as outermost
constexpr double kOverlapMm = 0.5;     // that the second side goes on below the first
constexpr double kLevelFacet = 0.05;   // upward part of a normal: less is a wall
constexpr double kStrayShare = 0.003;  // of the area facing a side: that little decides nothing
constexpr double kSameSizeMm = 1e-6;   // a block lacks no less
constexpr double kBetterTurn = 0.98;   // of the plan's area: a turn must win so much

TriMesh moved(TriMesh mesh, const Isometry3d& map) {
    for (Vector3d& p : mesh.points) {
        p = map * p;
    }
    return mesh;
}

void add_box(TriMesh& mesh, const AlignedBox3d& box) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (unsigned i = 0; i < 8; ++i) {
        mesh.points.emplace_back((i & 1U) != 0 ? box.max().x() : box.min().x(),
                                 (i & 2U) != 0 ? box.max().y() : box.min().y(),
                                 (i & 4U) != 0 ? box.max().z() : box.min().z());
    }
    constexpr std::array<std::array<std::uint32_t, 3>, 12> kFaces{{{0, 2, 1},
                                                                   {1, 2, 3},
                                                                   {4, 5, 6},
                                                                   {5, 7, 6},
                                                                   {0, 1, 4},
                                                                   {1, 5, 4},
                                                                   {2, 6, 3},
                                                                   {3, 6, 7},
                                                                   {0, 4, 2},
                                                                   {2, 4, 6},
                                                                   {1, 3, 5},
                                                                   {3, 7, 5}}};
    for (const auto& face : kFaces) {
        mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
    }
}

AlignedBox3d moved(const AlignedBox3d& box, const Isometry3d& map) {
    AlignedBox3d out;
    out.extend(map * box.min());
    out.extend(map * box.max());
    return out;
}

/// The turn about Z, in whole degrees, at which the shape needs the smallest rectangle.
Isometry3d least_plan(const TriMesh& mesh) {
    double best_area = 0;
    int best = 0;
    for (int degrees = 0; degrees < 90; ++degrees) {
        const double angle = degrees * std::numbers::pi / 180;
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        Eigen::AlignedBox2d box;
        for (const Vector3d& p : mesh.points) {
            box.extend(Vector2d(c * p.x() - s * p.y(), s * p.x() + c * p.y()));
        }
        const double area = box.volume();
        if (degrees == 0 || area < kBetterTurn * best_area) {
            best_area = area;
            best = degrees;
        }
    }
    return Isometry3d(Eigen::AngleAxisd(best * std::numbers::pi / 180, Vector3d::UnitZ()));
}

double largest_clearing_mm(const MillTask& task) {
    double largest = 0;
    for (const Cutter& cutter : task.cutters) {
        if (cutter.feeds.rough.feed.mm_per_s() > 0 || cutter.feeds.finish.feed.mm_per_s() > 0) {
            largest = std::max(largest, cutter.tool.diameter_mm);
        }
    }
    return largest;
}

/// How far the round tip of a tool keeps it from the foot of a wall.
double tip_height_mm(const MillTask& task) {
    double highest = 0;
    for (const Cutter& cutter : task.cutters) {
        if (cutter.feeds.finish.feed.mm_per_s() > 0 && cutter.tool.shape != tool::Shape::V &&
            cutter.tool.shape != tool::Shape::Drill) {
            highest = tool::cutter_height_mm(cutter.tool, cutter.tool.radius_mm()).value_or(0);
        }
    }
    return std::min(highest, 3.0);
}

/// The block: as given, or as needed. @error mill.stock_too_small
Result<Vector3d> stock_size(const Vector3d& needed, const MillTask& task) {
    if (!task.stock_mm) {
        return Vector3d(needed.array().ceil());
    }
    const Vector3d lacking = needed - *task.stock_mm;
    if (lacking.maxCoeff() > kSameSizeMm) {
        const auto size = [](const Vector3d& v) {
            return decomp::decimal(v.x(), 1) + " x " + decomp::decimal(v.y(), 1) + " x " +
                   decomp::decimal(v.z(), 1) + " mm";
        };
        return decomp::fail(
            "mill.stock_too_small",
            "the part needs a block of " + size(needed) + ", this one has " + size(*task.stock_mm),
            {}, "take a larger block, a smaller --height, or a thinner tool");
    }
    return *task.stock_mm;
}

/// Where one side's work ends and the other's begins, in the frame of the first set-up.
struct Parting {
    double first_floor = 0;
    double second_floor = 0;  ///< its height here: the second side is cut from below up to it
    double middle = 0;
};

/// The lowest height that faces up and the highest that faces down, but for strays.
Parting parting_of(const TriMesh& part, double overlap) {
    const decomp::mesh::Facets facets = decomp::mesh::measure_facets(part);
    std::array<std::vector<std::pair<double, double>>, 2> by_height;
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
        const double up = facets.unit[t].z();
        if (std::abs(up) > kLevelFacet) {
            by_height[up > 0 ? 0 : 1].emplace_back((up > 0 ? 1 : -1) * facets.centre[t].z(),
                                                   facets.area_mm2[t]);
        }
    }
    const AlignedBox3d box = decomp::mesh::bounds(part);
    const auto lowest = [&](std::vector<std::pair<double, double>>& side, double otherwise) {
        std::sort(side.begin(), side.end());
        double all = 0;
        for (const auto& [z, area] : side) {
            all += area;
        }
        double seen = 0;
        for (const auto& [z, area] : side) {
            seen += area;
            if (seen >= kStrayShare * all) {
                return z;
            }
        }
        return otherwise;
    };
    const double up = lowest(by_height[0], box.max().z());
    const double down = -lowest(by_height[1], -box.min().z());
    Parting out;
    out.middle = std::clamp((up + down) / 2, box.min().z() + box.sizes().z() / 5,
                            box.max().z() - box.sizes().z() / 5);
    out.first_floor = std::min(up, out.middle) - overlap;
    out.second_floor = std::max(down, out.middle) + overlap;
    return out;
}

/// The outermost point of the part's section at a height, towards one side; not on a cut face.
std::optional<Vector2d> outermost(const decomp::part::Part& source, const TriMesh& part, double z,
                                  const Vector2d& towards) {
    std::vector<Vector2d> points;
    std::vector<bool> cut;
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector3d& a = part.points[part.triangles[t][i]];
            const Vector3d& b = part.points[part.triangles[t][(i + 1) % 3]];
            if ((a.z() <= z) != (b.z() <= z)) {
                const Vector3d p = a + (b - a) * ((z - a.z()) / (b.z() - a.z()));
                points.emplace_back(p.head<2>());
                cut.push_back(t < source.sources.size() && source.sources[t].is_cut());
            }
        }
    }
    double farthest = -1e30;
    for (const Vector2d& p : points) {
        farthest = std::max(farthest, p.dot(towards));
    }
    Vector2d mean(0, 0);
    double count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].dot(towards) > farthest - kSameSide) {
            if (cut[i]) {
                return std::nullopt;
            }
            mean += points[i];
            ++count;
        }
    }
    if (count == 0) {
        return std::nullopt;
    }
    mean /= count;
    std::optional<Vector2d> best;
    for (const Vector2d& p : points) {
        if (p.dot(towards) > farthest - kSameSide &&
            (!best || (p - mean).norm() < (*best - mean).norm())) {
            best = p;
        }
    }
    return best;
}

void add_tabs(Clamping& clamping, const decomp::part::Part& source, const TriMesh& part, double z,
              const Eigen::AlignedBox2d& room) {
    int made = 0;
    for (const Vector2d& side :
         {Vector2d(1, 0), Vector2d(-1, 0), Vector2d(0, 1), Vector2d(0, -1)}) {
        const auto root = outermost(source, part, z, side);
        if (!root) {
            continue;
        }
        const Vector2d across(std::abs(side.y()), std::abs(side.x()));
        const double rim = std::max(side.dot(room.min()), side.dot(room.max())) + 1;
        const Vector2d inner = *root - kTabRootMm * side;
        const Vector2d outer = inner + side * (rim - inner.dot(side));
        Eigen::AlignedBox2d plan;
        for (const Vector2d& end : {inner, outer}) {
            plan.extend(Vector2d(end + across * kTabWidthMm / 2));
            plan.extend(Vector2d(end - across * kTabWidthMm / 2));
        }
        clamping.keeps.push_back(
            {path::MillKeep::Kind::Tab,
             AlignedBox3d(Vector3d(plan.min().x(), plan.min().y(), z - kTabHeightMm / 2),
                          Vector3d(plan.max().x(), plan.max().y(), z + kTabHeightMm / 2))});
        ++made;
    }
    if (made < 3) {
        clamping.warnings.push_back("only " + std::to_string(made) +
                                    " tabs hold the part: the other sides are cut faces");
    }
}

void add_frame(Clamping& clamping, const AlignedBox3d& stock, const Eigen::AlignedBox2d& room) {
    const Vector3d& low = stock.min();
    const Vector3d& high = stock.max();
    const auto keep = [&](double x0, double y0, double x1, double y1) {
        clamping.keeps.push_back(
            {path::MillKeep::Kind::Frame,
             AlignedBox3d(Vector3d(x0, y0, low.z()), Vector3d(x1, y1, high.z()))});
    };
    keep(low.x(), low.y(), room.min().x(), high.y());
    keep(room.max().x(), low.y(), high.x(), high.y());
    keep(room.min().x(), low.y(), room.max().x(), room.min().y());
    keep(room.min().x(), room.max().y(), room.max().x(), high.y());
}

/// Dowels 4, 6, 8, 10 mm: the first that the clearing tool bores as a helix.
double dowel_diameter(const MillTask& task) {
    double flat = 0;
    for (const Cutter& cutter : task.cutters) {
        if (cutter.feeds.rough.feed.mm_per_s() > 0) {
            flat = cutter.tool.diameter_mm;
            break;
        }
    }
    for (const double diameter : {4.0, 6.0, 8.0}) {
        if (diameter >= flat + 1) {
            return diameter;
        }
    }
    return 10;
}

Bench bench_of(std::string name, TriMesh target, const Isometry3d& pose, const AlignedBox3d& stock,
               const MillTask& task) {
    Bench bench;
    bench.program.name = std::move(name);
    bench.program.from_model = decomp::Pose<path::MillFrame, decomp::ModelFrame>(pose);
    bench.program.stock = stock;
    bench.program.safe_z = stock.max().z() + task.safe_mm;
    bench.program.floor_z = stock.min().z();
    bench.target = std::move(target);
    bench.floor_z = stock.min().z();
    return bench;
}

/// The pose in which the shape lies in the middle of a block of this size, zero at its corner.
Isometry3d placed(const TriMesh& turned, const Isometry3d& turn, const Vector3d& stock,
                  double below) {
    const AlignedBox3d box = decomp::mesh::bounds(turned);
    const Vector3d centre = box.center();
    return Isometry3d(Eigen::Translation3d(stock.x() / 2 - centre.x(), stock.y() / 2 - centre.y(),
                                           below - stock.z() - box.min().z())) *
           turn;
}

Result<Clamping> clamp_once(const decomp::part::Part& part, const TriMesh& turned,
                            const Isometry3d& turn, const MillTask& task) {
    const Vector3d needed =
        decomp::mesh::bounds(turned).sizes() + Vector3d(2 * kSideMm, 2 * kSideMm, kTopMm);
    const auto size = stock_size(needed, task);
    if (!size) {
        return decomp::fail(size.error());
    }
    const AlignedBox3d stock(Vector3d(0, 0, -size->z()), Vector3d(size->x(), size->y(), 0));
    const Isometry3d pose = placed(turned, turn, *size, 0);
    Clamping out;
    Bench bench = bench_of("top", moved(part.mesh, pose), pose, stock, task);
    bench.program.hold = path::Hold::Bottom;
    bench.room = {stock.min().head<2>(), stock.max().head<2>()};
    out.benches.push_back(std::move(bench));
    return out;
}

Result<Clamping> clamp_twice(const decomp::part::Part& part, const TriMesh& turned,
                             const Isometry3d& turn, const MillTask& task) {
    const double channel = 1.3 * largest_clearing_mm(task) + 1;
    const double around = channel + kBorderMm;
    const Vector3d needed =
        decomp::mesh::bounds(turned).sizes() + Vector3d(2 * around, 2 * around, 2 * kTopMm);
    const auto size = stock_size(needed, task);
    if (!size) {
        return decomp::fail(size.error());
    }
    const AlignedBox3d stock(Vector3d(0, 0, -size->z()), Vector3d(size->x(), size->y(), 0));
    const double below = (size->z() - decomp::mesh::bounds(turned).sizes().z()) / 2;
    const Isometry3d pose = placed(turned, turn, *size, below);
    const TriMesh placed_part = moved(part.mesh, pose);
    Clamping out;
    const Eigen::AlignedBox2d room(Vector2d(kBorderMm, kBorderMm),
                                   Vector2d(size->x() - kBorderMm, size->y() - kBorderMm));
    const Parting parting = parting_of(placed_part, tip_height_mm(task) + kOverlapMm);
    add_tabs(out, part, placed_part, parting.middle, room);
    add_frame(out, stock, room);
    const bool about_x =
        task.flip == Flip::AboutX || (task.flip == Flip::Auto && size->x() >= size->y());
    out.flip_axis = about_x ? "x" : "y";
    Isometry3d over(
        Eigen::AngleAxisd(std::numbers::pi, about_x ? Vector3d::UnitX() : Vector3d::UnitY()));
    over.linear() = over.linear().array().round().matrix();  // exact half turns
    over =
        Eigen::Translation3d(about_x ? 0 : size->x(), about_x ? size->y() : 0, -size->z()) * over;
    const double dowel = dowel_diameter(task);
    const Vector2d middle = Vector2d(size->x(), size->y()) / 2;
    for (const double end : {kBorderMm / 2, -kBorderMm / 2}) {
        const double x = about_x ? (end > 0 ? end : size->x() + end) : middle.x();
        const double y = about_x ? middle.y() : (end > 0 ? end : size->y() + end);
        out.dowels.push_back({Vector2d(x, y), dowel, stock.min().z()});
    }
    TriMesh target = placed_part;
    for (const path::MillKeep& keep : out.keeps) {
        add_box(target, keep.box);
    }
    TriMesh target_below = moved(placed_part, over);
    for (const path::MillKeep& keep : out.keeps) {
        add_box(target_below, moved(keep.box, over));
    }
    Bench top = bench_of("top", std::move(target), pose, stock, task);
    top.floor_z = std::max(stock.min().z(), parting.first_floor);
    Bench bottom = bench_of("bottom", std::move(target_below), over * pose, stock, task);
    bottom.floor_z = std::max(stock.min().z(), (over * Vector3d(0, 0, parting.second_floor)).z());
    for (Bench* bench : {&top, &bottom}) {
        bench->program.hold = path::Hold::Frame;
        bench->room = room;
        bench->open = false;
        out.benches.push_back(std::move(*bench));
    }
    return out;
}

}  // namespace

double stepover_mm(const tool::Tool& tool, double scallop_mm) {
    double radius = 0;
    switch (tool.shape) {
        case tool::Shape::Ball:
            radius = tool.radius_mm();
            break;
        case tool::Shape::BullNose:
            radius = tool.corner_radius_mm;
            break;
        case tool::Shape::TaperedBall:
            radius = tool.tip_diameter_mm / 2;
            break;
        default:
            return tool.diameter_mm / 3;
    }
    const double scallop = std::min(scallop_mm, radius);
    return 2 * std::sqrt(2 * radius * scallop - scallop * scallop);
}

Result<Clamping> clamp_part(const decomp::part::Part& part, const MillTask& task,
                            decomp::Run& run) {
    check::Mill3Options options;
    options.setups = task.setups == Setups::Two ? check::Setups::Two : check::Setups::One;
    auto seen = check::check_mill3(part, options, {}, run);
    if (!seen) {
        return decomp::fail(seen.error());
    }
    const auto good = [&] {
        const check::Mill3Pose& best = seen->poses[seen->best];
        return best.flat_base && best.unseen.by_area_percent <= kMostUnseenPercent;
    };
    bool twice = task.setups == Setups::Two;
    if (task.setups == Setups::Auto && !good()) {
        options.setups = check::Setups::Two;
        seen = check::check_mill3(part, options, {}, run);
        if (!seen) {
            return decomp::fail(seen.error());
        }
        twice = true;
    }
    const check::Mill3Pose& best = seen->poses[seen->best];
    if (!twice && !best.flat_base) {
        return decomp::fail("mill.nothing_flat", "the part has no flat face on which it could lie",
                            part.id, "mill it from two sides: --setups 2");
    }
    Isometry3d up = Isometry3d::Identity();
    up.linear() = check::frame_looking_down(best.direction);
    const Isometry3d turn = least_plan(moved(part.mesh, up)) * up;
    const TriMesh turned = moved(part.mesh, turn);
    auto out = twice ? clamp_twice(part, turned, turn, task) : clamp_once(part, turned, turn, task);
    if (out) {
        out->unseen_percent = best.unseen.by_area_percent;
    }
    return out;
}

}  // namespace cam::mill
