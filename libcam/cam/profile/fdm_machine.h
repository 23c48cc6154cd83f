// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/units.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace cam::profile {

/// A Cartesian filament printer and the process it runs by default. Read from
/// machine_profiles/fdm/NAME.toml.
struct FdmMachine {
    std::string name;     ///< the file's stem, e.g. "flashforge-creator-pro"
    std::string title;    ///< for people
    std::string dialect;  ///< machine_profiles/dialects/NAME.toml

    /// Where the nozzle may be, in the machine's own coordinates (bed frame).
    struct Chamber {
        Eigen::Vector3d min_mm = Eigen::Vector3d::Zero();
        Eigen::Vector3d max_mm = Eigen::Vector3d::Zero();
        double margin_mm = 0;  ///< kept free at each side in X and Y, and at the top
    } chamber;

    struct Nozzle {
        double diameter_mm = 0.4;
        double filament_diameter_mm = 1.75;
        double max_flow_mm3_per_s = 11;
    } nozzle;

    /// What the heaters can hold; a material that wants more is refused.
    struct Heaters {
        double max_nozzle_celsius = 250;
        double max_bed_celsius = 110;
    } heaters;

    /// Limits of the axes X, Y, Z, E and of the planner.
    struct Motion {
        Eigen::Vector4d max_speed_mm_per_s = Eigen::Vector4d::Zero();
        Eigen::Vector4d max_acceleration_mm_per_s2 = Eigen::Vector4d::Zero();
        Eigen::Vector4d jerk_mm_per_s = Eigen::Vector4d::Zero();
        double print_acceleration_mm_per_s2 = 1000;
        double travel_acceleration_mm_per_s2 = 1000;
    } motion;

    struct Retraction {
        double length_mm = 1;
        decomp::Speed speed = decomp::Speed::mm_per_s(30);
        double min_travel_mm = 2;   ///< shorter travels do not retract
        double lift_mm = 0;         ///< z-hop
        double max_inside_mm = 15;  ///< longer travels retract though they stay inside the part
        double wipe_mm = 0;         ///< way back along the bead while retracting
    } retraction;

    /// Text templates with {placeholders}; docs/profiles.md lists them. Part of the machine, not of
    /// the dialect.
    struct Templates {
        std::string start;  ///< before the first bead: homing, heating with waiting, priming
        std::string layer;  ///< after the travel to each new layer
        std::string end;    ///< after the last bead: heaters and motors off
    } templates;

    /// An optional external converter run on every finished program, e.g. gpx for .x3g.
    struct Converter {
        std::string program;    ///< empty: none
        std::string arguments;  ///< separated by spaces, with {in} and {out}
        std::string extension;  ///< "x3g"
    } converter;

    struct Process {
        double layer_height_mm = 0.2;
        double first_layer_height_mm = 0.25;
        double line_width_mm = 0.45;
        double first_layer_line_width_mm = 0.5;
        int perimeters = 3;
        int top_layers = 5;
        int bottom_layers = 4;
        double infill_density = 0.15;                             ///< 0..1
        decomp::Angle infill_angle = decomp::Angle::degrees(45);  ///< of the first sparse layer
        decomp::Angle support_angle =
            decomp::Angle::degrees(45);  ///< overhang from the horizontal that needs support below
        std::string infill_pattern = "grid";  ///< grid, rectilinear, gyroid, cubic, concentric
        double infill_anchor_mm = 20;  ///< longest way along the walls that links infill lines
        double interface_infill_density =
            0;                           ///< behind mating faces; lower than the other: the other
        double interface_infill_mm = 4;  ///< how far behind them
        std::string seam = "hidden";     ///< hidden, aligned, rear, nearest
        double elephant_foot_mm = 0.1;   ///< taken off the first layer's outline
        double outline_inset_mm = 0;     ///< taken off every layer's outer outline
        double hole_growth_mm = 0.05;    ///< added to the radius of round holes
        double mating_gap_mm = 0.1;      ///< between two parts; each face gives half of it
        double support_spacing_mm = 2.5;
        int support_interface_layers = 3;  ///< dense layers under the part
        double support_gap_z_layers = 1;   ///< free layers between support and part
        double support_gap_xy_mm = 0.6;
        double longest_bridge_mm = 12;  ///< longer ways over air sag and get support
        double brim_width_mm = 0;       ///< brim when > 0, else skirt
        int skirt_loops = 2;
        double skirt_distance_mm = 3;
        decomp::Speed outer_wall_speed = decomp::Speed::mm_per_s(30);
        decomp::Speed inner_wall_speed = decomp::Speed::mm_per_s(45);
        decomp::Speed infill_speed = decomp::Speed::mm_per_s(60);
        decomp::Speed solid_speed = decomp::Speed::mm_per_s(45);
        decomp::Speed bridge_speed = decomp::Speed::mm_per_s(25);
        decomp::Speed overhang_speed = decomp::Speed::mm_per_s(15);
        decomp::Speed support_speed = decomp::Speed::mm_per_s(45);
        decomp::Speed first_layer_speed = decomp::Speed::mm_per_s(20);
        decomp::Speed travel_speed = decomp::Speed::mm_per_s(120);
        double part_spacing_mm = 6;    ///< between parts on one plate, brim included
        std::string material = "pla";  ///< machine_profiles/materials/NAME.toml
    } process;
};

/// A filament. Read from machine_profiles/materials/NAME.toml.
struct Material {
    std::string name;
    std::string title;
    double density_g_per_cm3 = 1.24;
    double cost_per_kg = 0;  ///< in no particular currency; 0: unknown
    double nozzle_celsius = 210;
    double first_layer_nozzle_celsius = 215;
    double bed_celsius = 60;
    double max_flow_mm3_per_s = 11;
    double extrusion_multiplier = 1;
    double fan_fraction = 1;                                ///< 0..1, from fan_from_layer on
    double bridge_fan_fraction = 1;                         ///< over air, when above fan_fraction
    int fan_from_layer = 1;                                 ///< counted from 0
    double min_layer_time_s = 10;                           ///< slower moves below it
    decomp::Speed min_speed = decomp::Speed::mm_per_s(10);  ///< floor of that slow-down
};

/// What of a dialect differs from printer to printer. Read from
/// machine_profiles/dialects/NAME.toml; words only, no logic.
struct Dialect {
    std::string name;
    std::string title;
    bool relative_e = true;  ///< M83, else M82 with G92 E0 at each layer
    int xyz_decimals = 3;
    int e_decimals = 5;
    int feed_decimals = 0;
    std::string comment = ";";
    std::string fan_on;  ///< template with {fan_0_255} and {fan_fraction}; e.g. "M106 S{fan_0_255}"
                         ///< or "M126 T0"
    std::string fan_off;
    std::string set_nozzle;  ///< template with {celsius}
    std::string set_bed;     ///< template with {celsius}
    std::string
        reset_e;  ///< template that calls E zero at {x_mm} {y_mm} {z_mm}; used unless relative_e
    std::string progress;           ///< template with {percent} {minutes_left}; empty: none
    std::string dwell;              ///< template with {milliseconds}; empty: waits are left out
    std::string max_axes = "XYZE";  ///< axes that the dialect can speak of
    bool fan_is_on_off = false;     ///< no PWM: on when the fraction is at least 0.5
    std::vector<std::string> forbidden;  ///< words that must never be written, e.g. "M109"
};

}  // namespace cam::profile
