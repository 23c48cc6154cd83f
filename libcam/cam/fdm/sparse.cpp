// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/sparse.h"

#include "cam/fdm/edge_grid.h"
#include "cam/fdm/linking.h"
#include "cam/polygon/offset.h"
#include "decomp/base/assert.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;

constexpr double kTurn = 2 * std::numbers::pi;
/// Length of a gyroid's section per area, times its period: pi / 4 times the surface per volume,
/// 3.0915 over the period.
constexpr double kGyroidLength = 2.4281;
constexpr int kGyroidSteps = 28;  // points in a period
constexpr double kOutlineToleranceMm = 0.01;

/// What lines have to cover, in a frame turned by an angle.
struct TurnedBox {
    Eigen::Rotation2Dd turn;
    Eigen::AlignedBox2d box;

    TurnedBox(const EdgeGrid& region, double angle_rad) : turn(angle_rad) {
        for (const auto& loop : region.loops()) {
            for (const Vector2d& p : loop) {
                box.extend(turn.inverse() * p);
            }
        }
    }
};

/// Parallel lines, `phase_mm` beside those through the origin.
void add_parallels(const EdgeGrid& region, double angle_rad, double spacing_mm, double phase_mm,
                   std::vector<BoundedLine>& out) {
    constexpr double kBeyondMm = 1;
    const TurnedBox frame(region, angle_rad);
    const double left = frame.box.min().x() - kBeyondMm;
    const double right = frame.box.max().x() + kBeyondMm;
    const auto first = static_cast<long>(std::ceil((frame.box.min().y() - phase_mm) / spacing_mm));
    const auto last = static_cast<long>(std::floor((frame.box.max().y() - phase_mm) / spacing_mm));
    for (long i = first; i <= last; ++i) {
        const double y = static_cast<double>(i) * spacing_mm + phase_mm;
        append_inside({frame.turn * Vector2d(left, y), frame.turn * Vector2d(right, y)}, region,
                      out);
    }
}

/// One wave of a gyroid's section: with the other coordinate as parameter, a cos v + b sin v = c is
/// solved for v.
double gyroid_wave(double t, double z, bool along_x, double sign) {
    const double sin_z = std::sin(z);
    const double cos_z = std::cos(z);
    const double a = along_x ? std::sin(t) : sin_z;
    const double b = along_x ? cos_z : std::cos(t);
    const double c = along_x ? -sin_z * std::cos(t) : -std::sin(t) * cos_z;
    double middle = std::atan2(b, a);
    if (!along_x && a < 0 && middle < 0) {
        middle += kTurn;  // keeps the wave in one piece
    }
    return middle + sign * std::acos(std::clamp(c / std::hypot(a, b), -1.0, 1.0));
}

void add_gyroid(const EdgeGrid& region, const SparseFill& fill, std::vector<BoundedLine>& out) {
    const double period_mm = kGyroidLength * fill.bead_spacing_mm / fill.density;
    const double scale = kTurn / period_mm;
    const double z = fill.z_mm * scale;
    // The parameter along which the section consists of whole waves.
    const bool along_x = std::abs(std::cos(z)) >= std::abs(std::sin(z));
    const TurnedBox frame(region, fill.angle.radians());
    const int u = along_x ? 0 : 1;
    const Vector2d low = frame.box.min() * scale;
    const Vector2d high = frame.box.max() * scale;
    const auto first = static_cast<long>(std::floor(low[u] / kTurn * kGyroidSteps)) - 1;
    const auto last = static_cast<long>(std::ceil(high[u] / kTurn * kGyroidSteps)) + 1;
    const auto wave0 = static_cast<long>(std::floor(low[1 - u] / kTurn)) - 1;
    const auto wave1 = static_cast<long>(std::ceil(high[1 - u] / kTurn)) + 1;
    for (const double sign : {-1.0, 1.0}) {
        std::vector<std::pair<double, double>> wave;
        for (long i = first; i <= last; ++i) {
            const double t = kTurn * static_cast<double>(i) / kGyroidSteps;
            wave.emplace_back(t, gyroid_wave(t, z, along_x, sign));
        }
        for (long k = wave0; k <= wave1; ++k) {
            Line line;
            for (const auto& [t, v] : wave) {
                const double w = v + kTurn * static_cast<double>(k);
                line.push_back(frame.turn * Vector2d(along_x ? Vector2d(t, w) : Vector2d(w, t)) /
                               scale);
            }
            append_inside(line, region, out);
        }
    }
}

/// Three families of planes at right angles, with the space diagonal upright: their sections are
/// lines in three directions that shift from layer to layer.
void add_cubic(const EdgeGrid& region, const SparseFill& fill, std::vector<BoundedLine>& out) {
    const double spacing = 3 * fill.bead_spacing_mm / fill.density;
    const double shift = fill.z_mm / std::numbers::sqrt2;
    for (int k = 0; k < 3; ++k) {
        add_parallels(region, fill.angle.radians() + k * kTurn / 3, spacing,
                      shift - spacing * std::floor(shift / spacing), out);
    }
}

std::vector<Line> concentric(const polygon::Paths& region, const SparseFill& fill) {
    std::vector<Line> out;
    const double spacing = fill.bead_spacing_mm / fill.density;
    polygon::Paths now = polygon::offset(region, fill.bead_spacing_mm - spacing);
    while (!now.empty()) {
        for (const auto& loop : polygon::simplified(now, kOutlineToleranceMm)) {
            Line& line = out.emplace_back();
            for (const auto& p : loop) {
                line.push_back(polygon::to_mm(p));
            }
            line.push_back(line.front());
        }
        now = polygon::offset(now, -spacing);
    }
    return out;
}

}  // namespace

SparsePattern sparse_pattern(const std::string& name) {
    using Named = std::pair<const char*, SparsePattern>;
    for (const auto& [known, pattern] :
         {Named("grid", SparsePattern::Grid), Named("rectilinear", SparsePattern::Rectilinear),
          Named("gyroid", SparsePattern::Gyroid), Named("cubic", SparsePattern::Cubic),
          Named("concentric", SparsePattern::Concentric)}) {
        if (name == known) {
            return pattern;
        }
    }
    DECOMP_ASSERT(false);
    return SparsePattern::Grid;
}

std::vector<Line> fill_sparsely(const polygon::Paths& region, const SparseFill& fill) {
    if (region.empty() || fill.density <= 0) {
        return {};
    }
    if (fill.pattern == SparsePattern::Concentric) {
        return concentric(region, fill);
    }
    const EdgeGrid grid(region);
    std::vector<BoundedLine> lines;
    const double angle = fill.angle.radians();
    const double right = kTurn / 4;
    const double spacing = fill.bead_spacing_mm / fill.density;
    switch (fill.pattern) {
        case SparsePattern::Grid:
            add_parallels(grid, angle, 2 * spacing, 0, lines);
            add_parallels(grid, angle + right, 2 * spacing, 0, lines);
            break;
        case SparsePattern::Rectilinear:
            add_parallels(grid, fill.odd_layer ? angle + right : angle, spacing, 0, lines);
            break;
        case SparsePattern::Gyroid:
            add_gyroid(grid, fill, lines);
            break;
        case SparsePattern::Cubic:
            add_cubic(grid, fill, lines);
            break;
        case SparsePattern::Concentric:
            break;
    }
    return linked(std::move(lines), grid, fill.max_link_mm);
}

}  // namespace cam::fdm
