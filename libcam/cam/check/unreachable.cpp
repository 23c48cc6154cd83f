// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/unreachable.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/holes.h"
#include "decomp/repair/intersect.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

namespace cam::check {

using decomp::Result;
using decomp::Run;
using decomp::mesh::TriMesh;

namespace {

constexpr double kSpeck = 0.01;           // of a shell's area: wanted pieces below it are specks
constexpr int kMostRounds = 12;           // of leaving patches whose closed hole does harm
constexpr std::size_t kCrossings = 1000;  // pairs looked at in a round
constexpr std::int32_t kNone = -1;

/// Facets in connected groups.
struct Groups {
    std::vector<std::int32_t> of;  // group of each facet, kNone for those outside
    std::vector<double> area;

    [[nodiscard]] std::size_t count() const { return area.size(); }
};

using Neighbours = std::vector<std::array<std::int32_t, 3>>;

/// The group of a facet whose group is not known yet.
template <class Belongs>
void flood_group(const Neighbours& neighbours, const std::vector<double>& area, Belongs belongs,
                 std::size_t start, Groups& groups) {
    const auto group = static_cast<std::int32_t>(groups.area.size());
    groups.area.push_back(0);
    groups.of[start] = group;
    std::vector<std::size_t> left{start};
    while (!left.empty()) {
        const std::size_t facet = left.back();
        left.pop_back();
        groups.area.back() += area[facet];
        for (const std::int32_t other : neighbours[facet]) {
            const auto next = static_cast<std::size_t>(other);
            if (other >= 0 && belongs(next) && groups.of[next] == kNone) {
                groups.of[next] = group;
                left.push_back(next);
            }
        }
    }
}

template <class Belongs>
Groups groups_of(const Neighbours& neighbours, const std::vector<double>& area, Belongs belongs) {
    Groups groups;
    groups.of.assign(neighbours.size(), kNone);
    for (std::size_t start = 0; start < neighbours.size(); ++start) {
        if (belongs(start) && groups.of[start] == kNone) {
            flood_group(neighbours, area, belongs, start, groups);
        }
    }
    return groups;
}

class Surgeon {
  public:
    Surgeon(const TriMesh& mesh, std::vector<char> wanted)
        : mesh_(mesh),
          facets_(decomp::mesh::measure_facets(mesh)),
          neighbours_(decomp::mesh::neighbours(mesh)),
          keep_(std::move(wanted)) {
        drop_specks();
        for (int round = 0; round < kMostRounds && widen_at_pinches(); ++round) {
        }
        drop_specks();
        patches_ =
            groups_of(neighbours_, facets_.area_mm2, [&](std::size_t i) { return keep_[i] == 0; });
        fate_.assign(patches_.count(), Fate::Close);
        judge_borders();
    }

    [[nodiscard]] Result<Dropped> operate(const Run& run) {
        const std::size_t crossings_before =
            decomp::repair::self_intersections(mesh_, kCrossings).size();
        for (int round = 0; round < kMostRounds; ++round) {
            if (run.cancelled()) {
                return decomp::cancelled();
            }
            Dropped out = without_patches();
            const std::size_t kept = out.mesh.triangles.size();
            if (out.patches > 0 && !decomp::repair::fill_holes(out.mesh)) {
                break;
            }
            const auto crossings = decomp::repair::self_intersections(out.mesh, kCrossings);
            const bool sound = decomp::mesh::check_topology(out.mesh).manifold();
            if (sound && crossings.size() <= crossings_before) {
                out.volume_before_mm3 = decomp::mesh::volume_mm3(mesh_);
                out.volume_after_mm3 = decomp::mesh::volume_mm3(out.mesh);
                return out;
            }
            if (!leave_harmful(out.mesh, kept, crossings)) {
                break;
            }
        }
        return decomp::fail("check.drop_failed",
                            "the holes left by what cannot be reached could not be closed", {},
                            "choose another axis, or mend the part in a modeller");
    }

  private:
    enum class Fate { Close, Fill, Leave };

    void drop_specks() {
        const Groups shells =
            groups_of(neighbours_, facets_.area_mm2, [](std::size_t) { return true; });
        const Groups pieces =
            groups_of(neighbours_, facets_.area_mm2, [&](std::size_t i) { return keep_[i] != 0; });
        for (std::size_t i = 0; i < keep_.size(); ++i) {
            if (pieces.of[i] != kNone &&
                pieces.area[static_cast<std::size_t>(pieces.of[i])] <
                    kSpeck * shells.area[static_cast<std::size_t>(shells.of[i])]) {
                keep_[i] = 0;
            }
        }
    }

    /// Where a patch meets itself or another in a point its border is no loop: the facets around
    /// such points go too.
    bool widen_at_pinches() {
        std::vector<std::uint8_t> leaving(mesh_.points.size(), 0);  // border edges from each point
        for (std::size_t i = 0; i < keep_.size(); ++i) {
            for (std::size_t corner = 0; keep_[i] == 0 && corner < 3; ++corner) {
                const std::int32_t other = neighbours_[i][corner];
                if (other >= 0 && keep_[static_cast<std::size_t>(other)] != 0) {
                    std::uint8_t& count = leaving[mesh_.triangles[i][corner]];
                    count = std::min<std::uint8_t>(2, static_cast<std::uint8_t>(count + 1));
                }
            }
        }
        bool changed = false;
        for (std::size_t i = 0; i < keep_.size(); ++i) {
            const auto& t = mesh_.triangles[i];
            if (keep_[i] != 0 && (leaving[t[0]] > 1 || leaving[t[1]] > 1 || leaving[t[2]] > 1)) {
                keep_[i] = 0;
                changed = true;
            }
        }
        return changed;
    }

    /// A patch may go when its border is one simple loop; without a border it is a whole shell, and
    /// a cavity is filled.
    void judge_borders() {
        struct Border {
            std::vector<std::array<std::uint32_t, 2>> edges;
        };

        std::vector<Border> borders(patches_.count());
        std::vector<double> volume(patches_.count(), 0);
        for (std::size_t i = 0; i < keep_.size(); ++i) {
            if (patches_.of[i] == kNone) {
                continue;
            }
            const auto patch = static_cast<std::size_t>(patches_.of[i]);
            const auto& t = mesh_.triangles[i];
            volume[patch] += mesh_.points[t[0]].dot(mesh_.points[t[1]].cross(mesh_.points[t[2]]));
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::int32_t other = neighbours_[i][corner];
                if (other >= 0 && patches_.of[static_cast<std::size_t>(other)] != patches_.of[i]) {
                    borders[patch].edges.push_back({t[corner], t[(corner + 1) % 3]});
                }
            }
        }
        for (std::size_t patch = 0; patch < borders.size(); ++patch) {
            if (borders[patch].edges.empty()) {
                fate_[patch] = volume[patch] < 0 ? Fate::Fill : Fate::Leave;
            } else if (!is_one_loop(borders[patch].edges)) {
                fate_[patch] = Fate::Leave;
            }
        }
    }

    [[nodiscard]] static bool is_one_loop(std::vector<std::array<std::uint32_t, 2>> edges) {
        std::sort(edges.begin(), edges.end());
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
            if (edges[i][0] == edges[i + 1][0]) {
                return false;  // two loops touch
            }
        }
        std::size_t length = 0;
        std::uint32_t at = edges[0][0];
        do {
            const auto next =
                std::lower_bound(edges.begin(), edges.end(), std::array<std::uint32_t, 2>{at, 0});
            if (next == edges.end() || (*next)[0] != at) {
                return false;
            }
            at = (*next)[1];
            ++length;
        } while (at != edges[0][0] && length <= edges.size());
        return length == edges.size();
    }

    [[nodiscard]] bool goes(std::size_t facet) const {
        return patches_.of[facet] != kNone &&
               fate_[static_cast<std::size_t>(patches_.of[facet])] != Fate::Leave;
    }

    [[nodiscard]] Dropped without_patches() {
        Dropped out;
        std::vector<std::uint32_t> number(mesh_.points.size(),
                                          std::numeric_limits<std::uint32_t>::max());
        patch_of_point_.clear();
        for (std::size_t i = 0; i < keep_.size(); ++i) {
            if (goes(i)) {
                ++out.facets;
                out.area_mm2 += facets_.area_mm2[i];
                continue;
            }
            decomp::mesh::Triangle triangle{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                std::uint32_t& n = number[mesh_.triangles[i][corner]];
                if (n == std::numeric_limits<std::uint32_t>::max()) {
                    n = static_cast<std::uint32_t>(out.mesh.points.size());
                    out.mesh.points.push_back(mesh_.points[mesh_.triangles[i][corner]]);
                    patch_of_point_.push_back(kNone);
                }
                triangle[corner] = n;
            }
            out.mesh.triangles.push_back(triangle);
        }
        for (std::size_t i = 0; i < keep_.size(); ++i) {
            for (std::size_t corner = 0; goes(i) && corner < 3; ++corner) {
                const std::uint32_t n = number[mesh_.triangles[i][corner]];
                if (n != std::numeric_limits<std::uint32_t>::max()) {
                    patch_of_point_[n] = patches_.of[i];
                }
            }
        }
        for (std::size_t patch = 0; patch < fate_.size(); ++patch) {
            out.patches += fate_[patch] == Fate::Close ? 1 : 0;
            out.cavities += fate_[patch] == Fate::Fill ? 1 : 0;
            if (fate_[patch] == Fate::Leave) {
                ++out.patches_left;
                out.area_left_mm2 += patches_.area[patch];
            }
        }
        return out;
    }

    /// Leaves the patches whose new triangles cross something, or meet where they must not.
    bool leave_harmful(const TriMesh& closed, std::size_t kept,
                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& crossings) {
        bool changed = false;
        const auto leave_patch_of = [&](std::size_t triangle) {
            for (const std::uint32_t v : closed.triangles[triangle]) {
                if (v < patch_of_point_.size() && patch_of_point_[v] != kNone) {
                    Fate& fate = fate_[static_cast<std::size_t>(patch_of_point_[v])];
                    changed = changed || fate != Fate::Leave;
                    fate = Fate::Leave;
                }
            }
        };
        for (const auto& [first, second] : crossings) {
            for (const std::uint32_t triangle : {first, second}) {
                if (triangle >= kept) {
                    leave_patch_of(triangle);
                }
            }
        }
        if (!changed) {
            // Edges used twice: a new triangle repeats an edge that was there.
            const auto beyond = decomp::mesh::neighbours(closed);
            for (std::size_t i = 0; i < beyond.size(); ++i) {
                if (std::find(beyond[i].begin(), beyond[i].end(), kNone) != beyond[i].end()) {
                    leave_patch_of(i);
                }
            }
        }
        return changed;
    }

    const TriMesh& mesh_;
    decomp::mesh::Facets facets_;
    Neighbours neighbours_;
    std::vector<char> keep_;
    Groups patches_;
    std::vector<Fate> fate_;
    std::vector<std::int32_t> patch_of_point_;
};

}  // namespace

Result<Dropped> drop_unreachable(const TriMesh& mesh, const std::vector<char>& wanted,
                                 const Run& run) {
    return Surgeon(mesh, wanted).operate(run);
}

}  // namespace cam::check
