// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/finishing_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cam::mill {

using check::HeightMap;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kLead = 0.25;  // diameters: a level line begins and ends so far outside

}  // namespace

void Finishing::levels(double from_z, double to_z, double step) {
    const Lattice& lattice = grid_.lattice;
    writer_.take(cutter_, cutter_.feeds.finish.spindle_rpm, path::MillOperation::Waterline);
    const auto wanted = [&](int column, int row) {
        return level_[lattice.index(column, row)] != 0 ||
               level_[lattice.index(column + 1, row)] != 0 ||
               level_[lattice.index(column, row + 1)] != 0 ||
               level_[lattice.index(column + 1, row + 1)] != 0;
    };
    const int count = std::max(1, static_cast<int>(std::ceil((from_z - to_z) / step)));
    for (int k = 1; k <= count; ++k) {
        const double z = from_z - (from_z - to_z) * k / count;
        const auto crossing = [&](const Vector2d& below, const Vector2d& above) {
            return onto_surface(below, above, z);
        };
        std::vector<Chain> chains = trace_level(lattice, z, wanted, crossing);
        level_lines(chains, z);
    }
    writer_.retract();
}

Vector2d Finishing::onto_surface(const Vector2d& below, const Vector2d& above, double z) const {
    Vector2d clear = below;
    Vector2d blocked = above;
    while ((blocked - clear).norm() * grid_.step > kPlaceMm) {
        const Vector2d middle = (clear + blocked) / 2;
        (tip_.clears(grid_.place(middle), z) ? clear : blocked) = middle;
    }
    return clear;
}

std::optional<double> Finishing::brink(const Vector2d& from, const Vector2d& direction,
                                       bool start_clear, double start, double farthest,
                                       double z) const {
    double near = start;
    double far = 2 * start;
    while (far < farthest && tip_.clears(from + far * direction, z) == start_clear) {
        near = far;
        far *= 2;
    }
    if (far >= farthest) {
        return std::nullopt;
    }
    while (far - near > kPlaceMm) {
        const double half = (near + far) / 2;
        (tip_.clears(from + half * direction, z) == start_clear ? near : far) = half;
    }
    return start_clear ? near : far;
}

void Finishing::clear_chord(const Vector2d& a, const Vector2d& b, double z, int depth,
                            std::vector<Vector3d>& out) const {
    const Vector2d along = b - a;
    const double length = along.norm();
    if (depth == 0 || length <= kShortest) {
        return;
    }
    const Vector2d free(-along.y() / length, along.x() / length);  // clear is to the left
    const Vector2d middle = (a + b) / 2;
    std::optional<Vector2d> split;
    const bool cuts = !tip_.clears(middle + kFinishToleranceMm * free, z);
    if (cuts) {
        if (const auto by = brink(middle, free, false, kFinishToleranceMm, length, z)) {
            split = middle + *by * free;
        }
    } else if (length > kCoarsest && tip_.clears(middle - kDip * free, z)) {
        if (const auto by = brink(middle, -free, true, kDip, length, z)) {
            split = middle - *by * free;
        }
    }
    if (split) {
        clear_chord(a, *split, z, depth - 1, out);
        out.emplace_back(split->x(), split->y(), z);
        clear_chord(*split, b, z, depth - 1, out);
    } else if (cuts) {
        // No way round at this height: over it.
        std::vector<Vector3d> over;
        tip_.follow(Vector3d(a.x(), a.y(), z), Vector3d(b.x(), b.y(), z), over);
        for (Vector3d& p : over) {
            p.z() = std::max(p.z(), z);
            out.push_back(p);
        }
    }
}

Finishing::Entry Finishing::nearest_entry(const std::vector<Chain>& chains,
                                          const std::vector<char>& done) const {
    const Vector2d at = writer_.at() ? Vector2d(writer_.at()->head<2>()) : room_.min();
    Entry best;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < chains.size(); ++i) {
        const std::size_t starts = chains[i].closed ? chains[i].points.size() : 1;
        for (std::size_t j = 0; done[i] == 0 && j < starts; ++j) {
            const double away = (grid_.place(chains[i].points[j]) - at).squaredNorm();
            if (away < nearest) {
                nearest = away;
                best = {i, j};
            }
        }
    }
    return best;
}

void Finishing::level_lines(std::vector<Chain>& chains, double z) {
    std::vector<char> done(chains.size(), 0);
    for (std::size_t count = 0; count < chains.size(); ++count) {
        const Entry entry = nearest_entry(chains, done);
        done[entry.chain] = 1;
        Chain& chain = chains[entry.chain];
        std::rotate(chain.points.begin(),
                    chain.points.begin() + static_cast<std::ptrdiff_t>(entry.corner),
                    chain.points.end());
        if (chain.closed) {
            chain.points.push_back(chain.points.front());
        }
        if (chain.points.size() > 1) {
            cut_level_line(chain, z);
        }
    }
}

void Finishing::cut_level_line(const Chain& chain, double z) {
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < chain.points.size(); ++i) {
        const Vector2d p = grid_.place(chain.points[i]);
        if (i > 0) {
            clear_chord(Vector2d(points.back().head<2>()), p, z, 6, points);
        }
        points.emplace_back(p.x(), p.y(), z);
    }
    points = thinned(points, kThinMm);
    const auto lead = [&](const Vector3d& end, const Vector3d& next) -> std::optional<Vector3d> {
        const Vector2d along = (next - end).head<2>().normalized();
        const Vector2d out = Vector2d(-along.y(), along.x()) * kLead * cutter_.tool.diameter_mm;
        const Vector2d at = Vector2d(end.head<2>()) + out;
        if (inside(at) && tip_.clears(at, z) && tip_.clears(Vector2d(end.head<2>()) + out / 2, z)) {
            return Vector3d(at.x(), at.y(), z);
        }
        return std::nullopt;
    };
    if (!step_over_to(points.front(), z)) {
        const auto in = lead(points.front(), points[1]);
        const Vector3d& start = in ? *in : points.front();
        writer_.approach(start, clear_above(start), cutter_.feeds.finish.plunge);
    }
    writer_.cut_along(points, cutter_.feeds.finish.feed);
    if (!chain.closed) {
        const std::size_t n = points.size();
        const Vector3d beyond = 2 * points[n - 1] - points[n - 2];
        if (const auto away = lead(points[n - 1], beyond)) {
            writer_.cut(*away, cutter_.feeds.finish.feed);
        }
    }
}

bool Finishing::step_over_to(const Vector3d& to, double z) {
    if (!writer_.is_down() || writer_.at()->z() < z) {
        return false;
    }
    const Vector3d from = *writer_.at();
    const double away = (to - from).head<2>().norm();
    if (away > kJumpLines * grid_.step || from.z() - z > 2 * kJumpLines * grid_.step) {
        return false;
    }
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
        const Vector2d at = from.head<2>() + share * (to - from).head<2>();
        if (!tip_.clears(at, from.z())) {
            return false;
        }
    }
    writer_.cut(Vector3d(to.x(), to.y(), from.z()), cutter_.feeds.finish.feed);
    writer_.cut(to, cutter_.feeds.finish.plunge);
    return true;
}

}  // namespace cam::mill
