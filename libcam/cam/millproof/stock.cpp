// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/stock.h"

#include <algorithm>
#include <cmath>

namespace cam::millproof {

namespace {

constexpr int kLifts = 8192;
/// Scallops between stamps, and the width of a cell on a slope, are no hits.
constexpr double kTouchMm = 0.1;
/// Shank and holder are looked at this often along a step.
constexpr double kShaftStepMm = 1;

/// Stock that hangs together above the bottom.
struct Piece {
    long cells = 0;
    bool held = false;  ///< reaches the border
    long line = 0;      ///< the last that cut beside it
};

/// The piece about a cell; its cells become seen.
Piece flood(const StockMap& map, float bottom, std::size_t start, std::vector<char>& seen) {
    const auto columns = static_cast<std::size_t>(map.columns);
    const auto rows = static_cast<std::size_t>(map.rows);
    Piece piece;
    std::vector<std::size_t> stack{start};
    seen[start] = 1;
    while (!stack.empty()) {
        const std::size_t cell = stack.back();
        stack.pop_back();
        ++piece.cells;
        const std::size_t x = cell % columns;
        const std::size_t y = cell / columns;
        piece.held = piece.held || x == 0 || y == 0 || x + 1 == columns || y + 1 == rows;
        const auto go = [&](std::size_t to) {
            if (map.height[to] <= bottom) {
                piece.line = std::max(piece.line, static_cast<long>(map.line[to]));
            } else if (seen[to] == 0) {
                seen[to] = 1;
                stack.push_back(to);
            }
        };
        if (x > 0) {
            go(cell - 1);
        }
        if (x + 1 < columns) {
            go(cell + 1);
        }
        if (y > 0) {
            go(cell - columns);
        }
        if (y + 1 < rows) {
            go(cell + columns);
        }
    }
    return piece;
}

}  // namespace

Stock::Stock(const MillJob& job, double cell_mm) : job_(job) {
    const Eigen::Vector3d size = job.stock.sizes();
    map_.origin = job.stock.min().head<2>();
    map_.cell_mm = cell_mm;
    map_.columns = std::max(1, static_cast<int>(std::ceil(size.x() / cell_mm)));
    map_.rows = std::max(1, static_cast<int>(std::ceil(size.y() / cell_mm)));
    const std::size_t count =
        static_cast<std::size_t>(map_.columns) * static_cast<std::size_t>(map_.rows);
    map_.height.assign(count, static_cast<float>(job.stock.max().z()));
    map_.line.assign(count, 0);
    for (const ProofTool& tool : job.tools) {
        Cutter cutter;
        cutter.radius = tool.tool.radius_mm();
        cutter.scale = (kLifts - 1) / (cutter.radius * cutter.radius);
        for (int i = 0; i < kLifts; ++i) {
            const double r = std::min(cutter.radius, std::sqrt(i / cutter.scale));
            cutter.lift.push_back(
                static_cast<float>(tool::cutter_height_mm(tool.tool, r).value_or(0)));
        }
        cutters_.push_back(std::move(cutter));
    }
}

/// Calls visit(cell, squared distance of its centre) for all cells within a radius.
template <class Visit>
void Stock::around(const Eigen::Vector3d& at, double radius, Visit visit) {
    const double h = map_.cell_mm;
    const double x = (at.x() - map_.origin.x()) / h - 0.5;
    const double y = (at.y() - map_.origin.y()) / h - 0.5;
    const double r = radius / h;
    const int first = std::max(0, static_cast<int>(std::ceil(y - r)));
    const int last = std::min(map_.rows - 1, static_cast<int>(std::floor(y + r)));
    for (int row = first; row <= last; ++row) {
        const double dy = row - y;
        const double half = std::sqrt(std::max(0.0, r * r - dy * dy));
        const int from = std::max(0, static_cast<int>(std::ceil(x - half)));
        const int to = std::min(map_.columns - 1, static_cast<int>(std::floor(x + half)));
        const std::size_t base =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(map_.columns);
        for (int column = from; column <= to; ++column) {
            const double dx = column - x;
            visit(base + static_cast<std::size_t>(column), (dx * dx + dy * dy) * h * h);
        }
    }
}

void Stock::cut(const Cutter& cutter, const Eigen::Vector3d& at, long line) {
    const auto z = static_cast<float>(at.z());
    around(at, cutter.radius, [&](std::size_t cell, double r2) {
        const float low = z + cutter.lift[static_cast<std::size_t>(r2 * cutter.scale)];
        if (low < map_.height[cell]) {
            map_.height[cell] = low;
            map_.line[cell] = static_cast<int>(line);
        }
    });
}

bool Stock::touches(const Cutter& cutter, const Eigen::Vector3d& at) {
    if (at.z() >= job_.stock.max().z()) {
        return false;
    }
    bool hit = false;
    const auto z = static_cast<float>(at.z() + kTouchMm);
    // The outermost cells are left out: they stand for ground beyond the tool.
    around(at, std::max(0.0, cutter.radius - map_.cell_mm), [&](std::size_t cell, double r2) {
        hit =
            hit || map_.height[cell] > z + cutter.lift[static_cast<std::size_t>(r2 * cutter.scale)];
    });
    return hit;
}

bool Stock::shaft_touches(const tool::Tool& tool, const Eigen::Vector3d& at) {
    if (at.z() + std::min(tool.flute_mm, tool.stickout_mm) >= job_.stock.max().z()) {
        return false;
    }
    bool hit = false;
    around(at, tool::reach_radius_mm(tool, 0, 0), [&](std::size_t cell, double r2) {
        const double above = map_.height[cell] - at.z() - kTouchMm;
        const double r = std::sqrt(r2) + map_.cell_mm;
        const auto shank = tool::shank_height_mm(tool, r, 0);
        const auto holder = tool::holder_height_mm(tool, r, 0);
        hit = hit || (shank && above > *shank) || (holder && above > *holder);
    });
    return hit;
}

bool Stock::in_clamp(const tool::Tool& tool, const Eigen::Vector3d& at) const {
    for (const Eigen::AlignedBox3d& clamp : job_.keep_outs) {
        Eigen::Vector3d foot = at;
        foot.z() = clamp.min().z();
        const double r =
            std::sqrt(Eigen::AlignedBox3d(clamp.min(), clamp.max()).squaredExteriorDistance(foot));
        const double above = clamp.max().z() - at.z();
        const auto shank = tool::shank_height_mm(tool, r, 0);
        const auto holder = tool::holder_height_mm(tool, r, 0);
        if ((r < tool.radius_mm() && above > 0) || (shank && above > *shank) ||
            (holder && above > *holder)) {
            return true;
        }
    }
    return false;
}

void Stock::run(const std::vector<Step>& steps, std::vector<Fault>& faults) {
    Told told;
    for (const Step& step : steps) {
        if (step.tool >= 0) {
            run_step(step, told, faults);
        }
    }
}

void Stock::run_step(const Step& step, Told& told, std::vector<Fault>& faults) {
    const Cutter& cutter = cutters_[static_cast<std::size_t>(step.tool)];
    const Eigen::Vector3d way = step.to - step.from;
    const double across = way.head<2>().norm();
    const double finest = std::max(across, std::min(std::abs(way.z()), step.rapid ? 1e9 : across));
    const int pieces = std::max(1, static_cast<int>(std::ceil(finest / (map_.cell_mm * 0.5))));
    const int look =
        std::max(1, static_cast<int>(kShaftStepMm * pieces / std::max(way.norm(), map_.cell_mm)));
    for (int i = 0; i <= pieces; ++i) {
        Eigen::Vector3d at = step.from + way * (i / static_cast<double>(pieces));
        if (step.rapid) {
            // Axes run at their own speeds: across a slope the lower end counts everywhere.
            at.z() = across > 0 ? std::min(step.from.z(), step.to.z()) : at.z();
            if (told.rapid != step.line && touches(cutter, at)) {
                told.rapid = step.line;
                ++rapid_hits_;
                faults.push_back({"rapid", step.line, "a rapid through the stock"});
            }
        } else {
            cut(cutter, at, step.line);
        }
        if (i % look == 0 || i == pieces) {
            look_at_body(step, at, told, faults);
        }
    }
}

/// Shank and holder while the tip is at a place.
void Stock::look_at_body(const Step& step, const Eigen::Vector3d& at, Told& told,
                         std::vector<Fault>& faults) {
    const tool::Tool& tool = job_.tools[static_cast<std::size_t>(step.tool)].tool;
    if (told.shaft != step.line && shaft_touches(tool, at)) {
        told.shaft = step.line;
        faults.push_back({"holder", step.line, "shank or holder in the stock"});
    }
    if (told.clamp != step.line && in_clamp(tool, at)) {
        told.clamp = step.line;
        faults.push_back({"clamp", step.line, "tool or holder in a clamp"});
    }
}

void Stock::look_for_loose_pieces(std::vector<Fault>& faults) const {
    if (!job_.border_holds) {
        return;
    }
    const auto bottom = static_cast<float>(job_.stock.min().z() + kTouchMm);
    std::vector<char> seen(map_.height.size(), 0);
    for (std::size_t cell = 0; cell < map_.height.size(); ++cell) {
        if (seen[cell] != 0 || map_.height[cell] <= bottom) {
            continue;
        }
        const Piece piece = flood(map_, bottom, cell, seen);
        const double area = static_cast<double>(piece.cells) * map_.cell_mm * map_.cell_mm;
        if (!piece.held && area > 1) {
            faults.push_back({"loose", piece.line, "a piece of the stock is cut free"});
        }
    }
}

}  // namespace cam::millproof
