// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/polycube/check.h"

#include "decomp/polycube/exact_detail.h"
#include "decomp/repair/intersect.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace decomp::polycube {

namespace {

using Point = Eigen::Vector3d;
using Corners = std::array<std::uint32_t, 3>;

constexpr double kRigid = 1e-9;  // of the extent: by how much a moved body may be off

struct Facet {
    Corners corners{};  ///< outward, by the tet's sense in the shape
    labels::AxisLabel label{};
};

/// Faces of one tet only, turned so that they look away from the fourth corner in the shape.
std::vector<Facet> boundary_facets(const tets::Pair& pair) {
    std::map<Corners, std::pair<int, Facet>> seen;
    std::vector<Corners> order;
    // In the boundary order of labels: tet by tet, the face opposite to corner 0, 1, 2, 3.
    for (const tets::Tet& tet : pair.tets) {
        const int sense = volume_sign(pair.shape[tet[0]], pair.shape[tet[1]], pair.shape[tet[2]],
                                      pair.shape[tet[3]]);
        for (std::size_t k = 0; k < 4; ++k) {
            Facet facet{{tet.at((k + 1) % 4), tet.at((k + 2) % 4), tet.at((k + 3) % 4)}, {}};
            if ((k % 2 == 1) != (sense < 0)) {
                std::swap(facet.corners[1], facet.corners[2]);
            }
            Corners key = facet.corners;
            std::sort(key.begin(), key.end());
            auto& entry = seen[key];
            if (entry.first++ == 0) {
                entry.second = facet;
                order.push_back(key);
            }
        }
    }
    std::vector<Facet> out;
    for (const Corners& key : order) {
        if (const auto& [count, facet] = seen[key]; count == 1) {
            out.push_back(facet);
        }
    }
    return out;
}

/// Whether the polycube is the shape, turned and moved.
bool is_moved_body(const tets::Pair& pair) {
    const std::size_t n = pair.shape.size();
    Point from = Point::Zero();
    Point to = Point::Zero();
    for (std::size_t i = 0; i < n; ++i) {
        from += pair.shape[i] / static_cast<double>(n);
        to += pair.polycube[i] / static_cast<double>(n);
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
        spread += (pair.shape[i] - from) * (pair.shape[i] - from).transpose();
        cross += (pair.polycube[i] - to) * (pair.shape[i] - from).transpose();
    }
    const Eigen::Matrix3d turn = cross * spread.inverse();
    if (!turn.allFinite() || !(turn * turn.transpose()).isIdentity(kRigid)) {
        return false;
    }
    double size = 0;
    double off = 0;
    for (std::size_t i = 0; i < n; ++i) {
        size = std::max(size, (pair.shape[i] - from).norm());
        off = std::max(off, (turn * (pair.shape[i] - from) - (pair.polycube[i] - to)).norm());
    }
    return off <= kRigid * size;
}

class Checker {
  public:
    Checker(const tets::Pair& pair, std::span<const labels::AxisLabel> labels)
        : pair_(pair), given_(labels), facets_(boundary_facets(pair)) {}

    PairReport report() {
        out_.tets = pair_.tets.size();
        out_.facets = facets_.size();
        count_flips();
        label_facets();
        count_charts();
        out_.identity = is_moved_body(pair_);
        if (out_.flips == 0 && out_.backward_facets == 0) {
            out_.overlaps = boundary_crosses();
        }
        if (out_.identity) {
            out_.tier = "T4";
        } else if (!out_.labels_valid()) {
            out_.tier = "T3";
        } else {
            out_.tier = out_.flips == 0 ? "T1" : "T2";
        }
        return out_;
    }

  private:
    void count_flips() {
        double total = 0;
        double upright = 0;
        double flipped = 0;
        std::size_t positive = 0;
        std::size_t negative = 0;
        for (const tets::Tet& t : pair_.tets) {
            const auto sign = [&](const std::vector<Point>& at) {
                return volume_sign(at[t[0]], at[t[1]], at[t[2]], at[t[3]]);
            };
            const int shape = sign(pair_.shape);
            const int both = shape * sign(pair_.polycube);
            const Point& a = pair_.shape[t[0]];
            const double volume = std::abs((pair_.shape[t[1]] - a)
                                               .cross(pair_.shape[t[2]] - a)
                                               .dot(pair_.shape[t[3]] - a)) /
                                  6;
            total += volume;
            out_.flat_in_shape += shape == 0 ? 1 : 0;
            positive += both > 0 ? 1 : 0;
            negative += both < 0 ? 1 : 0;
            upright += both > 0 ? volume : 0;
            flipped += both < 0 ? volume : 0;
        }
        mirrored_ = flipped > upright;
        out_.flips = pair_.tets.size() - out_.flat_in_shape - (mirrored_ ? negative : positive);
        if (total > 0) {
            out_.flipped_share = 1 - (mirrored_ ? flipped : upright) / total;
        }
        if (out_.flips == 0) {
            out_.flipped_share = 0;
        }
    }

    void label_facets() {
        const bool told = given_.size() == facets_.size();
        for (std::size_t i = 0; i < facets_.size(); ++i) {
            Facet& facet = facets_[i];
            const Point& a = pair_.polycube[facet.corners[0]];
            const Point& b = pair_.polycube[facet.corners[1]];
            const Point& c = pair_.polycube[facet.corners[2]];
            const int turn = mirrored_ ? -1 : 1;
            if (told) {
                facet.label = given_[i];
            } else {
                int axis = 0;
                (b - a).cross(c - a).cwiseAbs().maxCoeff(&axis);
                const int sign = turn * area_sign(a, b, c, axis);
                facet.label = labels::label_of(axis, sign >= 0 ? 1 : -1);
            }
            const int axis = labels::axis_of(facet.label);
            const bool flat = a[axis] == b[axis] && b[axis] == c[axis];
            out_.off_axis_facets += !flat || (!told && !given_.empty()) ? 1 : 0;
            out_.backward_facets +=
                turn * area_sign(a, b, c, axis) != labels::sign_of(facet.label) ? 1 : 0;
        }
    }

    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    using FacetsAtEdges = std::map<Edge, std::vector<std::size_t>>;

    [[nodiscard]] FacetsAtEdges facets_at_edges() const {
        FacetsAtEdges sides;
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                const auto edge =
                    std::minmax(facets_[f].corners.at(k), facets_[f].corners.at((k + 1) % 3));
                sides[{edge.first, edge.second}].push_back(f);
            }
        }
        return sides;
    }

    /// For each facet one that stands for its chart.
    [[nodiscard]] std::vector<std::size_t> charts(const FacetsAtEdges& sides) const {
        std::vector<std::size_t> chart(facets_.size());
        std::iota(chart.begin(), chart.end(), std::size_t{0});
        const auto root = [&](std::size_t f) {
            while (chart[f] != f) {
                f = chart[f] = chart[chart[f]];
            }
            return f;
        };
        for (const auto& [edge, on] : sides) {
            for (const std::size_t f : on) {
                if (facets_[f].label == facets_[on[0]].label) {
                    chart[root(f)] = root(on[0]);
                }
            }
        }
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            chart[f] = root(f);
        }
        return chart;
    }

    void count_charts() {
        const FacetsAtEdges sides = facets_at_edges();
        const std::vector<std::size_t> chart = charts(sides);
        std::map<std::size_t, std::set<std::size_t>> neighbours;
        std::set<std::pair<std::size_t, std::size_t>> opposite;
        std::map<std::uint32_t, int> ends;  // boundary edges at each point
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            neighbours[chart[f]];
        }
        for (const auto& [edge, on] : sides) {
            for (std::size_t i = 1; i < on.size(); ++i) {
                const std::size_t a = chart[on[0]];
                const std::size_t b = chart[on[i]];
                if (a == b) {
                    continue;
                }
                neighbours[a].insert(b);
                neighbours[b].insert(a);
                if (labels::axis_of(facets_[a].label) == labels::axis_of(facets_[b].label)) {
                    opposite.insert(std::minmax(a, b));
                }
                ++ends[edge.first];
                ++ends[edge.second];
            }
        }
        out_.charts = static_cast<int>(neighbours.size());
        for (const auto& [which, others] : neighbours) {
            out_.poor_charts += others.size() < 4 ? 1 : 0;
        }
        out_.opposite_boundaries = static_cast<int>(opposite.size());
        count_corners(ends);
    }

    /// Points where three boundary edges or more meet.
    void count_corners(const std::map<std::uint32_t, int>& ends) {
        std::map<std::uint32_t, std::set<int>> axes;
        for (const Facet& facet : facets_) {
            for (const std::uint32_t corner : facet.corners) {
                axes[corner].insert(labels::axis_of(facet.label));
            }
        }
        for (const auto& [point, count] : ends) {
            if (count >= 3) {
                ++out_.corners;
                out_.bad_corners += count > 3 || axes[point].size() != 3 ? 1 : 0;
            }
        }
    }

    [[nodiscard]] bool boundary_crosses() const {
        mesh::TriMesh surface;
        surface.points = pair_.polycube;
        for (const Facet& facet : facets_) {
            surface.triangles.push_back(facet.corners);
        }
        return !repair::self_intersections(surface, 1).empty();
    }

    const tets::Pair& pair_;
    std::span<const labels::AxisLabel> given_;
    std::vector<Facet> facets_;
    bool mirrored_ = false;
    PairReport out_;
};

}  // namespace

PairReport check_pair(const tets::Pair& pair, std::span<const labels::AxisLabel> labels) {
    return Checker(pair, labels).report();
}

}  // namespace decomp::polycube
