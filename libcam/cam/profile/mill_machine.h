// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/tool/tool.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace cam::profile {

/// A mill with three linear axes, with or without a rotary axis A along X. Read from
/// machine_profiles/mill/NAME.toml.
struct MillMachine {
    std::string name;                    ///< the file's stem
    std::string title;                   ///< for people
    std::vector<std::string> tools;      ///< machine_profiles/tools/NAME.toml, in the order of use
    std::string dialect = "linuxcnc";    ///< machine_profiles/dialects/NAME.toml
    std::vector<std::string> sources{};  ///< "key: where its value was read"

    /// Where the spindle's nose may be.
    struct Travel {
        Eigen::Vector3d min_mm = Eigen::Vector3d::Zero();
        Eigen::Vector3d max_mm = Eigen::Vector3d::Zero();
        double nose_to_table_mm = 0;  ///< spindle nose at the top of its travel, down to the table
        double margin_mm = 0;         ///< kept free at each side in X and Y, and at the top
    } travel;

    /// The rotary axis; absent while max_diameter_mm is 0.
    struct Rotary {
        double max_diameter_mm = 0;  ///< what can turn without touching table or frame
        double max_length_mm = 0;    ///< between chuck and tailstock
        double nose_to_axis_mm = 0;  ///< spindle nose at the top of its travel, down to the axis
        int a_sign = 1;              ///< +1: LinuxCNC, ISO 841; see docs/frames.md
    } rotary;

    struct Spindle {
        double min_rpm = 0;
        double max_rpm = 24000;
        double power_w = 0;    ///< at the cutter; 0: unknown, cuts are not checked against it
        double spin_up_s = 4;  ///< from standstill to speed
    } spindle;

    /// What the axes X, Y, Z can do.
    struct Axes {
        Eigen::Vector3d max_feed_mm_per_min{3000, 3000, 1000};
        Eigen::Vector3d acceleration_mm_per_s2{100, 100, 50};
    } axes;

    /// How reach is judged.
    struct Reach {
        double tolerance_mm = 0.1;         ///< rest along the normal that counts as reached
        double cell_mm = 0.1;              ///< of the height maps
        double shank_clearance_mm = 0.1;   ///< kept between shank and part
        double holder_clearance_mm = 1;    ///< kept between holder and part
        double max_unreached_percent = 1;  ///< of a part's area, for a part that can be made
        int angles = 40;                   ///< of A that are tried, evenly over a turn
    } reach;

    [[nodiscard]] bool has_rotary() const { return rotary.max_diameter_mm > 0; }
};

/// What controllers of mills want to read. Read from machine_profiles/dialects/NAME.toml, section
/// [milling]; words only, no logic. Templates know {tool}, {rpm}, {seconds}, {milliseconds} and
/// {safe_z_mm}.
struct MillDialect {
    std::string name;
    std::string title;
    std::string axes = "XYZ";  ///< that the dialect can speak of
    std::string comment_open = "(";
    std::string comment_close = ")";
    int decimals = 3;  ///< of X, Y, Z, I, J
    int feed_decimals = 1;
    int line_limit = 70;  ///< characters of a line, its end not counted
    bool arcs = true;     ///< G2 and G3 in the XY plane
    bool helices = true;  ///< arcs that change Z
    double min_arc_radius_mm = 0.5;
    double max_arc_radius_mm = 1000;
    bool rapid_feed = false;  ///< G0 moves at F: each names it
    std::string start;        ///< before the first tool
    std::string take_tool;    ///< template; the spindle stands still
    std::string tool_length;  ///< template after it; empty: the operator touches off
    std::string spindle_on = "M3 S{rpm}";
    std::string spindle_off = "M5";
    std::string dwell = "G4 P{seconds}";
    std::string mist;  ///< empty: left out
    std::string flood;
    std::string coolant_off;
    std::string end;                     ///< after the last move
    std::vector<std::string> forbidden;  ///< words that must never be written
    std::vector<std::string> sources;
};

/// What is milled. Read from machine_profiles/materials/NAME.toml, section [milling]. For carbide.
struct MillMaterial {
    std::string name;
    std::string title;
    double surface_speed_m_per_min = 200;  ///< of the teeth
    double chip_load = 0.01;               ///< mm a tooth for each mm of diameter
    double min_chip_mm = 0.005;            ///< thinner chips rub instead of being cut
    double step_down = 0.5;                ///< of the diameter
    double step_over = 0.4;                ///< of the diameter, beside what is cut already
    double finish_step_down = 0.5;         ///< of the diameter
    double slot_factor = 0.5;              ///< on step_down, in a full slot
    double plunge_factor = 0.33;           ///< on the feed, straight down
    double ramp_factor = 0.5;              ///< on the feed, down a ramp
    double peck = 1;                       ///< of the diameter, when drilling
    double power_w_s_per_mm3 = 0.75;       ///< for each mm^3/s of chips
    std::string coolant = "off";           ///< off, mist or flood
    std::vector<std::string> sources;      ///< "key: where, licence"
};

}  // namespace cam::profile
