// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/field_table_detail.h"
#include "cam/profile/mill_fields_detail.h"

namespace cam::profile {

namespace {

const Table<MillMachine>& mill_rows() {
    using M = MillMachine;
    static const Table<M> rows = {
        {"title", &M::title, "", 0, 0, kRequired, "name for people"},
        {"tools", &M::tools, "", 0, 0, kRequired, "files of tools/, in the order of use"},
        {"dialect", &M::dialect, "", 0, 0, kOptional, "file of dialects/ with a section [milling]"},
        {"sources", &M::sources, "", 0, 0, kOptional, "where the values were read, a text each"},
    };
    return rows;
}

const Table<MillMachine::Travel>& travel_rows() {
    using T = MillMachine::Travel;
    static const Table<T> rows = {
        {"min_mm", &T::min_mm, "mm", -5000, 5000, kRequired,
         "lowest X, Y, Z of the spindle, machine coordinates"},
        {"max_mm", &T::max_mm, "mm", -5000, 5000, kRequired, "highest X, Y, Z of the spindle"},
        {"nose_to_table_mm", &T::nose_to_table_mm, "mm", 1, 2000, kRequired,
         "from the spindle's nose at the top of its travel down to the table"},
        {"margin_mm", &T::margin_mm, "mm", 0, 100, kOptional,
         "kept free at each side in X and Y, and at the top"},
    };
    return rows;
}

const Table<MillMachine::Rotary>& rotary_rows() {
    using R = MillMachine::Rotary;
    static const Table<R> rows = {
        {"max_diameter_mm", &R::max_diameter_mm, "mm", 0, 2000, kOptional,
         "what can turn about A without touching anything; 0: there is no rotary axis"},
        {"max_length_mm", &R::max_length_mm, "mm", 0, 5000, kOptional,
         "between chuck and tailstock"},
        {"nose_to_axis_mm", &R::nose_to_axis_mm, "mm", 0, 2000, kOptional,
         "from the spindle's nose at the top of its travel down to the axis"},
        {"a_sign", &R::a_sign, "", -1, 1, kOptional,
         "+1: A counts as LinuxCNC and ISO 841 have it; -1: the other way"},
    };
    return rows;
}

const Table<MillMachine::Spindle>& spindle_rows() {
    using S = MillMachine::Spindle;
    static const Table<S> rows = {
        {"min_rpm", &S::min_rpm, "1/min", 0, 100000, kOptional, "slowest speed that it holds"},
        {"max_rpm", &S::max_rpm, "1/min", 1, 200000, kOptional, "highest speed"},
        {"power_w", &S::power_w, "W", 0, 100000, kOptional,
         "at the cutter; 0: unknown, cuts are not checked against it"},
        {"spin_up_s", &S::spin_up_s, "s", 0, 120, kOptional, "waited after each start"},
    };
    return rows;
}

const Table<MillMachine::Axes>& axes_rows() {
    using A = MillMachine::Axes;
    static const Table<A> rows = {
        {"max_feed_mm_per_min", &A::max_feed_mm_per_min, "mm/min", 1, 100000, kOptional,
         "highest speed of X, Y, Z"},
        {"acceleration_mm_per_s2", &A::acceleration_mm_per_s2, "mm/s^2", 1, 50000, kOptional,
         "of X, Y, Z"},
    };
    return rows;
}

const Table<MillMachine::Reach>& reach_rows() {
    using R = MillMachine::Reach;
    static const Table<R> rows = {
        {"tolerance_mm", &R::tolerance_mm, "mm", 0.005, 5, kOptional,
         "rest along the normal that counts as reached"},
        {"cell_mm", &R::cell_mm, "mm", 0.01, 5, kOptional, "of the height maps"},
        {"shank_clearance_mm", &R::shank_clearance_mm, "mm", 0, 10, kOptional,
         "kept between shank and part"},
        {"holder_clearance_mm", &R::holder_clearance_mm, "mm", 0, 20, kOptional,
         "kept between holder and part"},
        {"max_unreached_percent", &R::max_unreached_percent, "", 0, 100, kOptional,
         "of a part's area, for a part that can be made"},
        {"angles", &R::angles, "", 4, 64, kOptional,
         "positions of A that are tried, evenly over a turn"},
    };
    return rows;
}

const Table<ToolFile>& shape_rows() {
    using T = ToolFile;
    static const Table<T> rows = {
        {"shape", &T::shape, "", 0, 0, kRequired,
         "flat, ball, bull-nose, tapered-ball, v or drill"},
    };
    return rows;
}

const Table<tool::Tool>& tool_rows() {
    using T = tool::Tool;
    static const Table<T> rows = {
        {"title", &T::title, "", 0, 0, kRequired, "name for people"},
        {"number", &T::number, "", 0, 9999, kRequired, "in the machine's tool table"},
        {"diameter_mm", &T::diameter_mm, "mm", 0.05, 200, kRequired,
         "of the cutting part where it is widest"},
        {"corner_radius_mm", &T::corner_radius_mm, "mm", 0, 100, kOptional, "of a bull-nose"},
        {"tip_diameter_mm", &T::tip_diameter_mm, "mm", 0, 100, kOptional,
         "of a taper's ball, or of a V's flat tip"},
        {"taper_deg", &T::taper, "degrees", 0, 89, kOptional,
         "of a tapered ball, between axis and flank"},
        {"point_deg", &T::point, "degrees", 0, 179, kOptional,
         "full angle of a V's or a drill's cone"},
        {"flutes", &T::flutes, "", 1, 20, kOptional, "cutting edges"},
        {"flute_mm", &T::flute_mm, "mm", 0.1, 500, kRequired, "height of the part that cuts"},
        {"shank_diameter_mm", &T::shank_diameter_mm, "mm", 0.1, 200, kRequired,
         "between flutes and holder"},
        {"stickout_mm", &T::stickout_mm, "mm", 0.1, 500, kRequired, "from tip to holder"},
    };
    return rows;
}

const Table<ToolFile>& holder_rows() {
    using T = ToolFile;
    static const Table<T> rows = {
        {"lower_diameters_mm", &T::lower_diameters_mm, "mm", 0.1, 500, kOptional,
         "of the holder's sections, from the lowest up; empty: nothing is known of the holder"},
        {"upper_diameters_mm", &T::upper_diameters_mm, "mm", 0.1, 500, kOptional,
         "of the same sections at their upper ends"},
        {"lengths_mm", &T::lengths_mm, "mm", 0.1, 500, kOptional, "of the same sections"},
    };
    return rows;
}

}  // namespace

std::vector<Field> fields_of(MillMachine& machine) {
    std::vector<Field> out;
    bind(out, File::Mill, "machine", mill_rows(), machine);
    bind(out, File::Mill, "travel", travel_rows(), machine.travel);
    bind(out, File::Mill, "rotary", rotary_rows(), machine.rotary);
    bind(out, File::Mill, "spindle", spindle_rows(), machine.spindle);
    bind(out, File::Mill, "axes", axes_rows(), machine.axes);
    bind(out, File::Mill, "reach", reach_rows(), machine.reach);
    return out;
}

std::vector<Field> fields_of(ToolFile& file) {
    std::vector<Field> out;
    bind(out, File::Tool, "tool", shape_rows(), file);
    bind(out, File::Tool, "tool", tool_rows(), file.tool);
    bind(out, File::Tool, "holder", holder_rows(), file);
    return out;
}

ToolFile file_of(const tool::Tool& tool) {
    ToolFile file{tool, std::string(tool::name_of(tool.shape)), {}, {}, {}};
    for (const tool::HolderSection& section : tool.holder) {
        file.lower_diameters_mm.push_back(section.lower_diameter_mm);
        file.upper_diameters_mm.push_back(section.upper_diameter_mm);
        file.lengths_mm.push_back(section.length_mm);
    }
    return file;
}

decomp::Result<tool::Tool> tool_of(const ToolFile& file, const std::string& where) {
    const auto shape = tool::shape_named(file.shape);
    if (!shape) {
        return decomp::fail("profile.inconsistent", "there is no tool shape '" + file.shape + "'",
                            where, "shapes are flat, ball, bull-nose, tapered-ball, v and drill");
    }
    if (file.lower_diameters_mm.size() != file.lengths_mm.size() ||
        file.upper_diameters_mm.size() != file.lengths_mm.size()) {
        return decomp::fail("profile.inconsistent",
                            "the lists of [holder] must be of one length: one entry a section",
                            where);
    }
    tool::Tool out = file.tool;
    out.shape = *shape;
    out.holder.clear();
    for (std::size_t i = 0; i < file.lengths_mm.size(); ++i) {
        out.holder.push_back(
            {file.lower_diameters_mm[i], file.upper_diameters_mm[i], file.lengths_mm[i]});
    }
    const std::vector<std::string> said = tool::faults(out);
    if (!said.empty()) {
        return decomp::fail(decomp::Error{
            "profile.inconsistent", said.front(), where, {}, {said.begin() + 1, said.end()}});
    }
    return out;
}

std::vector<std::string> inconsistencies(const MillMachine& machine) {
    std::vector<std::string> said;
    const Eigen::Vector3d size = machine.travel.max_mm - machine.travel.min_mm;
    if (!(size.head<2>().minCoeff() > 2 * machine.travel.margin_mm &&
          size.z() > machine.travel.margin_mm)) {
        said.emplace_back("travel.max_mm must be above travel.min_mm by more than the margins");
    }
    if (machine.rotary.a_sign == 0) {
        said.emplace_back("rotary.a_sign is 1 or -1");
    }
    if (machine.has_rotary() &&
        !(machine.rotary.max_length_mm > 0 && machine.rotary.nose_to_axis_mm > 0)) {
        said.emplace_back(
            "a rotary axis needs rotary.max_length_mm and rotary.nose_to_axis_mm above 0");
    }
    if (machine.spindle.min_rpm > machine.spindle.max_rpm) {
        said.emplace_back("spindle.max_rpm must not be below spindle.min_rpm");
    }
    if (machine.reach.tolerance_mm < machine.reach.cell_mm * 0.7071) {
        said.emplace_back("reach.tolerance_mm must be at least 0.71 of reach.cell_mm");
    }
    return said;
}

}  // namespace cam::profile
