// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/mill_report.h"

#include "decomp/base/number.h"
#include "tools/values.h"

#include <algorithm>
#include <set>
#include <variant>

namespace tools {

namespace {

using cam::path::MillPlan;
using cam::path::MillProgram;
using decomp::decimal;

Json point(const Eigen::Vector3d& p) { return Json::array({p.x(), p.y(), p.z()}); }

Json box_json(const Eigen::AlignedBox3d& box) {
    return {{"type", "box"}, {"min", point(box.min())}, {"max", point(box.max())}};
}

std::string shape_word(cam::tool::Shape shape) {
    switch (shape) {
        case cam::tool::Shape::BullNose:
            return "bull";
        case cam::tool::Shape::TaperedBall:
            return "taper";
        default:
            return std::string(name_of(shape));
    }
}

Json tool_json(const cam::tool::Tool& tool) {
    Json json{{"n", tool.number},
              {"type", shape_word(tool.shape)},
              {"d", tool.diameter_mm},
              {"flute", tool.flute_mm},
              {"shank_d", tool.shank_diameter_mm},
              {"stickout", tool.stickout_mm}};
    if (tool.shape == cam::tool::Shape::BullNose) {
        json["corner_r"] = tool.corner_radius_mm;
    }
    if (tool.shape == cam::tool::Shape::TaperedBall) {
        json["taper_deg"] = tool.taper.degrees();
        json["tip_d"] = tool.tip_diameter_mm;
    }
    if (tool.shape == cam::tool::Shape::V || tool.shape == cam::tool::Shape::Drill) {
        json["point_deg"] = tool.point.degrees();
        json["tip_d"] = tool.tip_diameter_mm;
    }
    json["holder"] = Json::array();
    for (const auto& section : tool.holder) {
        json["holder"].push_back({{"d", section.lower_diameter_mm},
                                  {"d_top", section.upper_diameter_mm},
                                  {"len", section.length_mm}});
    }
    return json;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string size_text(const Eigen::Vector3d& size) {
    return decimal(size.x(), 1) + " x " + decimal(size.y(), 1) + " x " + decimal(size.z(), 1) +
           " mm";
}

/// The block from above, its zero, what is kept in it, the paths of the last tool.
std::string picture(const MillPlan& plan, const MillProgram& program, bool first) {
    const Eigen::Vector3d size = program.stock.sizes();
    std::string svg = "<svg viewBox=\"-12 " + decimal(-size.y() - 12, 1) + " " +
                      decimal(size.x() + 24, 1) + " " + decimal(size.y() + 24, 1) +
                      "\" style=\"width:14cm\"><g transform=\"scale(1,-1)\">";
    const auto rect = [&](const Eigen::AlignedBox3d& box, const char* style) {
        svg += "<rect x=\"" + decimal(box.min().x(), 2) + "\" y=\"" + decimal(box.min().y(), 2) +
               "\" width=\"" + decimal(box.sizes().x(), 2) + "\" height=\"" +
               decimal(box.sizes().y(), 2) + "\" style=\"" + style + "\"/>";
    };
    rect(program.stock, "fill:#f2e3c6;stroke:#333;stroke-width:.4");
    const Eigen::Isometry3d here =
        program.from_model.map() * plan.programs.front().from_model.map().inverse();
    std::string line;
    for (const auto& move : program.moves) {
        const auto* cut = std::get_if<cam::path::MillCut>(&move.what);
        if (cut != nullptr && (move.operation == cam::path::MillOperation::Parallel ||
                               move.operation == cam::path::MillOperation::Waterline)) {
            line += (line.empty() ? "M" : "L") + decimal(cut->to.x(), 1) + " " +
                    decimal(cut->to.y(), 1);
        } else if (!line.empty() && std::holds_alternative<cam::path::MillRapid>(move.what)) {
            svg += "<path d=\"" + line + R"(" style="fill:none;stroke:#47a;stroke-width:.08"/>)";
            line.clear();
        }
    }
    for (const auto& keep : plan.keeps) {
        Eigen::AlignedBox3d box;
        box.extend(here * keep.box.min());
        box.extend(here * keep.box.max());
        rect(box, keep.kind == cam::path::MillKeep::Kind::Tab
                      ? "fill:#d55;stroke:none"
                      : "fill:#e6cf9f;stroke:#333;stroke-width:.2");
    }
    for (const auto& dowel : plan.dowels) {
        const Eigen::Vector3d at = here * Eigen::Vector3d(dowel.at.x(), dowel.at.y(), 0);
        svg += "<circle cx=\"" + decimal(at.x(), 2) + "\" cy=\"" + decimal(at.y(), 2) + "\" r=\"" +
               decimal(dowel.diameter_mm / 2, 2) + "\" style=\"fill:#fff;stroke:#333;" +
               "stroke-width:.4\"/>";
    }
    svg +=
        "<path d=\"M0 0H10M0 0V10\" style=\"stroke:#c00;stroke-width:.8\"/>"
        "<circle r=\"1.6\" style=\"fill:none;stroke:#c00;stroke-width:.6\"/></g>"
        "<text x=\"-10\" y=\"9\" style=\"font-size:5px;fill:#c00\">zero: this corner, " +
        std::string(first ? "top of the block" : "new top of the block") + "</text></svg>";
    return svg;
}

std::string programs_html(const MillSheet& sheet) {
    const MillPlan& plan = *sheet.plan;
    std::string html;
    for (std::size_t i = 0; i < plan.programs.size(); ++i) {
        const MillProgram& program = plan.programs[i];
        html += "<h2>Set-up " + std::to_string(i + 1) + ": " + escaped(sheet.programs[i].name) +
                "</h2><p>";
        if (i > 0) {
            html += "Turn the block over about " + std::string(plan.flip_axis == "x" ? "X" : "Y") +
                    " (front to back stays " + (plan.flip_axis == "x" ? "left to right" : "front") +
                    "), onto the dowels; set the zero again. ";
        }
        html += program.hold == cam::path::Hold::Bottom
                    ? "The block lies on its flat side, glued, taped or held by vacuum: the whole "
                      "of it is cut from around the part. "
                    : "Clamp or screw the block down at its border, outside the hatched room. ";
        html += "Rapids go at Z " + decimal(program.safe_z, 1) + ". About " +
                duration_text(moving_seconds(program, sheet.setup->machine)) +
                " of moving, accelerations and changes of tool not counted.</p>" +
                picture(plan, program, i == 0) + "<table><tr><th>operation</th><th>moves</th></tr>";
        std::vector<std::pair<std::string, int>> operations;
        for (const auto& move : program.moves) {
            const std::string name(operation_name(move.operation));
            if (operations.empty() || operations.back().first != name) {
                operations.emplace_back(name, 0);
            }
            ++operations.back().second;
        }
        for (const auto& [name, count] : operations) {
            html += "<tr><td>" + name + "</td><td>" + std::to_string(count) + "</td></tr>";
        }
        html += "</table><p><img src=\"" + escaped(sheet.pictures[i]) +
                "\" style=\"width:14cm\" alt=\"what remains of the block\"><br>What the proof "
                "found to remain, coloured by how far it is from the part.</p>";
    }
    return html;
}

}  // namespace

double moving_seconds(const MillProgram& program, const cam::profile::MillMachine& machine) {
    double seconds = 0;
    Eigen::Vector3d at(0, 0, program.safe_z);
    for (const auto& move : program.moves) {
        if (const auto* rapid = std::get_if<cam::path::MillRapid>(&move.what)) {
            const Eigen::Array3d way = (rapid->to - at).array().abs();
            seconds += (way / (machine.axes.max_feed_mm_per_min.array() / 60)).maxCoeff();
            at = rapid->to;
        } else if (const auto* cut = std::get_if<cam::path::MillCut>(&move.what)) {
            seconds += (cut->to - at).norm() / cut->feed.mm_per_s();
            at = cut->to;
        }
    }
    return seconds;
}

Json setup_json(const MillSheet& sheet) {
    const MillPlan& plan = *sheet.plan;
    Json json{{"version", 1},
              {"part", sheet.part_file},
              {"stock", box_json(plan.programs.front().stock)},
              {"tools", Json::array()},
              {"keep", Json::array()},
              {"setups", Json::array()}};
    for (const auto& tool : plan.tools) {
        json["tools"].push_back(tool_json(tool));
    }
    for (const auto& keep : plan.keeps) {
        json["keep"].push_back(box_json(keep.box));
    }
    for (std::size_t i = 0; i < plan.programs.size(); ++i) {
        const MillProgram& program = plan.programs[i];
        Json pose = Json::array();
        for (const double value : program.from_model.row_major()) {
            pose.push_back(value);
        }
        Json keepouts = Json::array();
        for (const auto& box : program.keep_outs) {
            keepouts.push_back(box_json(box));
        }
        json["setups"].push_back(
            {{"program", sheet.programs[i].name},
             {"dialect", sheet.setup->machine.dialect},
             {"initial_tool", 0},
             {"pose", pose},
             {"hold", program.hold == cam::path::Hold::Bottom ? "bottom" : "frame"},
             {"floor_z", program.floor_z},
             {"keepouts", keepouts}});
    }
    return json;
}

std::string sheet_html(const MillSheet& sheet) {
    const MillPlan& plan = *sheet.plan;
    std::string html =
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Set-up sheet</title>"
        "<style>body{font:11pt sans-serif;max-width:18cm;margin:1cm auto}table{border-collapse:"
        "collapse}td,th{border:1px solid #999;padding:2px 8px;text-align:left}h2{page-break-after:"
        "avoid}svg{display:block;margin:4mm 0}.w{background:#fde8c8;padding:2mm}</style>"
        "<h1>Set-up sheet: " +
        escaped(sheet.part_file) + "</h1><p>Machine: " + escaped(sheet.setup->machine.title) +
        "<br>Block: <b>" + size_text(plan.programs.front().stock.sizes()) + "</b>, " +
        escaped(sheet.material) + "</p>";
    if (!plan.dowels.empty()) {
        html += "<p>Two dowels of " + decimal(plan.dowels.front().diameter_mm, 0) +
                " mm in the border; their holes are bored first. The thickness of the block must "
                "be as said to a tenth of a millimetre: both zeros lie on its faces.</p>";
    }
    for (const std::string& warning : plan.warnings) {
        html += "<p class=\"w\">" + escaped(warning) + "</p>";
    }
    html +=
        "<h2>Tools</h2><table><tr><th>T</th><th>tool</th><th>diameter</th><th>stickout at "
        "least</th></tr>";
    for (const auto& tool : plan.tools) {
        html += "<tr><td>" + std::to_string(tool.number) + "</td><td>" + escaped(tool.title) +
                "</td><td>" + decimal(tool.diameter_mm, 2) + "</td><td>" +
                decimal(tool.stickout_mm, 1) + "</td></tr>";
    }
    html += "</table>";
    for (const std::string& note : sheet.notes) {
        html += "<p>" + escaped(note) + "</p>";
    }
    html += programs_html(sheet);
    html +=
        "<h2>Before the first cut</h2><ul><li>The block has the size above and is held."
        "<li>The zero is set as drawn; run the program once well above the block."
        "<li>Tools as listed, flutes sharp, stickout not shorter."
        "<li>Eyes and ears protected, a hand at the emergency stop.</ul></html>\n";
    return html;
}

}  // namespace tools
