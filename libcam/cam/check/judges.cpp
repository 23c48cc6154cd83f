// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/judges.h"

#include "cam/check/height_map.h"
#include "cam/check/mill4.h"
#include "cam/orient/choose_build.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/measure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cam::check {

using decomp::ModelFrame;
using decomp::PartBedFrame;
using decomp::Pose;
using decomp::part::Fidelity;
using decomp::part::Judge;
using decomp::part::Part;
using decomp::part::Plane;
using decomp::part::Verdict;
using decomp::part::Violation;

namespace {

constexpr double kExactlyFull = 1e-12;  // relative room for rounding
constexpr double kNoBaseRatio = 2;      // a missing base counts like something twice too large
constexpr double kTopShare = 0.95;      // of an undercut's area lies below its cut

/// What an Estimate can afford.
constexpr AxisOptions kCoarse{
    .angles = 40, .samples = 200, .directions = 256, .spread = 60, .refined = 4, .finalists = 1};

void add(std::vector<Violation>& out, const char* constraint, double extent, double limit) {
    const double ratio = limit > 0 ? extent / limit : std::numeric_limits<double>::infinity();
    if (ratio > 1 + kExactlyFull) {
        out.push_back({constraint, ratio});
    }
}

double widest(const std::vector<tool::Tool>& tools) {
    double out = 0;
    for (const tool::Tool& tool : tools) {
        out = std::max(out, tool.diameter_mm);
    }
    return out;
}

double longest(const std::vector<tool::Tool>& tools) {
    double out = 0;
    for (const tool::Tool& tool : tools) {
        out = std::max(out, tool.stickout_mm);
    }
    return out;
}

/// A pose on a plate with `up` upwards.
Pose<PartBedFrame, ModelFrame> lying(const Part& part, const Eigen::Matrix3d& turn) {
    Eigen::AlignedBox3d box;
    for (const auto& t : part.mesh.triangles) {
        for (const auto v : t) {
            box.extend(Eigen::Vector3d(turn * part.mesh.points[v]));
        }
    }
    Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
    map.linear() = turn;
    if (!box.isEmpty()) {
        map.translation() = Eigen::Vector3d(-box.center().x(), -box.center().y(), -box.min().z());
    }
    return Pose<PartBedFrame, ModelFrame>(map);
}

Eigen::Vector3d size_of(const Part& part, const Pose<PartBedFrame, ModelFrame>& pose) {
    return decomp::mesh::bounds(
               decomp::mesh::transformed(part.mesh, Eigen::Affine3d(pose.map().matrix())))
        .sizes();
}

/// Heights along a direction below which shares of some facets' area lie.
std::vector<double> heights(const decomp::mesh::Facets& facets, const Eigen::Vector3d& direction,
                            const std::vector<char>& good, const std::vector<double>& shares) {
    std::vector<std::pair<double, double>> bad;  // height, area
    double total = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
        if (good[i] == 0) {
            bad.emplace_back(facets.centre[i].dot(direction), facets.area_mm2[i]);
            total += facets.area_mm2[i];
        }
    }
    std::sort(bad.begin(), bad.end());
    std::vector<double> out;
    for (const double share : shares) {
        double sum = 0;
        for (const auto& [height, area] : bad) {
            sum += area;
            if (sum >= share * total) {
                out.push_back(height);
                break;
            }
        }
    }
    return out;
}

std::vector<Plane> planes_across(const Eigen::Vector3d& direction, const std::vector<double>& at) {
    std::vector<Plane> planes;
    planes.reserve(at.size());
    for (const double height : at) {
        planes.push_back({direction, height});
    }
    return planes;
}

Verdict mill3_verdict(const Part& part, Fidelity fidelity, const profile::MillSetup& setup,
                      Setups setups) {
    Verdict verdict;
    Mill3Options options;
    options.setups = setups;
    options.reach = reach_options(setup.machine);
    const bool exact = fidelity == Fidelity::Exact;
    const auto check =
        check_mill3(part, options, exact ? setup.tools : std::vector<tool::Tool>{}, {});
    if (!check) {
        verdict.violations.push_back({"reach", std::numeric_limits<double>::infinity()});
        return verdict;
    }
    const Mill3Pose& best = check->poses[check->best];
    verdict.best_pose = lying(part, frame_looking_down(best.direction));
    verdict.violations = mill_misfits(setup.machine, setup.tools, size_of(part, verdict.best_pose));
    if (setups == Setups::One && !best.flat_base) {
        verdict.violations.push_back({"base", kNoBaseRatio});
    }
    const double left = check->unreached_together.by_area_percent;
    add(verdict.violations, "reach", left, setup.machine.reach.max_unreached_percent);
    const auto& facets = check->facets;
    std::vector<char> good = facets.reached.empty() ? facets.seen : facets.reached;
    for (std::size_t i = 0; i < good.size(); ++i) {
        good[i] |= facets.base[i];
    }
    if (left > setup.machine.reach.max_unreached_percent) {
        verdict.cuts_that_help =
            planes_across(best.direction, heights(decomp::mesh::measure_facets(part.mesh),
                                                  best.direction, good, {kTopShare, 0.5}));
    }
    return verdict;
}

Verdict mill4_verdict(const Part& part, Fidelity fidelity, const profile::MillSetup& setup) {
    Verdict verdict;
    Mill4Options options;
    options.angles = setup.machine.reach.angles;
    options.a_sign = setup.machine.rotary.a_sign;
    options.reach = reach_options(setup.machine);
    options.find_indices = false;
    const bool exact = fidelity == Fidelity::Exact;
    if (!exact) {
        options.search = kCoarse;
    }
    const auto check =
        check_mill4(part, options, exact ? setup.tools : std::vector<tool::Tool>{}, {});
    if (!check) {
        verdict.violations.push_back({"reach", std::numeric_limits<double>::infinity()});
        return verdict;
    }
    verdict.best_pose = lying(part, check->setup_from_model.map().linear());
    verdict.violations =
        rotary_misfits(setup.machine, setup.tools, check->stock.radius_mm, check->stock.length_mm);
    const double left = check->unreached_together.by_area_percent;
    add(verdict.violations, "reach", left, setup.machine.reach.max_unreached_percent);
    if (left > setup.machine.reach.max_unreached_percent) {
        const auto& facets = check->facets;
        std::vector<char> good = facets.reached.empty() ? facets.seen : facets.reached;
        for (std::size_t i = 0; i < good.size(); ++i) {
            good[i] |= facets.end[i];
        }
        const Eigen::Vector3d& axis = check->stock.axis;
        verdict.cuts_that_help = planes_across(
            axis, heights(decomp::mesh::measure_facets(part.mesh), axis, good, {0.5}));
    }
    return verdict;
}

}  // namespace

std::vector<Violation> mill_misfits(const profile::MillMachine& machine,
                                    const std::vector<tool::Tool>& tools,
                                    const Eigen::Vector3d& size_mm) {
    const auto& travel = machine.travel;
    const Eigen::Vector3d room = travel.max_mm - travel.min_mm;
    const double beside = 2 * travel.margin_mm;
    std::vector<Violation> out;
    add(out, "travel.x", size_mm.x() + widest(tools), room.x() - beside);
    add(out, "travel.y", size_mm.y() + widest(tools), room.y() - beside);
    add(out, "travel.z", size_mm.z(), room.z() - travel.margin_mm);
    add(out, "spindle", size_mm.z() + longest(tools), travel.nose_to_table_mm - travel.margin_mm);
    return out;
}

std::vector<Violation> rotary_misfits(const profile::MillMachine& machine,
                                      const std::vector<tool::Tool>& tools, double radius_mm,
                                      double length_mm) {
    std::vector<Violation> out;
    if (!machine.has_rotary()) {
        out.push_back({"rotary", std::numeric_limits<double>::infinity()});
        return out;
    }
    add(out, "rotary.diameter", 2 * radius_mm, machine.rotary.max_diameter_mm);
    add(out, "rotary.length", length_mm, machine.rotary.max_length_mm);
    add(out, "spindle", radius_mm + longest(tools),
        machine.rotary.nose_to_axis_mm - machine.travel.margin_mm);
    return out;
}

Judge support_judge(const profile::FdmSetup& setup, double max_support_percent) {
    return [judge = orient::fdm_judge(setup), max_support_percent](const Part& part,
                                                                   Fidelity fidelity) {
        Verdict verdict = judge(part, fidelity);
        const double area = decomp::mesh::area_mm2(part.mesh);
        if (area > 0) {
            const double percent = 100 * verdict.support_area_mm2 / area;
            add(verdict.violations, "support", percent, max_support_percent);
        }
        return verdict;
    };
}

Judge mill3_judge(const profile::MillSetup& setup, Setups setups) {
    return [setup, setups](const Part& part, Fidelity fidelity) {
        return mill3_verdict(part, fidelity, setup, setups);
    };
}

Judge mill4_judge(const profile::MillSetup& setup) {
    return [setup](const Part& part, Fidelity fidelity) {
        return mill4_verdict(part, fidelity, setup);
    };
}

}  // namespace cam::check
