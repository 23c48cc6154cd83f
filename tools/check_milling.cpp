// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/height_map.h"
#include "cam/check/judges.h"
#include "cam/check/mill3.h"
#include "cam/check/mill4.h"
#include "cam/check/unreachable.h"
#include "cam/profile/read_mill.h"
#include "decomp/base/file.h"
#include "decomp/base/number.h"
#include "decomp/io/part_ply.h"
#include "decomp/mesh/measure.h"
#include "tools/check_pictures.h"
#include "tools/check_report.h"
#include "tools/exit_code.h"

#include <Eigen/Geometry>

namespace tools {

namespace {

using cam::check::Mill3Check;
using cam::check::Mill4Check;
using decomp::Result;
using decomp::Run;
using decomp::part::Part;
using decomp::part::Violation;

/// The mill at hand; without --machine only the tools and the defaults of a profile.
struct Mill {
    cam::profile::MillSetup setup;
    bool known = false;  ///< --machine was given: limits count
};

Result<Mill> mill_of(const CheckRequest& request) {
    Mill mill;
    if (!request.machine.empty()) {
        auto setup =
            cam::profile::read_mill_setup(request.machine, request.tools, request.settings);
        if (!setup) {
            return decomp::fail(setup.error());
        }
        mill.setup = std::move(*setup);
        mill.known = true;
        return mill;
    }
    if (!request.settings.empty()) {
        return decomp::fail("usage.machine_needed", "--set changes a machine: say --machine too");
    }
    for (const std::string& name : request.tools) {
        auto tool = cam::profile::read_tool(name);
        if (!tool) {
            return decomp::fail(tool.error());
        }
        mill.setup.tools.push_back(std::move(*tool));
    }
    return mill;
}

Json violations_json(const std::vector<Violation>& violations) {
    Json out = Json::array();
    for (const Violation& violation : violations) {
        out.push_back({{"constraint", violation.constraint}, {"by_ratio", violation.by_ratio}});
    }
    return out;
}

std::string fits_text(bool known, const std::vector<Violation>& violations) {
    if (!known) {
        return "-";
    }
    std::string text;
    for (const Violation& violation : violations) {
        text += (text.empty() ? "" : " ") + violation.constraint;
    }
    return text.empty() ? "yes" : text;
}

/// Adds up the parts of a partition by area.
struct Sum {
    double area = 0;
    double of = 0;

    void add(double percent, double area_mm2) {
        area += percent / 100 * area_mm2;
        of += area_mm2;
    }

    [[nodiscard]] double percent() const { return of > 0 ? 100 * area / of : 0; }
};

/// The limits of a known machine that the part breaks as it is clamped.
std::vector<Violation> misfits_of(const Mill& mill, const Part& part, const Mill3Check& check) {
    if (!mill.known) {
        return {};
    }
    const Eigen::Affine3d turn(cam::check::frame_looking_down(check.poses[check.best].direction));
    return cam::check::mill_misfits(
        mill.setup.machine, mill.setup.tools,
        decomp::mesh::bounds(decomp::mesh::transformed(part.mesh, turn)).sizes());
}

std::vector<Violation> misfits_of(const Mill& mill, const Mill4Check& check) {
    if (!mill.known) {
        return {};
    }
    return cam::check::rotary_misfits(mill.setup.machine, mill.setup.tools, check.stock.radius_mm,
                                      check.stock.length_mm);
}

/// Whether the mill can make the part: it fits, and little is left that no tool reaches.
bool can_make(const Mill& mill, const std::vector<Violation>& misfits,
              const cam::check::Share& unreached) {
    return misfits.empty() &&
           unreached.by_area_percent <= mill.setup.machine.reach.max_unreached_percent;
}

std::vector<std::string> with_tools(std::vector<std::string> head, const Mill& mill) {
    for (const auto& tool : mill.setup.tools) {
        head.push_back(tool.name);
    }
    return head;
}

Json tool_json(const cam::check::ToolFigures& figures) {
    return {{"tool", figures.tool},
            {"unreached", share_json(figures.unreached)},
            {"unreached_by_cutter_alone", share_json(figures.unreached_cutter)}};
}

Json mill3_json(const Part& part, const Mill3Check& check) {
    const auto& best = check.poses[check.best];
    const auto& by_normal = check.poses[check.best_by_normal];
    Json json{{"id", part.id},
              {"facets", part.mesh.triangles.size()},
              {"area_mm2", decomp::mesh::area_mm2(part.mesh)},
              {"3AM",
               {{"paper_percent", by_normal.undercut.by_area_percent},
                {"true_percent", best.unseen.by_area_percent},
                {"by_facets_percent", by_normal.undercut.by_facets_percent}}},
              {"direction", vector_json(best.direction)},
              {"flat_base", best.flat_base},
              {"plane", best.plane},
              {"height_field", best.height_field},
              {"base", share_json(best.base)},
              {"undercut", share_json(best.undercut)},
              {"unseen", share_json(best.unseen)},
              {"unreached_by_all_tools", share_json(check.unreached_together)},
              {"poses_tried", check.poses.size()},
              {"tools", Json::array()}};
    for (const auto& figures : check.tools) {
        json["tools"].push_back(tool_json(figures));
    }
    return json;
}

Json indices_json(const cam::check::Indices& indices) {
    return {{"a_deg", indices.a_degrees},
            {"covered_percent", indices.covered_percent},
            {"coverable_percent", indices.coverable_percent},
            {"proved_smallest", indices.smallest},
            {"at_least", indices.at_least}};
}

Json mill4_json(const Part& part, const Mill4Check& check) {
    Json axes = Json::array();
    for (const auto& axis : check.axes) {
        axes.push_back({{"axis", vector_json(axis.axis)},
                        {"unseen_percent", axis.unseen_percent},
                        {"open_end_percent", axis.open_end_percent},
                        {"stock_mm3", axis.stock_mm3}});
    }
    Json json{
        {"id", part.id},
        {"facets", part.mesh.triangles.size()},
        {"area_mm2", decomp::mesh::area_mm2(part.mesh)},
        {"4AM",
         {{"paper_percent", check.unseen.by_facets_percent},
          {"true_percent", check.unseen.by_area_percent},
          {"with_ends_percent", check.unseen_with_ends.by_area_percent}}},
        {"axis", vector_json(check.stock.axis)},
        {"through", vector_json(check.stock.low)},
        {"stock", {{"radius_mm", check.stock.radius_mm}, {"length_mm", check.stock.length_mm}}},
        {"setup_from_model", check.setup_from_model.row_major()},
        {"unseen", share_json(check.unseen)},
        {"ends", share_json(check.ends)},
        {"ends_unseen", share_json(check.ends_unseen)},
        {"unreached_by_all_tools", share_json(check.unreached_together)},
        {"uncertain", share_json(check.uncertain)},
        {"indices", indices_json(check.indices)},
        {"axes_compared", axes},
        {"tools", Json::array()}};
    for (const auto& figures : check.tools) {
        Json row{{"tool", figures.tool},
                 {"unreached", share_json(figures.unreached)},
                 {"unreached_by_cutter_alone", share_json(figures.unreached_cutter)},
                 {"unreached_at_indices", share_json(figures.unreached_at_indices)},
                 {"indices", indices_json(figures.indices)}};
        json["tools"].push_back(row);
    }
    return json;
}

std::vector<std::string> mill3_row(const Part& part, const Mill3Check& check,
                                   const std::string& fits) {
    const auto& best = check.poses[check.best];
    const auto& by_normal = check.poses[check.best_by_normal];
    std::vector<std::string> row{part.id,
                                 std::to_string(part.mesh.triangles.size()),
                                 percent_text(by_normal.undercut.by_area_percent),
                                 percent_text(best.unseen.by_area_percent),
                                 percent_text(best.base.by_area_percent),
                                 percent_text(by_normal.undercut.by_facets_percent),
                                 direction_text(best.direction),
                                 best.flat_base ? "yes" : "no",
                                 best.height_field ? "yes" : "no",
                                 fits};
    for (const auto& figures : check.tools) {
        row.push_back(percent_text(figures.unreached.by_area_percent));
    }
    return row;
}

std::vector<std::string> mill4_row(const Part& part, const Mill4Check& check,
                                   const std::string& fits) {
    std::vector<std::string> row{part.id,
                                 std::to_string(part.mesh.triangles.size()),
                                 percent_text(check.unseen.by_facets_percent),
                                 percent_text(check.unseen.by_area_percent),
                                 percent_text(check.ends.by_area_percent),
                                 percent_text(check.ends_unseen.by_area_percent),
                                 direction_text(check.stock.axis),
                                 "d " + decomp::decimal(2 * check.stock.radius_mm, 1) + " l " +
                                     decomp::decimal(check.stock.length_mm, 1),
                                 fits};
    for (const auto& tool : check.tools) {
        row.push_back(percent_text(tool.unreached.by_area_percent));
    }
    return row;
}

std::string indices_text(const cam::check::Indices& indices) {
    std::string text;
    for (std::size_t i = 0; i < indices.a_degrees.size(); ++i) {
        text += (i == 0 ? "A " : " ") + decomp::decimal(indices.a_degrees[i], 1) + " (" +
                decomp::decimal(indices.covered_percent[i], 1) + ")";
    }
    return text + (indices.smallest
                       ? ""
                       : " not proved smallest: at least " + std::to_string(indices.at_least));
}

/// The positions of A for rays and for each tool, a line each.
std::string indices_lines(const Part& part, const Mill4Check& check) {
    std::string text = part.id + "  ray: " + indices_text(check.indices) + "\n";
    for (const auto& tool : check.tools) {
        text += part.id + "  " + tool.tool + ": " + indices_text(tool.indices) + "\n";
    }
    return text;
}

std::string dropped_line(const Part& part, const Json& dropped) {
    return part.id + "  dropped " + std::to_string(dropped["facets"].get<int>()) +
           " facets, volume " + decomp::fixed(dropped["volume_change_percent"].get<double>(), 3) +
           " %\n";
}

Result<cam::check::Mill4Options> mill4_options(const CheckRequest& request, const Mill& mill) {
    cam::check::Mill4Options options;
    options.angles = request.angles.value_or(mill.setup.machine.reach.angles);
    options.a_sign = mill.setup.machine.rotary.a_sign;
    options.reach = cam::check::reach_options(mill.setup.machine);
    if (request.axis != "auto") {
        const auto axis = parse_direction(request.axis);
        if (!axis) {
            return decomp::fail(axis.error());
        }
        options.axis = *axis;
    }
    return options;
}

/// Writes PART.ply without what no position of A shows, and says what that did.
Result<Json> drop_unseen(const CheckRequest& request, const Part& part, const Mill4Check& check,
                         const Run& run) {
    std::vector<char> wanted = check.facets.seen;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (check.facets.end[i] != 0 && check.facets.hidden_end[i] == 0) {
            wanted[i] = 1;
        }
    }
    const auto dropped = cam::check::drop_unreachable(part.mesh, wanted, run);
    if (!dropped) {
        return decomp::fail(dropped.error());
    }
    Part out;
    out.id = part.id;
    out.mesh = dropped->mesh;
    out.sources.resize(out.mesh.triangles.size());
    const auto written =
        decomp::write_file(request.drop / (part.id + ".ply"), decomp::io::part_ply_bytes(out),
                           request.force ? decomp::Overwrite::Allow : decomp::Overwrite::Refuse);
    if (!written) {
        return decomp::fail(written.error());
    }
    const double change = dropped->volume_after_mm3 - dropped->volume_before_mm3;
    return Json{{"file", (request.drop / (part.id + ".ply")).string()},
                {"facets", dropped->facets},
                {"area_mm2", dropped->area_mm2},
                {"holes_closed", dropped->patches},
                {"cavities_filled", dropped->cavities},
                {"patches_left", dropped->patches_left},
                {"area_left_mm2", dropped->area_left_mm2},
                {"volume_before_mm3", dropped->volume_before_mm3},
                {"volume_after_mm3", dropped->volume_after_mm3},
                {"volume_change_percent", 100 * change / dropped->volume_before_mm3}};
}

}  // namespace

Result<Answer> check_three_axes(const CheckRequest& request, const CheckInput& input, Run& run) {
    const auto mill = mill_of(request);
    if (!mill) {
        return decomp::fail(mill.error());
    }
    cam::check::Mill3Options options;
    options.setups = request.setups == 2 ? cam::check::Setups::Two : cam::check::Setups::One;
    options.reach = cam::check::reach_options(mill->setup.machine);
    Answer answer;
    answer.json = {{"process", "mill3"}, {"machine", request.machine}, {"setups", request.setups}};
    answer.json["parts"] = Json::array();
    TextTable table(with_tools({"part", "facets", "%3AM", "true", "base", "by facets", "direction",
                                "flat", "field", "fits"},
                               *mill));
    Sum paper;
    Sum unseen;
    bool possible = true;
    for (std::size_t i = 0; i < input.parts.size(); ++i) {
        const Part& part = input.parts[i];
        const auto check = cam::check::check_mill3(part, options, mill->setup.tools, run);
        if (!check) {
            return decomp::fail(check.error());
        }
        const auto& best = check->poses[check->best];
        const auto& by_normal = check->poses[check->best_by_normal];
        Json json = mill3_json(part, *check);
        const std::vector<Violation> misfits = misfits_of(*mill, part, *check);
        if (mill->known) {
            json["misfits"] = violations_json(misfits);
        }
        table.add(mill3_row(part, *check, fits_text(mill->known, misfits)));
        possible = possible && can_make(*mill, misfits, check->unreached_together);
        const double area = decomp::mesh::area_mm2(part.mesh);
        paper.add(by_normal.undercut.by_area_percent, area);
        unseen.add(best.unseen.by_area_percent, area);
        answer.json["parts"].push_back(json);
        if (const auto drawn = draw_milling(request, part, *check, best.direction, run); !drawn) {
            return decomp::fail(drawn.error());
        }
        run.progress("check", static_cast<double>(i + 1) / static_cast<double>(input.parts.size()));
    }
    answer.json["3AM"] = {{"paper_percent", paper.percent()}, {"true_percent", unseen.percent()}};
    answer.text = table.text() + "\n%3AM of all parts " + percent_text(paper.percent()) +
                  ", true " + percent_text(unseen.percent()) + "\n";
    answer.exit_code = possible ? kOk : kInfeasible;
    return answer;
}

Result<Answer> check_four_axes(const CheckRequest& request, const CheckInput& input, Run& run) {
    const auto mill = mill_of(request);
    if (!mill) {
        return decomp::fail(mill.error());
    }
    const auto options = mill4_options(request, *mill);
    if (!options) {
        return decomp::fail(options.error());
    }
    Answer answer;
    answer.json = {{"process", "mill4"},
                   {"machine", request.machine},
                   {"angles", options->angles},
                   {"a_sign", options->a_sign}};
    answer.json["parts"] = Json::array();
    TextTable table(with_tools(
        {"part", "facets", "%4AM", "true", "ends", "unseen", "axis", "stock mm", "fits"}, *mill));
    std::string indices = "\n";
    Sum unseen;
    bool possible = true;
    for (std::size_t i = 0; i < input.parts.size(); ++i) {
        const Part& part = input.parts[i];
        const auto check = cam::check::check_mill4(part, *options, mill->setup.tools, run);
        if (!check) {
            return decomp::fail(check.error());
        }
        Json json = mill4_json(part, *check);
        const std::vector<Violation> misfits = misfits_of(*mill, *check);
        if (mill->known) {
            json["misfits"] = violations_json(misfits);
        }
        table.add(mill4_row(part, *check, fits_text(mill->known, misfits)));
        indices += indices_lines(part, *check);
        possible = possible && can_make(*mill, misfits, check->unreached_together);
        unseen.add(check->unseen.by_area_percent, decomp::mesh::area_mm2(part.mesh));
        if (!request.drop.empty()) {
            const auto dropped = drop_unseen(request, part, *check, run);
            if (!dropped) {
                return decomp::fail(dropped.error());
            }
            json["dropped"] = *dropped;
            indices += dropped_line(part, *dropped);
        }
        answer.json["parts"].push_back(json);
        if (const auto drawn = draw_rotary(request, part, *check, *options, run); !drawn) {
            return decomp::fail(drawn.error());
        }
        run.progress("check", static_cast<double>(i + 1) / static_cast<double>(input.parts.size()));
    }
    answer.json["4AM"] = {{"true_percent", unseen.percent()}};
    answer.text = table.text() + indices + "\n%4AM of all parts by area " +
                  percent_text(unseen.percent()) + "\n";
    answer.exit_code = possible ? kOk : kInfeasible;
    return answer;
}

}  // namespace tools
