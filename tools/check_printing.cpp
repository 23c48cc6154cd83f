// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/choose_build.h"
#include "cam/profile/read_profile.h"
#include "decomp/mesh/measure.h"
#include "tools/check_pictures.h"
#include "tools/check_report.h"
#include "tools/exit_code.h"

#include <array>

namespace tools {

namespace {

using cam::check::FdmCheck;
using cam::check::FdmPose;
using decomp::Result;
using decomp::Run;

constexpr std::array<const char*, 6> kAxes{"z", "-z", "x", "-x", "y", "-y"};

struct Printer {
    cam::check::FdmOptions options;
    std::optional<cam::profile::FdmMachine> machine;
};

Result<Printer> printer_of(const CheckRequest& request) {
    Printer printer;
    if (request.machine.empty()) {
        return printer;
    }
    const auto setup = cam::profile::read_fdm_setup(request.machine, "", request.settings);
    if (!setup) {
        return decomp::fail(setup.error());
    }
    printer.machine = setup->machine;
    printer.options = cam::check::fdm_options(setup->machine);
    return printer;
}

Json pose_json(const FdmPose& pose) {
    return {{"down", vector_json(pose.down)},        {"on_flat", pose.on_flat},
            {"on_cut_face", pose.on_cut_face},       {"plane", pose.plane},
            {"overhang", share_json(pose.overhang)}, {"support", share_json(pose.support)},
            {"bridges", share_json(pose.bridges)},   {"islands", share_json(pose.islands)},
            {"plate", share_json(pose.plate)}};
}

std::string base_text(const FdmPose& pose) {
    if (pose.on_cut_face) {
        return "plane " + std::to_string(pose.plane);
    }
    return (pose.on_flat ? "flat " : "axis ") + direction_text(pose.down);
}

/// Sums over parts, for the columns of a whole partition.
struct Sums {
    double area = 0;
    double overhang = 0;
    double support = 0;

    [[nodiscard]] static double percent(double part, double of) {
        return of > 0 ? 100 * part / of : 0;
    }
};

void add_whole(Answer& answer, const CheckInput& input, const Printer& printer) {
    const auto poses = cam::check::check_axes(*input.whole, printer.options);
    TextTable table({"whole, up", "%3DPST", "support", "bridges", "islands", "plate", "by facets"});
    Json axes = Json::array();
    std::size_t best = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const FdmPose& pose = poses.at(i);
        best = pose.overhang.by_area_percent < poses.at(best).overhang.by_area_percent ? i : best;
        table.add(
            {kAxes.at(i), percent_text(pose.overhang.by_area_percent),
             percent_text(pose.support.by_area_percent), percent_text(pose.bridges.by_area_percent),
             percent_text(pose.islands.by_area_percent), percent_text(pose.plate.by_area_percent),
             percent_text(pose.overhang.by_facets_percent)});
        Json row = pose_json(pose);
        row["up"] = kAxes.at(i);
        axes.push_back(row);
    }
    answer.json["whole"] = {{"area_mm2", decomp::mesh::area_mm2(*input.whole)},
                            {"3DPST",
                             {{"paper_percent", poses[0].overhang.by_area_percent},
                              {"support_percent", poses[0].support.by_area_percent},
                              {"by_facets_percent", poses[0].overhang.by_facets_percent},
                              {"best_of_six_percent", poses.at(best).overhang.by_area_percent},
                              {"best_up", kAxes.at(best)}}},
                            {"axes", axes}};
    answer.text += table.text() + "\n";
}

Json part_json(const decomp::part::Part& part, const FdmCheck& check) {
    const FdmPose& best = check.poses[check.best];
    return {{"id", part.id},
            {"facets", part.mesh.triangles.size()},
            {"area_mm2", decomp::mesh::area_mm2(part.mesh)},
            {"3DPPS",
             {{"paper_percent", check.poses[check.best_by_normal].overhang.by_area_percent},
              {"support_percent", best.support.by_area_percent},
              {"by_facets_percent", check.poses[check.best_by_facets].overhang.by_facets_percent}}},
            {"best", pose_json(best)},
            {"poses_tried", check.poses.size()}};
}

std::vector<std::string> part_row(const decomp::part::Part& part, const FdmCheck& check,
                                  const std::string& fits) {
    const FdmPose& best = check.poses[check.best];
    return {part.id,
            std::to_string(part.mesh.triangles.size()),
            percent_text(check.poses[check.best_by_normal].overhang.by_area_percent),
            percent_text(best.support.by_area_percent),
            percent_text(best.bridges.by_area_percent),
            percent_text(best.islands.by_area_percent),
            percent_text(best.plate.by_area_percent),
            percent_text(check.poses[check.best_by_facets].overhang.by_facets_percent),
            base_text(best),
            fits};
}

/// What the parts come to together.
void add_sums(Answer& answer, const CheckInput& input, const Sums& sums) {
    const double paper = Sums::percent(sums.overhang, sums.area);
    const double support = Sums::percent(sums.support, sums.area);
    Json all{{"paper_percent", paper}, {"support_percent", support}};
    if (input.whole) {
        all["of_whole_area_percent"] =
            Sums::percent(sums.support, decomp::mesh::area_mm2(*input.whole));
    }
    answer.json["3DPPST"] = all;
    answer.text += "\n%3DPPST " + percent_text(paper) + ", support " + percent_text(support) + "\n";
}

}  // namespace

Result<Answer> check_printing(const CheckRequest& request, const CheckInput& input, Run& run) {
    const auto printer = printer_of(request);
    if (!printer) {
        return decomp::fail(printer.error());
    }
    Answer answer;
    answer.json["process"] = "fdm";
    answer.json["machine"] = request.machine;
    answer.json["support_angle_deg"] = printer->options.support_angle.degrees();
    answer.json["longest_bridge_mm"] = printer->options.hanging.longest_bridge_mm;
    if (input.whole) {
        add_whole(answer, input, *printer);
    }
    TextTable table({"part", "facets", "%3DPPS", "support", "bridges", "islands", "plate",
                     "by facets", "base", "fits"});
    Sums sums;
    bool all_fit = true;
    Json parts = Json::array();
    for (std::size_t i = 0; i < input.parts.size(); ++i) {
        const auto& part = input.parts[i];
        const FdmCheck check = cam::check::check_fdm(part, printer->options);
        if (run.cancelled()) {
            return decomp::cancelled();
        }
        const FdmPose& best = check.poses[check.best];
        Json json = part_json(part, check);
        std::string fits = "-";
        if (printer->machine) {
            const bool fit = cam::orient::rank_builds(part, *printer->machine).front().fits();
            json["fits"] = fit;
            fits = fit ? "yes" : "no";
            all_fit = all_fit && fit;
        }
        sums.area += decomp::mesh::area_mm2(part.mesh);
        sums.overhang += check.poses[check.best_by_normal].overhang.area_mm2;
        sums.support += best.support.area_mm2;
        table.add(part_row(part, check, fits));
        if (const auto drawn = draw_printing(request, part, best.down, printer->options, run);
            !drawn) {
            return decomp::fail(drawn.error());
        }
        parts.push_back(json);
        run.progress("check", static_cast<double>(i + 1) / static_cast<double>(input.parts.size()));
    }
    answer.json["parts"] = parts;
    answer.text += table.text();
    add_sums(answer, input, sums);
    answer.exit_code = all_fit ? kOk : kInfeasible;
    return answer;
}

}  // namespace tools
