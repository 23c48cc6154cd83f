// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/fields.h"

#include "cam/profile/field_table_detail.h"
#include "decomp/base/number.h"

namespace cam::profile {

using decomp::Angle;
using decomp::Speed;

namespace {

const Table<FdmMachine>& machine_rows() {
    using M = FdmMachine;
    static const Table<M> rows = {
        {"title", &M::title, "", 0, 0, kRequired, "name for people"},
        {"dialect", &M::dialect, "", 0, 0, kRequired,
         "which file of dialects/ its firmware speaks"},
    };
    return rows;
}

const Table<FdmMachine::Chamber>& chamber_rows() {
    using C = FdmMachine::Chamber;
    static const Table<C> rows = {
        {"min_mm", &C::min_mm, "mm", -2000, 2000, kRequired,
         "lowest X, Y, Z that the nozzle may reach, machine coordinates"},
        {"max_mm", &C::max_mm, "mm", -2000, 2000, kRequired,
         "highest X, Y, Z that the nozzle may reach"},
        {"margin_mm", &C::margin_mm, "mm", 0, 50, kOptional,
         "kept free at each side in X and Y, and at the top"},
    };
    return rows;
}

const Table<FdmMachine::Nozzle>& nozzle_rows() {
    using N = FdmMachine::Nozzle;
    static const Table<N> rows = {
        {"diameter_mm", &N::diameter_mm, "mm", 0.1, 2, kRequired, "bore of the nozzle"},
        {"filament_diameter_mm", &N::filament_diameter_mm, "mm", 1, 4, kRequired, "1.75 or 2.85"},
        {"max_flow_mm3_per_s", &N::max_flow_mm3_per_s, "mm^3/s", 0.5, 200, kRequired,
         "plastic that the hot end can melt; beads that would need more are printed slower"},
    };
    return rows;
}

const Table<FdmMachine::Heaters>& heaters_rows() {
    using H = FdmMachine::Heaters;
    static const Table<H> rows = {
        {"max_nozzle_celsius", &H::max_nozzle_celsius, "degrees C", 100, 500, kRequired,
         "a material that wants more is refused"},
        {"max_bed_celsius", &H::max_bed_celsius, "degrees C", 0, 200, kRequired,
         "0: the bed is not heated"},
    };
    return rows;
}

const Table<FdmMachine::Motion>& motion_rows() {
    using M = FdmMachine::Motion;
    static const Table<M> rows = {
        {"max_speed_mm_per_s", &M::max_speed_mm_per_s, "mm/s", 0.1, 2000, kRequired,
         "of the axes X, Y, Z, E"},
        {"max_acceleration_mm_per_s2", &M::max_acceleration_mm_per_s2, "mm/s^2", 1, 50000,
         kRequired, "of the axes X, Y, Z, E"},
        {"jerk_mm_per_s", &M::jerk_mm_per_s, "mm/s", 0, 200, kRequired,
         "step in speed that the axes X, Y, Z, E take at a corner without slowing down"},
        {"print_acceleration_mm_per_s2", &M::print_acceleration_mm_per_s2, "mm/s^2", 1, 50000,
         kRequired, "along the path while extruding"},
        {"travel_acceleration_mm_per_s2", &M::travel_acceleration_mm_per_s2, "mm/s^2", 1, 50000,
         kRequired, "along the path while travelling"},
    };
    return rows;
}

const Table<FdmMachine::Retraction>& retraction_rows() {
    using R = FdmMachine::Retraction;
    static const Table<R> rows = {
        {"length_mm", &R::length_mm, "mm", 0, 20, kRequired,
         "filament pulled back before a travel; 0: never"},
        {"speed_mm_per_s", &R::speed, "mm/s", 1, 200, kRequired, "of the filament, back and forth"},
        {"min_travel_mm", &R::min_travel_mm, "mm", 0, 100, kOptional,
         "shorter travels do not retract"},
        {"lift_mm", &R::lift_mm, "mm", 0, 10, kOptional,
         "the nozzle is raised by this during a retracted travel that leaves the part"},
        {"max_inside_mm", &R::max_inside_mm, "mm", 0, 1000, kOptional,
         "longer travels retract even where they stay inside the part"},
        {"wipe_mm", &R::wipe_mm, "mm", 0, 10, kOptional,
         "the nozzle goes that far back along the bead while it retracts; 0: it stands"},
    };
    return rows;
}

const Table<FdmMachine::Templates>& template_rows() {
    using T = FdmMachine::Templates;
    static const Table<T> rows = {
        {"start", &T::start, "", 0, 0, kRequired,
         "before the first bead: homing, heating with waiting, priming"},
        {"layer", &T::layer, "", 0, 0, kOptional, "at the beginning of each layer"},
        {"end", &T::end, "", 0, 0, kRequired, "after the last bead: heaters and motors off"},
    };
    return rows;
}

const Table<FdmMachine::Converter>& converter_rows() {
    using C = FdmMachine::Converter;
    static const Table<C> rows = {
        {"program", &C::program, "", 0, 0, kOptional,
         "external converter run on every finished program; empty: none"},
        {"arguments", &C::arguments, "", 0, 0, kOptional,
         "separated by spaces, with {in} and {out}"},
        {"extension", &C::extension, "", 0, 0, kOptional, "of the converted file, without the dot"},
    };
    return rows;
}

const Table<FdmMachine::Process>& layer_rows() {
    using P = FdmMachine::Process;
    static const Table<P> rows = {
        {"layer_height_mm", &P::layer_height_mm, "mm", 0.02, 1.5, kOptional,
         "of all layers but the first"},
        {"first_layer_height_mm", &P::first_layer_height_mm, "mm", 0.02, 1.5, kOptional,
         "of the first layer"},
        {"line_width_mm", &P::line_width_mm, "mm", 0.1, 3, kOptional,
         "of a bead; its cross-section is a stadium"},
        {"first_layer_line_width_mm", &P::first_layer_line_width_mm, "mm", 0.1, 3, kOptional,
         "of a bead of the first layer"},
        {"perimeters", &P::perimeters, "", 1, 50, kOptional, "walls"},
        {"top_layers", &P::top_layers, "", 0, 1000, kOptional,
         "solid layers under each upward surface"},
        {"bottom_layers", &P::bottom_layers, "", 0, 1000, kOptional,
         "solid layers over each downward surface"},
    };
    return rows;
}

const Table<FdmMachine::Process>& infill_rows() {
    using P = FdmMachine::Process;
    static const Table<P> rows = {
        {"infill_density", &P::infill_density, "", 0, 1, kOptional,
         "share of the inside that is filled, 0 .. 1"},
        {"infill_angle_deg", &P::infill_angle, "degrees", -360, 360, kOptional,
         "of the first sparse layer, from X"},
        {"infill_pattern", &P::infill_pattern, "", 0, 0, kOptional,
         "grid, rectilinear, gyroid, cubic or concentric"},
        {"infill_anchor_mm", &P::infill_anchor_mm, "mm", 0, 1000, kOptional,
         "ends of infill lines are linked along the walls over at most this"},
        {"interface_infill_density", &P::interface_infill_density, "", 0, 1, kOptional,
         "share of the inside that is filled behind mating faces; 0: as elsewhere"},
        {"interface_infill_mm", &P::interface_infill_mm, "mm", 0, 100, kOptional,
         "how far behind mating faces that infill reaches"},
    };
    return rows;
}

const Table<FdmMachine::Process>& outline_rows() {
    using P = FdmMachine::Process;
    static const Table<P> rows = {
        {"seam", &P::seam, "", 0, 0, kOptional,
         "where outer walls begin: hidden (on mating faces, then in concave corners, above each "
         "other), aligned, rear or nearest"},
        {"elephant_foot_mm", &P::elephant_foot_mm, "mm", 0, 1, kOptional,
         "taken off the outline of the first layer, which the bed squeezes out"},
        {"outline_inset_mm", &P::outline_inset_mm, "mm", -1, 1, kOptional,
         "taken off the outer outline of every layer"},
        {"hole_growth_mm", &P::hole_growth_mm, "mm", -1, 1, kOptional,
         "added to the radius of upright round holes, which print too narrow"},
        {"mating_gap_mm", &P::mating_gap_mm, "mm", 0, 2, kOptional,
         "left between two parts at an upright cut; each gives half of it. A horizontal cut gets "
         "none: "
         "the part ends with a whole layer, at most half a layer off"},
    };
    return rows;
}

const Table<FdmMachine::Process>& support_rows() {
    using P = FdmMachine::Process;
    static const Table<P> rows = {
        {"support_angle_deg", &P::support_angle, "degrees", 0, 90, kOptional,
         "downward surfaces flatter than this, measured from the horizontal, get support; 0: "
         "never"},
        {"support_spacing_mm", &P::support_spacing_mm, "mm", 0.5, 20, kOptional,
         "between the lines of a support"},
        {"support_interface_layers", &P::support_interface_layers, "layers", 0, 50, kOptional,
         "dense ones at the top of a support"},
        {"support_gap_z_layers", &P::support_gap_z_layers, "layers", 0, 10, kOptional,
         "left free between support and part"},
        {"support_gap_xy_mm", &P::support_gap_xy_mm, "mm", 0, 10, kOptional,
         "left free between support and walls"},
        {"longest_bridge_mm", &P::longest_bridge_mm, "mm", 0, 200, kOptional,
         "longer ways over air sag and get support"},
    };
    return rows;
}

const Table<FdmMachine::Process>& adhesion_rows() {
    using P = FdmMachine::Process;
    static const Table<P> rows = {
        {"brim_width_mm", &P::brim_width_mm, "mm", 0, 50, kOptional,
         "brim around the first layer of each part against warping, 5 is usual; 0: a skirt "
         "instead"},
        {"skirt_loops", &P::skirt_loops, "", 0, 20, kOptional,
         "around all parts of a plate, to prime the nozzle"},
        {"skirt_distance_mm", &P::skirt_distance_mm, "mm", 0, 50, kOptional,
         "between parts and skirt"},
    };
    return rows;
}

const Table<FdmMachine::Process>& speed_rows() {
    using P = FdmMachine::Process;
    static const Table<P> rows = {
        {"outer_wall_speed_mm_per_s", &P::outer_wall_speed, "mm/s", 1, 1000, kOptional,
         "of the visible walls"},
        {"inner_wall_speed_mm_per_s", &P::inner_wall_speed, "mm/s", 1, 1000, kOptional,
         "of the other walls"},
        {"infill_speed_mm_per_s", &P::infill_speed, "mm/s", 1, 1000, kOptional, "of sparse infill"},
        {"solid_speed_mm_per_s", &P::solid_speed, "mm/s", 1, 1000, kOptional,
         "of solid infill and skins"},
        {"bridge_speed_mm_per_s", &P::bridge_speed, "mm/s", 1, 1000, kOptional,
         "of beads over air"},
        {"overhang_speed_mm_per_s", &P::overhang_speed, "mm/s", 1, 1000, kOptional,
         "of walls that lie over air by more than half their width"},
        {"support_speed_mm_per_s", &P::support_speed, "mm/s", 1, 1000, kOptional, "of supports"},
        {"first_layer_speed_mm_per_s", &P::first_layer_speed, "mm/s", 1, 1000, kOptional,
         "of everything on the bed"},
        {"travel_speed_mm_per_s", &P::travel_speed, "mm/s", 1, 1000, kOptional, "between beads"},
    };
    return rows;
}

const Table<FdmMachine::Process>& plate_rows() {
    using P = FdmMachine::Process;
    static const Table<P> rows = {
        {"part_spacing_mm", &P::part_spacing_mm, "mm", 0, 100, kOptional,
         "between parts on one plate, brims included"},
        {"material", &P::material, "", 0, 0, kOptional,
         "which file of materials/ is used unless another is asked for"},
    };
    return rows;
}

const Table<Material>& material_rows() {
    using M = Material;
    static const Table<M> rows = {
        {"title", &M::title, "", 0, 0, kRequired, "name for people"},
        {"density_g_per_cm3", &M::density_g_per_cm3, "g/cm^3", 0.1, 20, kRequired,
         "of the filament"},
        {"cost_per_kg", &M::cost_per_kg, "", 0, 100000, kOptional, "in your currency; 0: unknown"},
        {"nozzle_celsius", &M::nozzle_celsius, "degrees C", 100, 500, kRequired,
         "from the second layer on"},
        {"first_layer_nozzle_celsius", &M::first_layer_nozzle_celsius, "degrees C", 100, 500,
         kRequired, "on the bed"},
        {"bed_celsius", &M::bed_celsius, "degrees C", 0, 200, kRequired, "0: off"},
        {"max_flow_mm3_per_s", &M::max_flow_mm3_per_s, "mm^3/s", 0.5, 200, kRequired,
         "that this filament stands; the lower of this and the nozzle's counts"},
        {"extrusion_multiplier", &M::extrusion_multiplier, "", 0.5, 2, kOptional,
         "filament fed per filament computed"},
        {"fan_fraction", &M::fan_fraction, "", 0, 1, kOptional, "of the part cooling fan, 0 .. 1"},
        {"bridge_fan_fraction", &M::bridge_fan_fraction, "", 0, 1, kOptional,
         "of the fan over air, where that is more; 0 .. 1"},
        {"fan_from_layer", &M::fan_from_layer, "", 0, 100000, kOptional,
         "layers below this run without fan, counted from 0"},
        {"min_layer_time_s", &M::min_layer_time_s, "s", 0, 300, kOptional,
         "layers that would be faster are slowed down"},
        {"min_speed_mm_per_s", &M::min_speed, "mm/s", 0.5, 200, kOptional,
         "floor of that slow-down"},
    };
    return rows;
}

const Table<Dialect>& dialect_rows() {
    using D = Dialect;
    static const Table<D> rows = {
        {"title", &D::title, "", 0, 0, kRequired, "name for people"},
        {"relative_e", &D::relative_e, "", 0, 0, kOptional,
         "extrusion in increments (M83), else in positions (M82)"},
        {"xyz_decimals", &D::xyz_decimals, "", 1, 6, kOptional,
         "digits after the point of X, Y, Z"},
        {"e_decimals", &D::e_decimals, "", 2, 6, kOptional, "digits after the point of E"},
        {"feed_decimals", &D::feed_decimals, "", 0, 3, kOptional,
         "digits after the point of F, mm/min"},
        {"comment", &D::comment, "", 0, 0, kOptional, "what a comment starts with"},
        {"fan_on", &D::fan_on, "", 0, 0, kOptional, "template; {fan_0_255} or {fan_fraction}"},
        {"fan_off", &D::fan_off, "", 0, 0, kOptional, "template"},
        {"set_nozzle", &D::set_nozzle, "", 0, 0, kRequired,
         "template that sets {celsius} without waiting"},
        {"set_bed", &D::set_bed, "", 0, 0, kRequired,
         "template that sets {celsius} without waiting"},
        {"reset_e", &D::reset_e, "", 0, 0, kOptional,
         "template that calls E zero at {x_mm} {y_mm} {z_mm}, once a layer; needed unless "
         "relative_e"},
        {"progress", &D::progress, "", 0, 0, kOptional,
         "template; {percent}, {minutes_left}; empty: none"},
        {"dwell", &D::dwell, "", 0, 0, kOptional,
         "template that waits {milliseconds} at the end of layers that stay too short; empty: "
         "none"},
        {"max_axes", &D::max_axes, "", 0, 0, kOptional, "letters of the axes that it can speak of"},
        {"fan_is_on_off", &D::fan_is_on_off, "", 0, 0, kOptional,
         "the fan has no speed: on from a fraction of 0.5"},
        {"forbidden", &D::forbidden, "", 0, 0, kOptional,
         "words that are never written, e.g. \"M109\""},
    };
    return rows;
}

std::string quoted(const std::string& text) {
    if (text.find('\n') != std::string::npos && text.find("'''") == std::string::npos) {
        return "'''\n" + text + "'''";
    }
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
        }
        if (c == '\n') {
            out += "\\n";
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string number(double value) { return decomp::decimal(value, 6); }

template <class Vector>
std::string numbers(const Vector& values) {
    std::string out;
    for (const double value : values) {
        out += (out.empty() ? "" : ", ") + number(value);
    }
    return "[" + out + "]";
}

struct WriteToml {
    std::string operator()(const double* value) const { return number(*value); }

    std::string operator()(const int* value) const { return std::to_string(*value); }

    std::string operator()(const bool* value) const { return *value ? "true" : "false"; }

    std::string operator()(const std::string* value) const { return quoted(*value); }

    std::string operator()(const Speed* value) const { return number(value->mm_per_s()); }

    std::string operator()(const Angle* value) const { return number(value->degrees()); }

    std::string operator()(const Eigen::Vector3d* value) const { return numbers(*value); }

    std::string operator()(const Eigen::Vector4d* value) const { return numbers(*value); }

    std::string operator()(const std::vector<double>* value) const { return numbers(*value); }

    std::string operator()(const std::vector<std::string>* value) const {
        std::string out;
        for (const std::string& word : *value) {
            out += (out.empty() ? "" : ", ") + quoted(word);
        }
        return "[" + out + "]";
    }
};

struct StoreNumbers {
    const std::vector<double>& values;

    void operator()(double* target) const { *target = values.front(); }

    void operator()(int* target) const { *target = static_cast<int>(values.front()); }

    void operator()(Speed* target) const { *target = Speed::mm_per_s(values.front()); }

    void operator()(Angle* target) const { *target = Angle::degrees(values.front()); }

    void operator()(Eigen::Vector3d* target) const {
        *target = Eigen::Map<const Eigen::Vector3d>(values.data());
    }

    void operator()(Eigen::Vector4d* target) const {
        *target = Eigen::Map<const Eigen::Vector4d>(values.data());
    }

    void operator()(std::vector<double>* target) const { *target = values; }

    void operator()(bool* /*target*/) const {}

    void operator()(std::string* /*target*/) const {}

    void operator()(std::vector<std::string>* /*target*/) const {}
};

struct CountNumbers {
    int operator()(const Eigen::Vector3d* /*target*/) const { return 3; }

    int operator()(const Eigen::Vector4d* /*target*/) const { return 4; }

    int operator()(const bool* /*target*/) const { return 0; }

    int operator()(const std::string* /*target*/) const { return 0; }

    int operator()(const std::vector<std::string>* /*target*/) const { return 0; }

    int operator()(const std::vector<double>* /*target*/) const { return kAnyCount; }

    template <class Number>
    int operator()(const Number* /*target*/) const {
        return 1;
    }
};

}  // namespace

std::vector<Field> fields_of(FdmSetup& setup) {
    std::vector<Field> out;
    FdmMachine& machine = setup.machine;
    bind(out, File::Machine, "machine", machine_rows(), machine);
    bind(out, File::Machine, "chamber", chamber_rows(), machine.chamber);
    bind(out, File::Machine, "nozzle", nozzle_rows(), machine.nozzle);
    bind(out, File::Machine, "heaters", heaters_rows(), machine.heaters);
    bind(out, File::Machine, "motion", motion_rows(), machine.motion);
    bind(out, File::Machine, "retraction", retraction_rows(), machine.retraction);
    bind(out, File::Machine, "templates", template_rows(), machine.templates);
    bind(out, File::Machine, "converter", converter_rows(), machine.converter);
    for (const Table<FdmMachine::Process>* rows :
         {&layer_rows(), &infill_rows(), &outline_rows(), &support_rows(), &adhesion_rows(),
          &speed_rows(), &plate_rows()}) {
        bind(out, File::Machine, "process", *rows, machine.process);
    }
    bind(out, File::Material, "material", material_rows(), setup.material);
    bind(out, File::Dialect, "dialect", dialect_rows(), setup.dialect);
    return out;
}

std::string toml_text(const Target& target) { return std::visit(WriteToml{}, target); }

void store_numbers(const Target& target, const std::vector<double>& values) {
    std::visit(StoreNumbers{values}, target);
}

int number_count(const Target& target) { return std::visit(CountNumbers{}, target); }

std::string range_text(const Field& field) {
    return number_count(field.target) == 0 ? "" : number(field.low) + " .. " + number(field.high);
}

}  // namespace cam::profile
