// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/feeds/feeds.h"

#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cam::feeds {

namespace {

using decomp::Speed;
using profile::MillMachine;
using profile::MillMaterial;
using tool::Shape;
using tool::Tool;

constexpr double kDriveEfficiency = 0.8;
/// Speeds nearer than this ratio are one.
constexpr double kSame = 1 + 1e-9;
/// Depth of a finishing cut over the diameter, at which the speed of a ball is reckoned.
constexpr double kFinishDepth = 0.1;

bool is_round_tipped(const Tool& tool) {
    return tool.shape == Shape::Ball || tool.shape == Shape::TaperedBall;
}

/// The diameter that bears the load: of the tip, for a taper.
double cutting_diameter_mm(const Tool& tool) {
    return tool.shape == Shape::TaperedBall ? tool.tip_diameter_mm : tool.diameter_mm;
}

struct Turning {
    double rpm = 0;
    double feed_mm_per_min = 0;
};

/// How a tool meets the material in one kind of cut.
struct Bite {
    const char* what = "";  ///< the kind, for notes
    double diameter_mm = 0;
    double chip_mm = 0;
    double thinning = 1;  ///< the feed is this much faster for the same chip
};

/// Speed and feed of a cut, clamped by the machine.
Turning turning(const Bite& bite, int flutes, const MillMaterial& material,
                const MillMachine& machine, std::vector<std::string>& notes) {
    const std::string what = bite.what;
    const double wished_rpm =
        1000 * material.surface_speed_m_per_min / (std::numbers::pi * bite.diameter_mm);
    Turning out;
    out.rpm = std::clamp(wished_rpm, machine.spindle.min_rpm, machine.spindle.max_rpm);
    if (wished_rpm < machine.spindle.min_rpm) {
        notes.push_back(what + ": the spindle's slowest speed, " +
                        decomp::decimal(machine.spindle.min_rpm, 0) +
                        "/min, is faster than the material wants");
    }
    const double teeth = flutes;
    const double top = machine.axes.max_feed_mm_per_min.head<2>().minCoeff();
    out.feed_mm_per_min = out.rpm * teeth * bite.chip_mm * bite.thinning;
    if (out.feed_mm_per_min > top) {
        out.feed_mm_per_min = top;
        notes.push_back(what + ": feed clamped to the axes' " + decomp::decimal(top, 0) +
                        " mm/min");
    }
    const double least_chip_mm = std::min(material.min_chip_mm, bite.chip_mm) * bite.thinning;
    const double slow = out.feed_mm_per_min / (teeth * least_chip_mm);
    if (out.rpm > slow * kSame) {
        out.rpm = std::max(slow, machine.spindle.min_rpm);
        notes.push_back(what + ": the spindle slows to " + decomp::decimal(out.rpm, 0) +
                        "/min so that chips are cut, not rubbed");
    }
    out.rpm = std::max(std::floor(out.rpm), machine.spindle.min_rpm);
    return out;
}

path::CutValues values_of(const Turning& turning, const MillMaterial& material,
                          const MillMachine& machine) {
    const auto speed = [](double mm_per_min) { return Speed::mm_per_s(mm_per_min / 60); };
    const double max_z = machine.axes.max_feed_mm_per_min.z();
    path::CutValues out;
    out.spindle_rpm = turning.rpm;
    out.feed = speed(turning.feed_mm_per_min);
    out.ramp = speed(std::min(turning.feed_mm_per_min * material.ramp_factor, max_z));
    out.plunge = speed(std::min(turning.feed_mm_per_min * material.plunge_factor, max_z));
    return out;
}

/// Takes depth back until the spindle can drive the cut; returns the power it then needs.
double fit_power(path::CutValues& cut, const MillMaterial& material, const MillMachine& machine,
                 std::vector<std::string>& notes, const char* what) {
    double needed = power_w(material, cut.step_down_mm, cut.step_over_mm, cut.feed);
    const double rated = machine.spindle.power_w;
    if (rated > 0 && needed > rated) {
        cut.step_down_mm *= rated / needed;
        notes.push_back(std::string(what) + ": " + decomp::decimal(needed, 0) +
                        " W wanted, the spindle gives " + decomp::decimal(rated, 0) +
                        ": depth taken back to " + decomp::decimal(cut.step_down_mm, 2) + " mm");
        needed = rated;
    }
    return needed;
}

}  // namespace

double chip_thinning(double diameter_mm, double width_mm) {
    if (!(width_mm > 0) || width_mm >= diameter_mm / 2) {
        return 1;
    }
    return diameter_mm / (2 * std::sqrt(diameter_mm * width_mm - width_mm * width_mm));
}

double effective_diameter_mm(const Tool& tool, double depth_mm) {
    if (is_round_tipped(tool)) {
        const double r = cutting_diameter_mm(tool) / 2;
        if (depth_mm < r) {
            return 2 * std::sqrt(depth_mm * (2 * r - depth_mm));
        }
        return 2 * r;
    }
    if (tool.shape == Shape::V) {
        return std::min(tool.diameter_mm,
                        tool.tip_diameter_mm + 2 * depth_mm * std::tan(tool.point.radians() / 2));
    }
    return tool.diameter_mm;
}

double power_w(const MillMaterial& material, double step_down_mm, double step_over_mm, Speed feed) {
    const double chips_mm3_per_s = step_down_mm * step_over_mm * feed.mm_per_s();
    return material.power_w_s_per_mm3 * chips_mm3_per_s / kDriveEfficiency;
}

Feeds feeds_for(const Tool& tool, const MillMaterial& material, const MillMachine& machine) {
    Feeds out;
    const double d = cutting_diameter_mm(tool);
    const double chip_mm = material.chip_load * d;
    const double depth_mm = std::min(material.step_down * d, tool.flute_mm);
    const double width_mm = material.step_over * d;
    const auto cut = [&](double diameter_mm, double thinning, const char* what) {
        return turning({what, diameter_mm, chip_mm, thinning}, tool.flutes, material, machine,
                       out.notes);
    };
    const auto values = [&](const Turning& turning, double down_mm, double over_mm) {
        path::CutValues cut_values = values_of(turning, material, machine);
        cut_values.step_down_mm = down_mm;
        cut_values.step_over_mm = over_mm;
        return cut_values;
    };
    if (tool.shape != Shape::Drill && tool.shape != Shape::V) {
        out.values.rough = values(cut(d, chip_thinning(d, width_mm), "rough"), depth_mm, width_mm);
        out.values.slot = values(cut(d, 1, "slot"), depth_mm * material.slot_factor, d);
        out.rough_power_w =
            std::max(fit_power(out.values.rough, material, machine, out.notes, "rough"),
                     fit_power(out.values.slot, material, machine, out.notes, "slot"));
    }
    if (tool.shape != Shape::Drill) {
        const double at_mm = std::max(effective_diameter_mm(tool, kFinishDepth * d), 0.05);
        out.values.finish =
            values(cut(at_mm, 1, "finish"), std::min(material.finish_step_down * d, tool.flute_mm),
                   width_mm);
    }
    if (tool.shape != Shape::V) {
        out.values.drill = values(cut(d, 1, "drill"), material.peck * d, d);
        out.values.drill.feed = out.values.drill.plunge;
    }
    return out;
}

}  // namespace cam::feeds
