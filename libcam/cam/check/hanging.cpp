// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/hanging.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace cam::check {

namespace {

using decomp::mesh::TriMesh;
using Neighbours = std::vector<std::array<std::int32_t, 3>>;

constexpr double kLevel = 0.9848;     // cosine of 10 degrees
constexpr int kDirections = 36;       // 5 degrees apart
constexpr int kLines = 64;            // across a patch
constexpr double kRested = 0.95;      // of a bridge's lines
constexpr double kFallsMm = 1e-6;     // an edge's wall goes down by more
constexpr double kSameSpanMm = 1e-6;  // a bridge may be longer by this

/// Heights of the joints at which components of the growing sublevel set are taken up by older
/// ones: `joint[v]` for a point v that began one, minus infinity for all others.
std::vector<double> joints(const TriMesh& mesh, const std::vector<double>& height) {
    const std::size_t count = mesh.points.size();
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return height[a] != height[b] ? height[a] < height[b] : a < b;
    });
    std::vector<std::uint32_t> rank(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        rank[order[i]] = i;
    }
    // An edge joins its components when its later point is reached.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  // ranks: later, earlier
    edges.reserve(3 * mesh.triangles.size());
    std::vector<bool> used(count, false);
    for (const auto& t : mesh.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = rank[t[corner]];
            const std::uint32_t b = rank[t[(corner + 1) % 3]];
            edges.emplace_back(std::max(a, b), std::min(a, b));
            used[t[corner]] = true;
        }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<std::uint32_t> parent(count);  // by rank; the root is the lowest of its component
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root_of = [&](std::uint32_t v) {
        while (parent[v] != v) {
            parent[v] = parent[parent[v]];
            v = parent[v];
        }
        return v;
    };
    std::vector<double> joint(count, std::numeric_limits<double>::infinity());
    for (const auto& [later, earlier] : edges) {
        const std::uint32_t a = root_of(later);
        const std::uint32_t b = root_of(earlier);
        if (a != b) {
            parent[std::max(a, b)] = std::min(a, b);
            joint[order[std::max(a, b)]] = height[order[later]];
        }
    }
    for (std::size_t v = 0; v < count; ++v) {
        if (!used[v]) {
            joint[v] = -std::numeric_limits<double>::infinity();
        }
    }
    return joint;
}

class Patches {
  public:
    Patches(const TriMesh& mesh, const decomp::mesh::Facets& facets, const Neighbours& neighbours,
            const Eigen::Vector3d& down, std::vector<Hanging>& kind)
        : mesh_(mesh), facets_(facets), neighbours_(neighbours), down_(down), kind_(kind) {
        height_.reserve(mesh.points.size());
        for (const Eigen::Vector3d& point : mesh.points) {
            height_.push_back(-down.dot(point));
        }
    }

    void mark_islands(double floor_mm, double layer_height_mm) {
        const std::vector<double> joint = joints(mesh_, height_);
        std::vector<std::vector<std::uint32_t>> around(mesh_.points.size());
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            if (kind_[i] == Hanging::Overhang) {
                for (const std::uint32_t v : mesh_.triangles[i]) {
                    around[v].push_back(i);
                }
            }
        }
        for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
            if (!around[v].empty() && height_[v] > floor_mm &&
                joint[v] - height_[v] > layer_height_mm) {
                flood_island(v, joint[v], around);
            }
        }
    }

    void mark_bridges(double longest_mm) {
        std::vector<char> taken(mesh_.triangles.size(), 0);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            if (taken[i] != 0 || !is_level(i)) {
                continue;
            }
            const std::vector<std::uint32_t> patch = level_patch(i, taken);
            if (rests(patch, longest_mm)) {
                for (const std::uint32_t member : patch) {
                    kind_[member] = Hanging::Bridge;
                }
            }
        }
    }

  private:
    struct Edge {
        Eigen::Vector2d from;
        Eigen::Vector2d to;
        bool anchored;
    };

    void flood_island(std::uint32_t start, double below,
                      const std::vector<std::vector<std::uint32_t>>& around) {
        std::vector<std::uint32_t> left{start};
        while (!left.empty()) {
            const std::uint32_t v = left.back();
            left.pop_back();
            for (const std::uint32_t facet : around[v]) {
                add_to_island(facet, below, left);
            }
        }
    }

    /// A facet that still hangs joins the island, which goes on from its low corners.
    void add_to_island(std::uint32_t facet, double below, std::vector<std::uint32_t>& left) {
        if (kind_[facet] != Hanging::Overhang) {
            return;
        }
        kind_[facet] = Hanging::Island;
        for (const std::uint32_t next : mesh_.triangles[facet]) {
            if (height_[next] < below) {
                left.push_back(next);
            }
        }
    }

    [[nodiscard]] bool is_level(std::uint32_t facet) const {
        return kind_[facet] == Hanging::Overhang && facets_.unit[facet].dot(down_) > kLevel;
    }

    [[nodiscard]] std::vector<std::uint32_t> level_patch(std::uint32_t start,
                                                         std::vector<char>& taken) const {
        std::vector<std::uint32_t> patch{start};
        taken[start] = 1;
        for (std::size_t done = 0; done < patch.size(); ++done) {
            for (const std::int32_t other : neighbours_[patch[done]]) {
                const auto next = static_cast<std::uint32_t>(other);
                if (other >= 0 && taken[next] == 0 && is_level(next)) {
                    taken[next] = 1;
                    patch.push_back(next);
                }
            }
        }
        return patch;
    }

    /// The border of a patch seen from below; an edge is anchored where the surface goes down
    /// beyond it.
    [[nodiscard]] std::vector<Edge> border(const std::vector<std::uint32_t>& patch) const {
        const Eigen::Vector3d right = down_.unitOrthogonal();
        const Eigen::Vector3d ahead = down_.cross(right);
        std::vector<char> inside(mesh_.triangles.size(), 0);
        for (const std::uint32_t member : patch) {
            inside[member] = 1;
        }
        const auto flat = [&](std::uint32_t v) {
            return Eigen::Vector2d(mesh_.points[v].dot(right), mesh_.points[v].dot(ahead));
        };
        std::vector<Edge> edges;
        for (const std::uint32_t member : patch) {
            const auto& t = mesh_.triangles[member];
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::int32_t other = neighbours_[member][corner];
                if (other >= 0 && inside[static_cast<std::size_t>(other)] != 0) {
                    continue;
                }
                const std::uint32_t a = t[corner];
                const std::uint32_t b = t[(corner + 1) % 3];
                edges.push_back({flat(a), flat(b), other >= 0 && goes_down(other, a, b)});
            }
        }
        return edges;
    }

    [[nodiscard]] bool goes_down(std::int32_t facet, std::uint32_t a, std::uint32_t b) const {
        for (const std::uint32_t v : mesh_.triangles[static_cast<std::size_t>(facet)]) {
            if (v != a && v != b) {
                return height_[v] < std::min(height_[a], height_[b]) - kFallsMm;
            }
        }
        return false;
    }

    [[nodiscard]] bool rests(const std::vector<std::uint32_t>& patch, double longest_mm) const {
        const std::vector<Edge> edges = border(patch);
        const bool any =
            std::any_of(edges.begin(), edges.end(), [](const Edge& edge) { return edge.anchored; });
        for (int k = 0; any && k < kDirections; ++k) {
            const double angle = std::numbers::pi * k / kDirections;
            if (rests_along(edges, {std::cos(angle), std::sin(angle)}, longest_mm)) {
                return true;
            }
        }
        return false;
    }

    static bool rests_along(const std::vector<Edge>& edges, const Eigen::Vector2d& along,
                            double longest_mm) {
        const Eigen::Vector2d across(-along.y(), along.x());
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (const Edge& edge : edges) {
            low = std::min(low, edge.from.dot(across));
            high = std::max(high, edge.from.dot(across));
        }
        double rested = 0;
        double total = 0;
        std::vector<std::pair<double, bool>> crossings;
        for (int line = 0; line < kLines; ++line) {
            const double y = low + (line + 0.5) * (high - low) / kLines;
            crossings.clear();
            for (const Edge& edge : edges) {
                const double from = edge.from.dot(across) - y;
                const double to = edge.to.dot(across) - y;
                if ((from < 0) != (to < 0)) {
                    const double share = from / (from - to);
                    crossings.emplace_back(
                        edge.from.dot(along) + share * (edge.to - edge.from).dot(along),
                        edge.anchored);
                }
            }
            std::sort(crossings.begin(), crossings.end());
            for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
                const double span = crossings[i + 1].first - crossings[i].first;
                if (span > longest_mm + kSameSpanMm) {
                    return false;
                }
                total += span;
                rested += crossings[i].second && crossings[i + 1].second ? span : 0;
            }
        }
        return total > 0 && rested >= kRested * total;
    }

    const TriMesh& mesh_;
    const decomp::mesh::Facets& facets_;
    const Neighbours& neighbours_;
    const Eigen::Vector3d& down_;
    std::vector<Hanging>& kind_;
    std::vector<double> height_;
};

}  // namespace

std::vector<Hanging> classify_hanging(const TriMesh& mesh, const decomp::mesh::Facets& facets,
                                      const Neighbours& neighbours,
                                      const orient::Overhang& overhang, const Eigen::Vector3d& down,
                                      const HangingOptions& options) {
    std::vector<Hanging> kind(mesh.triangles.size(), Hanging::Free);
    double floor = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < kind.size(); ++i) {
        kind[i] = overhang.lie[i] == orient::Lie::Plate      ? Hanging::Plate
                  : overhang.lie[i] == orient::Lie::Overhang ? Hanging::Overhang
                                                             : Hanging::Free;
        for (const std::uint32_t v : mesh.triangles[i]) {
            floor = std::min(floor, -down.dot(mesh.points[v]));
        }
    }
    Patches patches(mesh, facets, neighbours, down, kind);
    patches.mark_islands(floor + orient::kOnPlateMm, options.layer_height_mm);
    patches.mark_bridges(options.longest_bridge_mm);
    return kind;
}

}  // namespace cam::check
