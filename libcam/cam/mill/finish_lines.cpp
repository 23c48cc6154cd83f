// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/finishing_detail.h"
#include "cam/mill/order.h"

#include <algorithm>
#include <cmath>

namespace cam::mill {

using check::HeightMap;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kRowSlope = 0.4;  // rises more from row to row: a further row between them
constexpr double kBeside = 0.01;   // mm: the slope at a place is that to a place beside it

}  // namespace

void Finishing::lines(path::MillOperation operation) {
    writer_.take(cutter_, cutter_.feeds.finish.spindle_rpm, operation);
    std::vector<std::vector<Vector3d>> lines;
    for (int row = 0; row < grid_.lattice.rows; ++row) {
        add_row(row, lines);
        if (row + 1 < grid_.lattice.rows) {
            add_row_between(row, lines);
        }
    }
    std::vector<Stretch> stretches;
    stretches.reserve(lines.size());
    for (const std::vector<Vector3d>& line : lines) {
        stretches.push_back({line.front().head<2>(), line.back().head<2>()});
    }
    const Vector2d start = writer_.at() ? Vector2d(writer_.at()->head<2>()) : room_.min();
    for (const Turn& turn : short_order(stretches, start)) {
        std::vector<Vector3d>& line = lines[turn.index];
        if (turn.backwards) {
            std::reverse(line.begin(), line.end());
        }
        cut_line(line);
    }
    writer_.retract();
}

void Finishing::add_row(int row, std::vector<std::vector<Vector3d>>& lines) const {
    const Lattice& lattice = grid_.lattice;
    for (int column = 0; column < lattice.columns; ++column) {
        if (line_[lattice.index(column, row)] == 0) {
            continue;
        }
        int last = column;
        while (last + 1 < lattice.columns && line_[lattice.index(last + 1, row)] != 0) {
            ++last;
        }
        // One node into the steep at either end.
        const int first = column > 0 && usable(column - 1, row) ? column - 1 : column;
        const int end = last + 1 < lattice.columns && usable(last + 1, row) ? last + 1 : last;
        std::vector<Vector3d>& line = lines.emplace_back();
        for (int c = first; c <= end; ++c) {
            line.push_back(node(c, row));
        }
        column = last;
    }
}

void Finishing::add_row_between(int row, std::vector<std::vector<Vector3d>>& lines) const {
    bool going_on = false;
    for (int column = 0; column < grid_.lattice.columns; ++column) {
        const std::optional<Vector3d> between = node_between(column, row);
        if (between) {
            if (!going_on) {
                lines.emplace_back();
            }
            lines.back().push_back(*between);
        }
        going_on = between.has_value();
    }
}

std::optional<Vector3d> Finishing::node_between(int column, int row) const {
    const Vector3d one = node(column, row);
    const Vector3d other = node(column, row + 1);
    const Vector3d& low = one.z() < other.z() ? one : other;
    const Vector3d& high = one.z() < other.z() ? other : one;
    const int low_row = one.z() < other.z() ? row : row + 1;
    if (line_[grid_.lattice.index(column, low_row)] == 0 || !usable(column, row) ||
        !usable(column, row + 1) || high.z() - low.z() <= kRowSlope * grid_.step) {
        return std::nullopt;
    }
    const double steepest = std::tan(task_.steep.radians());
    const Vector2d up = (high - low).head<2>() / grid_.step;
    const auto place = [&](double share) -> Vector2d {
        return low.head<2>() + share * grid_.step * up;
    };
    // Up the wall, or on what lies above it: steeply above the low node.
    const auto is_steep = [&](double share) {
        const double here = tip_.lowest(place(share));
        const double beside = tip_.lowest(place(share) + kBeside * up);
        return beside - here > steepest * kBeside ||
               beside - low.z() > steepest * (share * grid_.step + kBeside);
    };
    double share = 0.5;
    if (high.z() - low.z() > steepest * grid_.step && !is_steep(0)) {
        double wall = 1;
        share = 0;
        while ((wall - share) * grid_.step > kPlaceMm) {
            const double middle = (wall + share) / 2;
            (is_steep(middle) ? wall : share) = middle;
        }
    }
    const Vector2d at = place(share);
    return Vector3d(at.x(), at.y(), tip_.lowest(at));
}

void Finishing::cut_line(const std::vector<Vector3d>& nodes) {
    const double reach = kJumpLines * grid_.step;
    std::vector<Vector3d> points;
    if (writer_.is_down() && (nodes.front() - *writer_.at()).head<2>().norm() < reach) {
        points.push_back(*writer_.at());
        tip_.follow(points.front(), nodes.front(), points);
    } else {
        writer_.approach(nodes.front(), clear_above(nodes.front()), cutter_.feeds.finish.plunge);
        points.push_back(nodes.front());
    }
    for (std::size_t i = 1; i < nodes.size(); ++i) {
        tip_.follow(nodes[i - 1], nodes[i], points);
    }
    writer_.cut_along(thinned(points, kThinMm), cutter_.feeds.finish.feed);
}

}  // namespace cam::mill
