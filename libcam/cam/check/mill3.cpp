// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/mill3.h"

#include "cam/check/samples.h"
#include "cam/orient/candidates.h"
#include "cam/orient/overhang.h"
#include "decomp/mesh/moments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cam::check {

using decomp::Result;
using decomp::Run;
using decomp::mesh::Facets;
using decomp::part::Part;
using visibility::Facing;
using visibility::Sight;

namespace {

constexpr double kSameShare = 1e-6;      // percent: not worth a choice
constexpr double kSameDirection = 1e-3;  // radians
constexpr double kUndercut = 1e-6;       // cosine: facets that lean over less are walls
constexpr double kStrictDegrees = 1;     // a height field leans over by less

std::vector<Mill3Pose> candidates(const Part& part, Setups setups) {
    std::vector<Mill3Pose> poses;
    const auto add = [&](const Eigen::Vector3d& direction, int plane, bool flat) {
        const bool known = std::any_of(poses.begin(), poses.end(), [&](const Mill3Pose& pose) {
            const double same = pose.direction.dot(direction);
            return (setups == Setups::Two ? std::abs(same) : same) >
                   1 - kSameDirection * kSameDirection / 2;
        });
        if (!known) {
            Mill3Pose pose;
            pose.direction = direction;
            pose.plane = plane;
            pose.flat_base = flat;
            poses.push_back(pose);
        }
    };
    const auto stands = orient::stands(part, orient::Flats::Sought);
    const bool any_flat =
        std::any_of(stands.begin(), stands.end(), [](const auto& s) { return s.on_flat; });
    for (const orient::Stand& stand : stands) {
        if (stand.on_flat || !any_flat || setups == Setups::Two) {
            add(-stand.down, stand.plane, stand.on_flat);
        }
    }
    if (setups == Setups::Two) {
        const Eigen::Matrix3d principal = decomp::mesh::moments(part.mesh).axes;
        for (int axis = 0; axis < 3; ++axis) {
            add(Eigen::Vector3d::Unit(axis), -1, false);
        }
        for (int axis = 0; axis < 3; ++axis) {
            add(principal.col(axis).normalized(), -1, false);
        }
    }
    return poses;
}

/// Facets of the flat base: level, and in the plane of the part's lower end.
std::vector<char> base_of(const Part& part, const Facets& facets, const Mill3Pose& pose) {
    std::vector<char> base(facets.unit.size(), 0);
    if (!pose.flat_base) {
        return base;
    }
    const auto lie = orient::find_overhang(part.mesh, facets, -pose.direction, {}).lie;
    for (std::size_t i = 0; i < base.size(); ++i) {
        base[i] = lie[i] == orient::Lie::Plate ? 1 : 0;
    }
    return base;
}

double lowest_along(const Part& part, const Eigen::Vector3d& direction) {
    double low = std::numeric_limits<double>::infinity();
    for (const auto& t : part.mesh.triangles) {
        for (const auto v : t) {
            low = std::min(low, part.mesh.points[v].dot(direction));
        }
    }
    return low;
}

class Checker {
  public:
    Checker(const Part& part, const Sight& sight, const Mill3Options& options, const Run& run)
        : part_(part), sight_(sight), facets_(sight.facets()), options_(options), run_(run) {}

    [[nodiscard]] const Facets& facets() const { return facets_; }

    [[nodiscard]] bool both() const { return options_.setups == Setups::Two; }

    void measure(Mill3Pose& pose) const {
        const std::vector<char> base = base_of(part_, facets_, pose);
        const std::vector<char> seen = seen_in(pose);
        const double strict = std::sin(kStrictDegrees * std::numbers::pi / 180);
        const auto leans_over = [&](std::size_t i, double by) {
            const double up = facets_.unit[i].dot(pose.direction);
            return base[i] == 0 && (both() ? false : up < -by);
        };
        pose.base = share_of(facets_, [&](std::size_t i) { return base[i] != 0; });
        pose.undercut = share_of(facets_, [&](std::size_t i) { return leans_over(i, kUndercut); });
        pose.unseen =
            share_of(facets_, [&](std::size_t i) { return base[i] == 0 && seen[i] == 0; });
        pose.height_field =
            share_of(facets_, [&](std::size_t i) { return leans_over(i, strict); }).facets == 0;
    }

    [[nodiscard]] std::vector<char> seen_in(const Mill3Pose& pose) const {
        std::vector<Eigen::Vector3d> directions{pose.direction};
        if (both()) {
            directions.emplace_back(-pose.direction);
        }
        return sight_.seen_from_any(directions, Facing::Wall, run_);
    }

    /// Pieces of the surface that one tool reaches: by its cutter, and whole.
    [[nodiscard]] Result<Reach> reached(const Samples& samples, const Mill3Pose& pose,
                                        const tool::Tool& tool) const {
        const Facets& pieces = samples.pieces;
        if (!both()) {
            return tool_reach(part_.mesh, pieces, pose.direction, tool, options_.reach,
                              lowest_along(part_, pose.direction));
        }
        auto up = tool_reach(part_.mesh, pieces, pose.direction, tool, options_.reach);
        auto down = tool_reach(part_.mesh, pieces, -pose.direction, tool, options_.reach);
        if (!up || !down) {
            return up ? down : up;
        }
        for (std::size_t i = 0; i < up->tool.size(); ++i) {
            up->cutter[i] |= down->cutter[i];
            up->tool[i] |= down->tool[i];
        }
        return up;
    }

  private:
    const Part& part_;
    const Sight& sight_;
    const Facets& facets_;
    const Mill3Options& options_;
    const Run& run_;
};

/// The pose with the least value; flat bases before others.
template <class Value>
std::size_t least(const std::vector<Mill3Pose>& poses, Value value) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < poses.size(); ++i) {
        const double gain = value(poses[best]) - value(poses[i]);
        const bool flatter = poses[i].flat_base && !poses[best].flat_base;
        if (gain > kSameShare || (gain > -kSameShare && flatter)) {
            best = i;
        }
    }
    return best;
}

/// Adds what the tools reach in the best pose.
decomp::Status try_tools(const Checker& checker, const Part& part,
                         const std::vector<tool::Tool>& tools, const Run& run, Mill3Check& out) {
    if (tools.empty()) {
        return {};
    }
    const std::size_t count = part.mesh.triangles.size();
    const Samples samples =
        sample_facets(part.mesh, checker.facets(), {.spacing_mm = sample_spacing_mm(tools)});
    std::vector<char> together(samples.facet.size(), 0);
    for (const tool::Tool& tool : tools) {
        const auto reach = checker.reached(samples, out.poses[out.best], tool);
        if (!reach) {
            return decomp::fail(reach.error());
        }
        if (run.cancelled()) {
            return decomp::cancelled();
        }
        const auto missed = [&](const std::vector<char>& by) {
            return share_of(samples, count, [&](std::size_t i) {
                return out.facets.base[samples.facet[i]] == 0 && by[i] == 0;
            });
        };
        out.tools.push_back({tool.name, missed(reach->cutter), missed(reach->tool)});
        for (std::size_t i = 0; i < together.size(); ++i) {
            together[i] |= reach->tool[i];
        }
        out.unreached_together = missed(together);
        if (out.facets.reached.empty()) {
            out.facets.reached = mostly(samples, count, reach->tool);
        }
    }
    return {};
}

}  // namespace

Result<Mill3Check> check_mill3(const Part& part, const Mill3Options& options,
                               const std::vector<tool::Tool>& tools, const Run& run) {
    const Facets facets = decomp::mesh::measure_facets(part.mesh);
    const auto sight = Sight::of(part.mesh, facets);
    if (!sight) {
        return decomp::fail(sight.error());
    }
    const Checker checker(part, *sight, options, run);
    Mill3Check out;
    out.poses = candidates(part, options.setups);
    for (Mill3Pose& pose : out.poses) {
        checker.measure(pose);
    }
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    out.best = least(out.poses, [](const Mill3Pose& p) { return p.unseen.by_area_percent; });
    out.best_by_normal =
        least(out.poses, [](const Mill3Pose& p) { return p.undercut.by_area_percent; });
    const Mill3Pose& best = out.poses[out.best];
    out.facets.base = base_of(part, facets, best);
    out.facets.seen = checker.seen_in(best);
    out.unreached_together = best.unseen;
    if (const auto tried = try_tools(checker, part, tools, run, out); !tried) {
        return decomp::fail(tried.error());
    }
    return out;
}

}  // namespace cam::check
