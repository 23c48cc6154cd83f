// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/field_table_detail.h"
#include "cam/profile/mill_fields_detail.h"
#include "cam/profile/template.h"

#include <algorithm>

/// The fields of [milling] in dialects and materials.
namespace cam::profile {

namespace {

const Table<MillDialect>& dialect_rows() {
    using D = MillDialect;
    static const Table<D> rows = {
        {"title", &D::title, "", 0, 0, kRequired, "name for people"},
        {"axes", &D::axes, "", 0, 0, kOptional,
         "axes that the dialect can speak of; a machine with more is refused"},
        {"comment_open", &D::comment_open, "", 0, 0, kOptional, "begins a comment"},
        {"comment_close", &D::comment_close, "", 0, 0, kOptional, "ends it; empty: the line does"},
        {"decimals", &D::decimals, "", 2, 6, kOptional, "of X, Y, Z, I, J"},
        {"feed_decimals", &D::feed_decimals, "", 0, 4, kOptional, "of F"},
        {"line_limit", &D::line_limit, "", 40, 250, kOptional,
         "characters of a line, its end not counted"},
        {"arcs", &D::arcs, "", 0, 0, kOptional, "G2 and G3 in the XY plane; else lines"},
        {"helices", &D::helices, "", 0, 0, kOptional, "arcs may change Z; else lines"},
        {"min_arc_radius_mm", &D::min_arc_radius_mm, "mm", 0.01, 100, kOptional,
         "smaller arcs become lines"},
        {"max_arc_radius_mm", &D::max_arc_radius_mm, "mm", 1, 10000, kOptional,
         "larger arcs become lines"},
        {"rapid_feed", &D::rapid_feed, "", 0, 0, kOptional,
         "G0 moves at F: each names the machine's best speed"},
        {"start", &D::start, "", 0, 0, kRequired, "template before the first tool"},
        {"take_tool", &D::take_tool, "", 0, 0, kRequired,
         "template with {tool}; the spindle stands still"},
        {"tool_length", &D::tool_length, "", 0, 0, kOptional,
         "template with {tool} after it; empty: the operator touches off"},
        {"spindle_on", &D::spindle_on, "", 0, 0, kOptional, "template with {rpm}"},
        {"spindle_off", &D::spindle_off, "", 0, 0, kOptional, "template"},
        {"dwell", &D::dwell, "", 0, 0, kOptional, "template with {seconds} or {milliseconds}"},
        {"mist", &D::mist, "", 0, 0, kOptional, "coolant as mist; empty: left out"},
        {"flood", &D::flood, "", 0, 0, kOptional, "coolant as a stream; empty: left out"},
        {"coolant_off", &D::coolant_off, "", 0, 0, kOptional, "empty: left out"},
        {"end", &D::end, "", 0, 0, kRequired, "template after the last move"},
        {"forbidden", &D::forbidden, "", 0, 0, kOptional, "words that must never be written"},
        {"sources", &D::sources, "", 0, 0, kOptional, "where this was read, a text each"},
    };
    return rows;
}

const Table<MillMaterial>& material_rows() {
    using M = MillMaterial;
    static const Table<M> rows = {
        {"title", &M::title, "", 0, 0, kRequired, "name for people"},
        {"surface_speed_m_per_min", &M::surface_speed_m_per_min, "m/min", 1, 2000, kRequired,
         "of the teeth, carbide"},
        {"chip_load", &M::chip_load, "", 0.0005, 0.1, kRequired,
         "mm a tooth for each mm of diameter"},
        {"min_chip_mm", &M::min_chip_mm, "mm", 0, 0.5, kRequired,
         "thinner chips rub instead of being cut"},
        {"step_down", &M::step_down, "", 0.01, 3, kRequired, "of the diameter"},
        {"step_over", &M::step_over, "", 0.02, 1, kRequired,
         "of the diameter, beside what is cut already"},
        {"finish_step_down", &M::finish_step_down, "", 0.01, 3, kOptional, "of the diameter"},
        {"slot_factor", &M::slot_factor, "", 0.05, 1, kOptional, "on step_down, in a full slot"},
        {"plunge_factor", &M::plunge_factor, "", 0.02, 1, kOptional, "on the feed, straight down"},
        {"ramp_factor", &M::ramp_factor, "", 0.02, 1, kOptional, "on the feed, down a ramp"},
        {"peck", &M::peck, "", 0.1, 5, kOptional, "of the diameter, when drilling"},
        {"power_w_s_per_mm3", &M::power_w_s_per_mm3, "W s/mm^3", 0.001, 20, kRequired,
         "for each mm^3 of chips a second"},
        {"coolant", &M::coolant, "", 0, 0, kOptional, "off, mist or flood"},
        {"sources", &M::sources, "", 0, 0, kRequired,
         "where each value was read and its licence, a text each"},
    };
    return rows;
}

const TemplateValues& sample_values() {
    static const TemplateValues values = {{"tool", 1.0},
                                          {"rpm", 1000.0},
                                          {"seconds", 1.0},
                                          {"milliseconds", 1000.0},
                                          {"safe_z_mm", 5.0}};
    return values;
}

}  // namespace

std::vector<Field> fields_of(MillDialect& dialect) {
    std::vector<Field> out;
    bind(out, File::MillDialect, "milling", dialect_rows(), dialect);
    return out;
}

std::vector<Field> fields_of(MillMaterial& material) {
    std::vector<Field> out;
    bind(out, File::MillMaterial, "milling", material_rows(), material);
    return out;
}

std::vector<std::string> inconsistencies(const MillDialect& dialect) {
    std::vector<std::string> said;
    Dialect words;
    words.forbidden = dialect.forbidden;
    const std::pair<const char*, const std::string&> texts[] = {
        {"start", dialect.start},
        {"take_tool", dialect.take_tool},
        {"tool_length", dialect.tool_length},
        {"spindle_on", dialect.spindle_on},
        {"spindle_off", dialect.spindle_off},
        {"dwell", dialect.dwell},
        {"mist", dialect.mist},
        {"flood", dialect.flood},
        {"coolant_off", dialect.coolant_off},
        {"end", dialect.end}};
    for (const auto& [key, text] : texts) {
        const decomp::Result<std::string> written = expand(text, sample_values());
        if (!written) {
            said.push_back("milling." + std::string(key) + ": " + written.error().message);
        } else if (const auto word = first_forbidden_word(*written, words)) {
            said.push_back("milling." + std::string(key) + " has " + word->word +
                           ", which milling.forbidden lists");
        }
    }
    if (!dialect.axes.starts_with("XYZ")) {
        said.emplace_back("milling.axes begins with XYZ");
    }
    if (dialect.min_arc_radius_mm >= dialect.max_arc_radius_mm) {
        said.emplace_back("milling.max_arc_radius_mm must be above milling.min_arc_radius_mm");
    }
    return said;
}

std::vector<std::string> inconsistencies(const MillMachine& machine, const MillDialect& dialect) {
    if (machine.has_rotary() && dialect.axes.find('A') == std::string::npos) {
        return {"the machine has an axis A, of which the dialect " + dialect.name +
                " cannot speak (its axes are " + dialect.axes + ")"};
    }
    return {};
}

std::vector<std::string> inconsistencies(const MillMaterial& material) {
    if (material.coolant != "off" && material.coolant != "mist" && material.coolant != "flood") {
        return {"milling.coolant is off, mist or flood"};
    }
    return {};
}

}  // namespace cam::profile
