// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/candidates.h"

#include "decomp/mesh/flats.h"
#include "decomp/sections/profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace decomp::pipeline {

namespace {

constexpr int kStations = 96;
constexpr double kSameDirection = 0.9998;  // cosine of about 1 degree
constexpr double kAxis = 1 - 1e-9;
constexpr double kLargeFlat = 0.05;  // of the surface: cuts along it look meant
constexpr double kAlike = 0.012;  // of the length: planes of one direction closer than this are one
constexpr double kEnds = 0.02;    // of the length: no plane closer to an end
constexpr double kRelaxedNeck = 0.2;  // strength from which a neck's plane is relaxed
constexpr std::size_t kRelaxed = 4;   // necks relaxed at most
constexpr std::size_t kEventsPerDirection = 10;
constexpr double kMaxTilt = 0.45;       // radians
constexpr double kMaxShift = 0.06;      // of the length
constexpr double kJumpStandOff = 6e-5;  // of the length, to the slimmer side of a jump

std::vector<Eigen::Vector3d> all_directions(const part::Part& part, const part::Verdict& verdict) {
    std::vector<Eigen::Vector3d> out = sections::directions(part.mesh);
    for (const part::Plane& plane : verdict.cuts_that_help) {
        const Eigen::Vector3d direction = plane.normal.normalized();
        if (std::none_of(out.begin(), out.end(), [&](const Eigen::Vector3d& other) {
                return std::abs(other.dot(direction)) > kSameDirection;
            })) {
            out.push_back(direction);
        }
    }
    return out;
}

/// The plane at an event. At a jump it stands just on the slimmer side, so that the wide piece
/// keeps the whole step.
double offset_at(const sections::Profile& profile, const sections::Event& event) {
    if (event.kind == sections::EventKind::Neck) {
        return event.t_mm;
    }
    const double step = kJumpStandOff * (profile.high_mm() - profile.low_mm());
    const bool slimmer_below =
        profile.at(event.t_mm - step).area_mm2 < profile.at(event.t_mm + step).area_mm2;
    return event.t_mm + (slimmer_below ? -step : step);
}

struct Neck {
    double strength;
    part::Plane plane;
    double length;
};

/// A direction, its number, and whether a person would think of it.
struct Direction {
    Eigen::Vector3d unit;
    int index;
    bool natural;
};

void add_direction(const part::Part& part, const Direction& direction, int offsets,
                   std::vector<Candidate>& out, std::vector<Neck>& necks) {
    const sections::Profile profile(part.mesh, direction.unit, kStations);
    const double low = profile.low_mm();
    const double length = profile.high_mm() - low;
    const std::size_t first = out.size();
    const auto add = [&](double offset, double strength) {
        const bool known =
            std::any_of(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                        [&](const Candidate& other) {
                            return std::abs(other.plane.offset_mm - offset) < kAlike * length;
                        });
        if (known) {
            return;
        }
        if (offset > low + kEnds * length && offset < low + (1 - kEnds) * length) {
            out.push_back(
                {{direction.unit, offset}, direction.index, direction.natural, false, strength});
        }
    };
    std::vector<sections::Event> events = profile.events();
    std::stable_sort(
        events.begin(), events.end(),
        [](const sections::Event& a, const sections::Event& b) { return a.strength > b.strength; });
    events.resize(std::min(events.size(), kEventsPerDirection));
    for (const sections::Event& event : events) {
        add(offset_at(profile, event), event.strength);
        if (event.kind == sections::EventKind::Neck && event.strength >= kRelaxedNeck) {
            necks.push_back({event.strength, {direction.unit, event.t_mm}, length});
        }
    }
    for (int i = 1; i <= offsets; ++i) {
        add(low + length * i / (offsets + 1), 0);
    }
}

bool is_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::abs(a.dot(b)) > kSameDirection;
}

}  // namespace

std::vector<Candidate> candidates(const part::Part& part, const part::Verdict& verdict, int offsets,
                                  const std::vector<part::Plane>& known,
                                  const std::vector<part::Plane>& mapped) {
    std::vector<Candidate> out;
    std::vector<Neck> necks;
    const std::vector<mesh::Flat> flats = mesh::large_flats(part.mesh, {.min_share = kLargeFlat});
    const auto natural = [&](const Eigen::Vector3d& unit) {
        return unit.cwiseAbs().maxCoeff() > kAxis ||
               std::any_of(flats.begin(), flats.end(),
                           [&](const mesh::Flat& flat) { return is_parallel(flat.normal, unit); });
    };
    int index = 0;
    out.reserve(known.size() + mapped.size() + verdict.cuts_that_help.size());
    for (const part::Plane& plane : known) {
        out.push_back({plane, index++, true, true, 0});
    }
    for (const Eigen::Vector3d& unit : all_directions(part, verdict)) {
        add_direction(part, {unit, index++, natural(unit)}, offsets, out, necks);
    }
    for (const part::Plane& plane : verdict.cuts_that_help) {
        out.push_back({plane, index, natural(plane.normal.normalized()), false, 0});
    }
    ++index;
    for (const part::Plane& plane : mapped) {
        out.push_back({plane, index++, natural(plane.normal), false, 0});
    }
    std::stable_sort(necks.begin(), necks.end(),
                     [](const Neck& a, const Neck& b) { return a.strength > b.strength; });
    necks.resize(std::min(necks.size(), kRelaxed));
    for (const Neck& neck : necks) {
        const part::Plane plane = sections::refined_neck(
            part.mesh, neck.plane,
            {.max_tilt = kMaxTilt, .max_shift_mm = kMaxShift * neck.length, .rounds = 7});
        out.push_back({plane, index++, false, false, neck.strength});
    }
    return out;
}

}  // namespace decomp::pipeline
