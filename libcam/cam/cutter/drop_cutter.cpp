// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/cutter/drop_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

// Seen along an edge, q the axis, d its distance from the edge in plan, u the place on the edge:
//
//       u=0        r(u) = sqrt(d^2 + u^2)
//   -----+----x->  tip(u) = slope u - profile(r(u)), concave, so one maximum
//        |   /     zones by r: flat | corner | cone | beyond the radius nothing
//        d  / r
//        | /
//        q
//
// The maximum lies on the side to which the edge rises; in the flat zone it moves outwards.
namespace cam::cutter {

namespace {

constexpr int kNewtonSteps = 60;
constexpr double kSamePlace = 1e-8;  // mm along an edge; the height is flat there: error 1e-16

double half_chord(double radius, double distance) {
    return std::sqrt(std::max(0.0, radius * radius - distance * distance));
}

}  // namespace

struct DropCutter::Drop {
    double x = 0;
    double y = 0;
    double tip = kFree;
    double enough = -kFree;  ///< a tip above this one needs no further search
};

/// A cell of the surface that may raise the tip.
struct DropCutter::Candidate {
    double bound;  ///< no tip over this cell is higher
    int column;
    int row;
};

DropCutter::DropCutter(const Surface& surface, const tool::Outline& outline)
    : surface_(&surface),
      outline_(outline),
      corner_end_(outline.corner_end_r()),
      corner_end_z_(outline.corner_end_z()),
      cone_slope_(outline.cone ? 1 / std::tan(outline.lean)
                               : std::numeric_limits<double>::infinity()),
      rim_z_(outline.height(outline.radius)) {
    if (!outline.cone && outline.corner == 0) {
        kind_ = Kind::Flat;
    } else if (!outline.cone && outline.flat == 0) {
        kind_ = Kind::Ball;
    }
}

double DropCutter::height(double r) const {
    if (r <= outline_.flat) {
        return 0;
    }
    if (r < corner_end_ || !outline_.cone) {
        const double beyond = r - outline_.flat;
        return outline_.corner -
               std::sqrt(std::max(0.0, outline_.corner * outline_.corner - beyond * beyond));
    }
    return corner_end_z_ + (r - corner_end_) * cone_slope_;
}

/// Where under the corner an edge holds a bull-nose: Newton between brackets.
double DropCutter::best_on_corner(double distance, double slope, Span span) const {
    auto [low, high] = span;
    const double flat = outline_.flat;
    const double corner = outline_.corner;
    double u = (low + high) / 2;
    for (int step = 0; step < kNewtonSteps && high - low > kSamePlace; ++step) {
        const double r = std::sqrt(distance * distance + u * u);
        const double beyond = r - flat;
        const double rise = std::sqrt(std::max(0.0, corner * corner - beyond * beyond));
        if (rise == 0) {
            high = u;
            u = (low + high) / 2;
            continue;
        }
        const double profile_slope = beyond / rise;
        const double rest = slope - profile_slope * u / r;
        (rest > 0 ? low : high) = u;
        const double bend = corner * corner / (rise * rise * rise) * (u / r) * (u / r) +
                            profile_slope * distance * distance / (r * r * r);
        const double next = u + rest / bend;
        if (std::abs(next - u) < kSamePlace && next >= low && next <= high) {
            return next;
        }
        u = next > low && next < high ? next : (low + high) / 2;
    }
    return u;
}

/// The place of the maximum on an endless line that rises with `slope` >= 0; within the radius.
double DropCutter::best_along(double distance, double slope) const {
    const double corner = outline_.corner;
    const double end = half_chord(corner_end_, distance);
    const bool beyond_corner = outline_.cone && corner_end_ < outline_.radius;
    // Without a cone the profile is upright where the corner ends: the maximum lies before it.
    // Does the tip still rise where the corner ends?
    const bool on_corner = distance < corner_end_ && corner > 0 &&
                           (!outline_.cone || slope - cone_slope_ * end / corner_end_ < 0);
    if (on_corner) {
        if (outline_.flat == 0) {
            return std::sqrt(std::max(0.0, corner * corner - distance * distance)) * slope /
                   std::sqrt(1 + slope * slope);
        }
        const double low = half_chord(outline_.flat, distance);
        return low < end ? best_on_corner(distance, slope, {low, end}) : end;
    }
    if (!beyond_corner) {
        return half_chord(outline_.radius, distance);
    }
    const double rim = half_chord(outline_.radius, distance);
    if (slope >= cone_slope_) {
        return rim;
    }
    const double hyperbola =
        distance * slope / std::sqrt(cone_slope_ * cone_slope_ - slope * slope);
    return std::clamp(hyperbola, std::min(end, rim), rim);
}

double DropCutter::place_on(const Surface::Edge& edge, double distance, double rim) const {
    switch (kind_) {
        case Kind::Flat:
            return edge.slope >= 0 ? rim : -rim;
        case Kind::Ball:
            return rim * edge.sine;
        case Kind::Other:
            break;
    }
    return edge.slope >= 0 ? best_along(distance, edge.slope) : -best_along(distance, -edge.slope);
}

void DropCutter::lower_on_edge(const Surface::Edge& edge, Drop& drop) const {
    const double from_x = drop.x - edge.x;
    const double from_y = drop.y - edge.y;
    const double across = from_x * edge.along_y - from_y * edge.along_x;
    const double distance_squared = across * across;
    const double rim_squared = outline_.radius * outline_.radius - distance_squared;
    if (rim_squared < 0) {
        return;
    }
    const double foot = from_x * edge.along_x + from_y * edge.along_y;
    const double rim = std::sqrt(rim_squared);
    const double low = std::max(-foot, -rim);
    const double high = std::min(edge.length - foot, rim);
    if (low > high) {
        return;
    }
    // No place of the edge under the outline is higher than this.
    if (edge.z + edge.slope * (foot + (edge.slope >= 0 ? high : low)) <= drop.tip) {
        return;
    }
    const double u = std::clamp(place_on(edge, std::abs(across), rim), low, high);
    const double r = std::min(outline_.radius, std::sqrt(distance_squared + u * u));
    drop.tip = std::max(drop.tip, edge.z + edge.slope * (foot + u) - height(r));
}

/// The tip on the facet's whole plane: no point of the facet holds it higher.
double DropCutter::tip_on_plane(const Surface::Facet& facet, const Drop& drop) const {
    const double g = facet.steepness;
    const double below =
        facet.z0 + facet.gx * (drop.x - facet.corners[0]) + facet.gy * (drop.y - facet.corners[1]);
    if (g >= cone_slope_) {
        return below + g * outline_.radius - rim_z_;
    }
    return below + g * outline_.flat + outline_.corner * (facet.stretch - 1);
}

/// Whether the point that holds the tip on the plane lies in the facet.
bool DropCutter::holds_inside(const Surface::Facet& facet, const Drop& drop) const {
    const double g = facet.steepness;
    double share = 0;  // of the gradient
    if (g > 0) {
        share = g >= cone_slope_ ? outline_.radius / g
                                 : outline_.flat / g + outline_.corner / facet.stretch;
    }
    const double x = drop.x + facet.gx * share;
    const double y = drop.y + facet.gy * share;
    const auto& c = facet.corners;
    const auto left_of = [&](std::size_t a, std::size_t b) {
        return (c[b] - c[a]) * (y - c[a + 1]) - (c[b + 1] - c[a + 1]) * (x - c[a]) >= 0;
    };
    return left_of(0, 2) && left_of(2, 4) && left_of(4, 0);
}

/// Whether something at most this high and at least so far from the axis can raise the tip.
bool DropCutter::may_hold(double top, double away_squared, double tip) const {
    const double above = top - tip;
    if (above <= 0 || away_squared > outline_.radius * outline_.radius) {
        return false;
    }
    switch (kind_) {
        case Kind::Flat:
            return true;
        case Kind::Ball:
            return above >= outline_.radius || away_squared < above * (2 * outline_.radius - above);
        case Kind::Other:
            break;
    }
    return above > height(std::sqrt(away_squared));
}

void DropCutter::lower_on_cell(int column, int row, Drop& drop) const {
    for (const Surface::Entry& entry : surface_->in_cell(column, row)) {
        if (entry.top <= drop.tip || drop.tip > drop.enough) {
            return;
        }
        const Surface::Facet& facet = surface_->facet(entry.facet);
        const double away_x = std::max({0.0, facet.box[0] - drop.x, drop.x - facet.box[2]});
        const double away_y = std::max({0.0, facet.box[1] - drop.y, drop.y - facet.box[3]});
        if (!may_hold(entry.top, away_x * away_x + away_y * away_y, drop.tip)) {
            continue;
        }
        if (facet.has_plane) {
            const double tip = tip_on_plane(facet, drop);
            if (tip <= drop.tip) {
                continue;
            }
            if (holds_inside(facet, drop)) {
                drop.tip = tip;
                continue;
            }
        }
        for (const Surface::Edge& edge : surface_->edges_of(facet)) {
            lower_on_edge(edge, drop);
        }
    }
}

double DropCutter::lowest_tip(const Eigen::Vector2d& at, double floor) const {
    Drop drop{at.x(), at.y(), floor + outline_.z};
    lower(drop);
    return drop.tip - outline_.z;
}

bool DropCutter::clears(const Eigen::Vector2d& at, double z) const {
    const double limit = z + outline_.z;
    Drop drop{at.x(), at.y(), limit, limit};
    lower(drop);
    return drop.tip <= limit;
}

/// The cells under the outline that reach above the tip, row by row.
void DropCutter::collect_cells(const Drop& drop, std::vector<Candidate>& candidates) const {
    const Eigen::Vector2d at(drop.x, drop.y);
    const Surface& surface = *surface_;
    const double radius = outline_.radius;
    const double cell = surface.cell_mm();
    const double low_x = surface.bounds().min().x();
    const double low_y = surface.bounds().min().y();
    const auto cell_of = [&](double offset, int count) {
        return static_cast<int>(std::clamp(offset / cell, 0.0, static_cast<double>(count - 1)));
    };
    const int first_column = cell_of(at.x() - radius - low_x, surface.columns());
    const int last_column = cell_of(at.x() + radius - low_x, surface.columns());
    const int first_row = cell_of(at.y() - radius - low_y, surface.rows());
    const int last_row = cell_of(at.y() + radius - low_y, surface.rows());
    for (int row = first_row; row <= last_row; ++row) {
        const double y0 = low_y + row * cell;
        const double away_y = std::max({0.0, y0 - at.y(), at.y() - y0 - cell});
        for (int column = first_column; column <= last_column; ++column) {
            const auto entries = surface.in_cell(column, row);
            if (entries.empty()) {
                continue;
            }
            const double x0 = low_x + column * cell;
            const double away_x = std::max({0.0, x0 - at.x(), at.x() - x0 - cell});
            const double away = away_x * away_x + away_y * away_y;
            if (away > radius * radius) {
                continue;
            }
            const double bound = entries.front().top - height(std::sqrt(away));
            if (bound > drop.tip) {
                candidates.push_back({bound, column, row});
            }
        }
    }
}

void DropCutter::lower(Drop& drop) const {
    const auto& bounds = surface_->bounds();
    const double radius = outline_.radius;
    if (surface_->facets() == 0 || !(drop.x + radius >= bounds.min().x()) ||
        !(drop.y + radius >= bounds.min().y()) || !(drop.x - radius <= bounds.max().x()) ||
        !(drop.y - radius <= bounds.max().y())) {
        return;
    }
    thread_local std::vector<Candidate> candidates;
    candidates.clear();
    collect_cells(drop, candidates);
    const auto higher = [](const Candidate& a, const Candidate& b) { return a.bound > b.bound; };
    // The most promising cell mostly settles the height: the others need no order before that.
    const auto first = std::max_element(candidates.begin(), candidates.end(),
                                        [&](const auto& a, const auto& b) { return higher(b, a); });
    if (first != candidates.end()) {
        lower_on_cell(first->column, first->row, drop);
        first->bound = kFree;
        std::erase_if(candidates, [&](const Candidate& c) { return c.bound <= drop.tip; });
        std::sort(candidates.begin(), candidates.end(), higher);
    }
    for (const Candidate& candidate : candidates) {
        if (candidate.bound <= drop.tip || drop.tip > drop.enough) {
            break;
        }
        lower_on_cell(candidate.column, candidate.row, drop);
    }
}

}  // namespace cam::cutter
