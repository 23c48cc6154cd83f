// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/operators.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace decomp::labels {

namespace {

constexpr double kReferenceFacets = 3000;
constexpr int kBandRings = 6;
constexpr std::array<double, 3> kInsertRadii{1.5, 2.5, 4.0};  // units
constexpr std::array<double, 3> kCornerRadii{1.2, 2.0, 3.0};
constexpr std::array<double, 4> kTurnRadii{2.0, 3.5, 5.0, 7.0};
constexpr int kWidestStrip = 2;         // rings
constexpr double kSideways = 0.4;       // least component of a normal across the axis
constexpr double kCollaredChart = 0.1;  // of the area
constexpr double kSmallChart = 0.03;    // of the area
constexpr double kSpread = 2.0;         // units: places for insertion lie so far apart
constexpr std::size_t kMostPlaces = 3;

std::vector<AxisLabel> across_from(AxisLabel label) {
    std::vector<AxisLabel> out;
    for (int l = 0; l < kLabelCount; ++l) {
        if (axis_of(static_cast<AxisLabel>(l)) != axis_of(label)) {
            out.push_back(static_cast<AxisLabel>(l));
        }
    }
    return out;
}

std::vector<FacetLabel> labelled(const std::vector<std::uint32_t>& facets, AxisLabel label) {
    std::vector<FacetLabel> out;
    out.reserve(facets.size());
    for (const auto f : facets) {
        out.emplace_back(f, label);
    }
    return out;
}

void sort_unique(std::vector<std::uint32_t>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Facets near a vertex: those around it and what lies within the ball without a gap.
std::vector<std::uint32_t> disc(const Facets& facets, std::uint32_t vertex, double radius) {
    return within(facets, facets.around(vertex), facets.points[vertex], radius);
}

std::vector<std::uint32_t> facets_of_chart(const Scene& scene, std::uint32_t chart) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t f = 0; f < scene.labels.size(); ++f) {
        if (scene.layout.chart_of[f] == chart) {
            out.push_back(f);
        }
    }
    return out;
}

Proposal deletion(const Scene& scene, std::uint32_t chart) {
    Proposal proposal;
    proposal.deletes = true;
    for (const auto f : facets_of_chart(scene, chart)) {
        proposal.forbidden.emplace_back(f, scene.labels[f]);
    }
    return proposal;
}

/// The labels of the charts around a vertex, ascending.
std::vector<AxisLabel> labels_at(const Scene& scene, std::uint32_t vertex) {
    std::vector<AxisLabel> out;
    for (const auto f : scene.energy.facets().around(vertex)) {
        out.push_back(scene.labels[f]);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

/// Vertices on the border of a chart, ascending.
std::vector<std::uint32_t> border_of(const Scene& scene, std::uint32_t chart) {
    std::vector<std::uint32_t> out;
    for (const Boundary& boundary : scene.layout.boundaries) {
        if (boundary.left == chart || boundary.right == chart) {
            out.insert(out.end(), boundary.vertices.begin(), boundary.vertices.end());
        }
    }
    sort_unique(out);
    return out;
}

/// Mean misfit that a disc would gain by taking the label; may be negative.
double gain_of(const Scene& scene, const std::vector<std::uint32_t>& disc, AxisLabel label) {
    double gain = 0;
    double area = 0;
    for (const auto f : disc) {
        const LabelCosts& misfit = scene.energy.misfit(f);
        gain += misfit.at(static_cast<std::size_t>(scene.labels[f])) -
                misfit.at(static_cast<std::size_t>(label));
        area += scene.energy.facets().areas[f];
    }
    return area > 0 ? gain / area : 0;
}

/// The facets on either side of a boundary.
std::vector<std::uint32_t> both_sides(const Facets& facets, const Boundary& boundary) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < boundary.facets.size(); ++i) {
        const std::uint32_t f = boundary.facets[i];
        out.push_back(f);
        for (std::size_t k = 0; k < 3; ++k) {
            if (facets.corners[f].at(k) == boundary.vertices[i] &&
                facets.corners[f].at((k + 1) % 3) == boundary.vertices[i + 1]) {
                out.push_back(facets.neighbours[f].at(k));
            }
        }
    }
    sort_unique(out);
    return out;
}

/// Facets that face sideways get the label of the two other axes that is nearest to their normal:
/// four charts around a rim or in a hole.
Proposal collar(const Scene& scene, const std::vector<std::uint32_t>& band, int axis) {
    Proposal proposal;
    for (const auto f : band) {
        const Eigen::Vector3d& normal = scene.energy.facets().normals[f];
        AxisLabel best = label_of((axis + 1) % 3, 1);
        double most = -2;
        for (const AxisLabel label : across_from(label_of(axis, 1))) {
            const double along = sign_of(label) * normal[axis_of(label)];
            if (along > most) {
                most = along;
                best = label;
            }
        }
        if (most > kSideways) {
            proposal.forced.emplace_back(f, best);
        }
    }
    return proposal;
}

/// The same facets with one label after another; false when no more are wanted.
bool consider_each(const Consider& consider, const std::vector<std::uint32_t>& facets,
                   const std::vector<AxisLabel>& labels) {
    return std::all_of(labels.begin(), labels.end(), [&](AxisLabel label) {
        return consider({labelled(facets, label), {}, false});
    });
}

/// Keeps a chart and its opposite apart by a strip: of a third label, of any but these two, or of
/// a collar; false when no more are wanted.
bool consider_strip(const Scene& scene, const Consider& consider,
                    const std::vector<std::uint32_t>& strip, AxisLabel own) {
    if (!consider_each(consider, strip, across_from(own))) {
        return false;
    }
    Proposal neither;
    for (const auto f : strip) {
        neither.forbidden.emplace_back(f, own);
        neither.forbidden.emplace_back(f, opposite(own));
    }
    return consider(neither) && consider(collar(scene, strip, axis_of(own)));
}

/// Deletes the small charts about a vertex; false when no more are wanted.
bool consider_deletions(const Scene& scene, const Consider& consider, std::uint32_t vertex) {
    const Facets& facets = scene.energy.facets();
    std::vector<std::uint32_t> charts;
    for (const auto f : facets.around(vertex)) {
        charts.push_back(scene.layout.chart_of[f]);
    }
    sort_unique(charts);
    return std::all_of(charts.begin(), charts.end(), [&](std::uint32_t chart) {
        return scene.layout.charts[chart].area >= kSmallChart * facets.area ||
               consider(deletion(scene, chart));
    });
}

class ChartProposals {
  public:
    ChartProposals(const Scene& scene, const Consider& consider, std::uint32_t chart)
        : scene_(scene),
          facets_(scene.energy.facets()),
          consider_(consider),
          chart_(chart),
          border_(border_of(scene, chart)) {}

    /// False when no more are wanted.
    bool all() {
        const AxisLabel own = scene_.layout.charts[chart_].label;
        if (!consider_(deletion(scene_, chart_))) {
            return false;
        }
        if (!collars()) {
            return false;
        }
        std::array<std::vector<std::vector<std::uint32_t>>, kInsertRadii.size()> discs;
        for (std::size_t r = 0; r < kInsertRadii.size(); ++r) {
            for (const auto v : border_) {
                discs.at(r).push_back(disc(facets_, v, kInsertRadii.at(r) * facets_.unit));
            }
        }
        for (const AxisLabel label : across_from(own)) {
            if (has_neighbour(label) && scene_.layout.charts[chart_].neighbours.size() > 2) {
                continue;
            }
            for (const auto& sized : discs) {
                if (!insert(sized, label)) {
                    return false;
                }
            }
        }
        return true;
    }

  private:
    [[nodiscard]] bool has_neighbour(AxisLabel label) const {
        const auto& around = scene_.layout.charts[chart_].neighbours;
        return std::any_of(around.begin(), around.end(),
                           [&](std::uint32_t n) { return scene_.layout.charts[n].label == label; });
    }

    /// Four charts around: bands of several widths along each boundary without a corner, and a
    /// small chart altogether.
    bool collars() {
        std::vector<std::vector<std::uint32_t>> seams;
        for (const Boundary& boundary : scene_.layout.boundaries) {
            if ((boundary.left == chart_ || boundary.right == chart_) && boundary.closed) {
                seams.push_back(both_sides(facets_, boundary));
            }
        }
        if (scene_.layout.charts[chart_].area < kCollaredChart * facets_.area) {
            seams.push_back(facets_of_chart(scene_, chart_));
        }
        for (const auto& seam : seams) {
            for (int rings = 0; rings <= kWidestStrip; ++rings) {
                if (!collar_about_any_axis(grown(facets_, seam, scaled_rings(facets_, rings)))) {
                    return false;
                }
            }
        }
        return true;
    }

    bool collar_about_any_axis(const std::vector<std::uint32_t>& band) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!consider_(collar(scene_, band, axis))) {
                return false;
            }
        }
        return true;
    }

    /// At the places where normals speak most for the label, some way apart.
    bool insert(const std::vector<std::vector<std::uint32_t>>& discs, AxisLabel label) {
        std::vector<std::pair<double, std::size_t>> places;
        for (std::size_t i = 0; i < discs.size(); ++i) {
            places.emplace_back(-gain_of(scene_, discs[i], label), i);
        }
        std::sort(places.begin(), places.end());
        std::vector<std::uint32_t> taken;
        for (const auto& [loss, i] : places) {
            const Eigen::Vector3d& at = facets_.points[border_[i]];
            const bool apart = std::all_of(taken.begin(), taken.end(), [&](std::uint32_t v) {
                return (facets_.points[v] - at).norm() > kSpread * facets_.unit;
            });
            if (!apart) {
                continue;
            }
            taken.push_back(border_[i]);
            Proposal proposal;
            proposal.forced = labelled(discs[i], label);
            if (!consider_(proposal)) {
                return false;
            }
            if (taken.size() == kMostPlaces) {
                break;
            }
        }
        return true;
    }

    const Scene& scene_;
    const Facets& facets_;
    const Consider& consider_;
    std::uint32_t chart_;
    std::vector<std::uint32_t> border_;
};

}  // namespace

int scaled_rings(const Facets& facets, int rings) {
    const double finer = std::sqrt(static_cast<double>(facets.count()) / kReferenceFacets);
    return std::max(rings > 0 ? 1 : 0, static_cast<int>(std::lround(rings * finer)));
}

void propose_for_charts(const Scene& scene, const Consider& consider) {
    std::vector<std::uint32_t> wrong;
    for (std::uint32_t c = 0; c < scene.layout.charts.size(); ++c) {
        if (scene.layout.charts[c].loops > 0 && scene.layout.charts[c].deficiency > 0) {
            wrong.push_back(c);
        }
    }
    std::stable_sort(wrong.begin(), wrong.end(), [&](std::uint32_t a, std::uint32_t b) {
        return scene.layout.charts[a].area > scene.layout.charts[b].area;
    });
    for (const auto chart : wrong) {
        if (!ChartProposals(scene, consider, chart).all()) {
            return;
        }
    }
}

void propose_for_opposites(const Scene& scene, const Consider& consider) {
    const Facets& facets = scene.energy.facets();
    for (const auto b : scene.layout.opposite) {
        const Boundary& boundary = scene.layout.boundaries[b];
        const AxisLabel own = scene.layout.charts[boundary.left].label;
        std::vector<std::uint32_t> seam = both_sides(facets, boundary);
        for (int rings = 0; rings <= kWidestStrip; ++rings) {
            const auto strip = grown(facets, seam, scaled_rings(facets, rings));
            if (!consider_strip(scene, consider, strip, own)) {
                return;
            }
        }
        const bool left_is_smaller =
            scene.layout.charts[boundary.left].area < scene.layout.charts[boundary.right].area;
        if (!consider(deletion(scene, left_is_smaller ? boundary.left : boundary.right))) {
            return;
        }
    }
}

void propose_for_corners(const Scene& scene, const Consider& consider) {
    const Facets& facets = scene.energy.facets();
    for (const auto vertex : scene.layout.bad_corners) {
        for (const double radius : kCornerRadii) {
            const auto here = disc(facets, vertex, radius * facets.unit);
            if (!consider_each(consider, here, labels_at(scene, vertex))) {
                return;
            }
        }
    }
}

void propose_for_turns(const Scene& scene, const Consider& consider) {
    const Facets& facets = scene.energy.facets();
    for (const TurningPoint& turn : scene.layout.turning_points) {
        std::vector<AxisLabel> tried{label_of(turn.axis, 1), label_of(turn.axis, -1)};
        const auto around = labels_at(scene, turn.vertex);
        tried.insert(tried.end(), around.begin(), around.end());
        for (const double radius : kTurnRadii) {
            const auto here = disc(facets, turn.vertex, radius * facets.unit);
            if (!consider_each(consider, here, tried)) {
                return;
            }
        }
        if (!consider_deletions(scene, consider, turn.vertex)) {
            return;
        }
    }
}

}  // namespace decomp::labels
