// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/job_options.h"

#include "cam/job/report.h"
#include "decomp/base/number.h"
#include "decomp/plan/edit.h"
#include "tools/exit_code.h"
#include "tools/values.h"

#include <algorithm>
#include <map>

namespace tools {

namespace {

struct JobCommand {
    cam::job::MakeRequest request;
    bool dry_run = false;
};

Json extent_json(const Eigen::Vector3d& extent) { return {extent.x(), extent.y(), extent.z()}; }

std::string extent_text(const Eigen::Vector3d& extent) {
    return decomp::decimal(extent.x(), 1) + " x " + decomp::decimal(extent.y(), 1) + " x " +
           decomp::decimal(extent.z(), 1) + " mm";
}

Answer dry_run_answer(const cam::job::MakePlan& plan) {
    Answer answer;
    answer.json["dry_run"] = true;
    answer.json["input"] = plan.input.name;
    answer.json["machine"] = plan.options.machine;
    answer.json["material"] = plan.options.material;
    answer.json["extent_mm"] = extent_json(plan.extent_mm);
    answer.json["chamber_mm"] = extent_json(plan.chamber_mm);
    answer.json["blocks"] = plan.blocks;
    answer.json["kept_stages"] = plan.kept;
    answer.json["complete"] = plan.complete;
    answer.text = plan.input.name + ": " + extent_text(plan.extent_mm) + "\n" +
                  plan.options.machine + ", " + plan.options.material + ": holds " +
                  extent_text(plan.chamber_mm) + "\n" + "about " + std::to_string(plan.blocks) +
                  " parts\n";
    for (const std::string& stage : plan.kept) {
        answer.text += "kept from the earlier run: " + stage + "\n";
    }
    answer.text +=
        plan.complete ? "nothing is left to do\n" : "nothing was written: this was a dry run\n";
    return answer;
}

std::string parts_text(const cam::job::JobFile& job) {
    std::string text;
    for (const auto& part : job.parts) {
        text += "  " + part.id + "  " + extent_text(part.extent_mm) + ", " +
                decomp::decimal(part.volume_mm3 / 1000, 1) + " cm3, stands on " + part.base + "\n";
    }
    return text;
}

std::string plates_text(const cam::job::JobFile& job) {
    std::string text;
    for (const auto& plate : job.plates) {
        text += "  " + cam::job::program_path(plate) + "  ";
        for (const auto& placed : plate.parts) {
            text += placed.id + " ";
        }
        text += " " + duration_text(plate.program.seconds) + ", " +
                decomp::decimal(plate.program.filament_g, 1) + " g, " +
                (plate.proof.passed ? "proved" : "NOT PROVED: " + plate.proof.first_fault) + "\n";
    }
    return text;
}

Answer made_answer(const cam::job::MakeResult& result, const cam::job::MakeRequest& request) {
    const cam::job::JobFile& job = result.job;
    const cam::job::Totals totals = cam::job::totals_of(job);
    const bool programs = request.extent == cam::job::Extent::Programs;
    const auto kept = std::count_if(result.timings.begin(), result.timings.end(),
                                    [](const auto& t) { return t.kept; });
    Answer answer;
    answer.exit_code = programs && !totals.passed ? kProofFailed : kOk;
    answer.json = job_summary(job);
    answer.json["directory"] = request.directory.string();
    answer.json["stages"] = result.timings.size();
    answer.json["stages_kept"] = kept;
    answer.text = std::to_string(totals.parts) + (totals.parts == 1 ? " part" : " parts") +
                  ", repair: " + job.model.repair_status +
                  ", decomposition: " + job.decomposition.tier + "\n" + parts_text(job);
    if (programs) {
        answer.text += std::to_string(totals.plates) +
                       (totals.plates == 1 ? " plate, " : " plates, ") +
                       duration_text(totals.seconds) + ", " +
                       decomp::decimal(totals.filament_g, 0) + " g\n" + plates_text(job);
    }
    answer.text += "report: " + (request.directory / "report.json").string() +
                   "\npicture: " + (request.directory / "parts.png").string() + "\n";
    return answer;
}

decomp::Result<Answer> run_job(const JobCommand& command, const decomp::Run& outer) {
    decomp::Run run = outer;
    cam::job::MakeRequest request = command.request;
    request.options.seed = run.seed;
    if (command.dry_run) {
        const auto plan = cam::job::plan_make(request, run);
        if (!plan) {
            return decomp::fail(plan.error());
        }
        return dry_run_answer(*plan);
    }
    const auto made = cam::job::make(request, run);
    if (!made) {
        return decomp::fail(made.error());
    }
    return made_answer(*made, request);
}

}  // namespace

void add_model_options(CLI::App& app, std::string& unit, double& scale, std::string& up,
                       std::optional<double>& height_mm) {
    app.add_option("--unit", unit,
                   "length unit of the file: mm, cm, m, in; default: what the file says, or mm")
        ->group("Model");
    app.add_option("--scale", scale, "factor on all lengths of the file")
        ->check(CLI::PositiveNumber)
        ->group("Model");
    app.add_option("--up", up, "axis of the file that points up: x, -x, y, -y, z, -z or auto")
        ->check(CLI::IsMember({"x", "-x", "y", "-y", "z", "-z", "auto"}))
        ->capture_default_str()
        ->group("Model");
    add_length(app, "--height", height_mm,
               "scale so that the extent along up is this: 245mm, 24.5cm, 9.6in")
        ->group("Model");
}

void add_solid_options(CLI::App& app, std::string& body, std::optional<double>& deflection_mm,
                       double& angle_deg) {
    app.add_option("--body", body, "of a STEP or BREP file: the body wanted, or all")
        ->group("Model");
    add_length(app, "--deflection", deflection_mm,
               "of a STEP or BREP file: chord error at most; default: by its size")
        ->group("Model");
    app.add_option("--angle", angle_deg,
                   "of a STEP or BREP file: turn between chords at most, degrees")
        ->check(CLI::Range(1.0, 60.0))
        ->capture_default_str()
        ->group("Model");
}

void add_step_options(CLI::App& app, cam::job::StepWish& wish) {
    auto* step = app.add_flag("--step", wish.wanted, "the parts as STEP solids, in step/");
    step->group("STEP");
    add_length(app, "--step-tol", wish.tolerance_mm,
               "how far a solid may leave its part; default: 0.05 mm")
        ->group("STEP");
    app.add_option("--step-schema", wish.schema, "ap203 (no colours), ap214 or ap242")
        ->check(CLI::IsMember({"ap203", "ap214", "ap242"}))
        ->capture_default_str()
        ->group("STEP");
    app.add_flag("--step-many", wish.many_faces,
                 "write a solid even where it needs more than 6000 faces")
        ->group("STEP");
    add_length(app, "--step-stock", wish.stock_mm,
               "the stock as a body beside each part: so much larger on its sides and on top")
        ->needs(step)
        ->group("STEP");
    app.add_option("--step-fixture", wish.fixtures,
                   "a model of vise, clamps or table as a further body; z = 0 is under the part")
        ->allow_extra_args(false)
        ->type_name("FILE")
        ->transform(
            [](const std::string& file) { return std::filesystem::absolute(file).string(); })
        ->needs(step)
        ->group("STEP");
}

void add_hand_options(CLI::App& app, cam::job::JobOptions& options) {
    const auto add = [&app](const std::string& verb, const std::string& type,
                            const std::string& description) {
        const auto check = [verb](const std::string& value) {
            const auto edit = decomp::plan::parse_edit(verb + " " + value);
            return edit ? std::string() : edit.error().message + "; " + edit.error().hint;
        };
        app.add_option("--" + verb)
            ->description(description)
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
            ->allow_extra_args(false)
            ->check(CLI::Validator(check, ""))
            ->type_name(type)
            ->group("By hand, in the order given; names of parts are those without these options");
    };
    add("split", "PART:AXIS=SHARE",
        "cut a part where a share of its extent lies below, e.g. P03:z=0.5; along the axes of the "
        "polycube if the parts come from one, else of the model. Its pieces are P03.1, P03.2");
    add("merge", "PART+PART",
        "make one part of neighbours, e.g. P02+P05; it keeps the first one's name");
    add("plane", "\"NX NY NZ D\"",
        "cut every part that a plane meets: its normal, and its distance from the origin along it "
        "in mm, in the model frame");
    app.add_option("--plan", options.plan,
                   "cut as a plan.toml says, that of an earlier job or a changed one")
        ->group("Parts");
}

void take_edits(const CLI::App& app, cam::job::JobOptions& options) {
    std::map<const CLI::Option*, std::size_t> taken;
    for (const CLI::Option* option : app.parse_order()) {
        const std::string name = option->get_name().substr(2);
        if (name == "split" || name == "merge" || name == "plane") {
            options.edits.push_back(name + " " + option->results().at(taken[option]++));
        }
    }
}

void add_machine_options(CLI::App& app, std::string& machine, std::string& material,
                         std::vector<std::string>& settings, bool required) {
    app.add_option("--machine", machine, "profile: a name from 'hew machines', or a .toml file")
        ->required(required)
        ->group("Machine");
    app.add_option("--material", material, "filament profile; default: the machine's own")
        ->group("Machine");
    app.add_option("--set", settings,
                   "change a value of the profile: KEY=VALUE, e.g. process.layer_height_mm=0.15")
        ->allow_extra_args(false)
        ->group("Machine");
}

Action declare_job(CLI::App& app, const Common& /*common*/, cam::job::Extent extent) {
    auto command = std::make_shared<JobCommand>();
    cam::job::MakeRequest& request = command->request;
    request.extent = extent;
    app.add_option("model", request.model, "STL, OBJ, OFF, PLY, 3MF, Medit .mesh, STEP or BREP")
        ->required();
    app.add_option("-o,--out", request.directory, "directory of the job; made when absent")
        ->required();
    add_machine_options(app, request.options.machine, request.options.material,
                        request.options.settings, true);
    add_model_options(app, request.options.unit, request.options.scale, request.options.up,
                      request.options.height_mm);
    add_solid_options(app, request.options.body, request.options.deflection_mm,
                      request.options.angle_deg);
    add_step_options(app, request.options.step);
    app.add_option("--max-parts", request.options.max_parts, "give up beyond this number of parts")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str()
        ->group("Parts");
    app.add_option("--mode", request.options.mode,
                   "where cuts come from: sheets (of a polycube), paper, or sections")
        ->check(CLI::IsMember({"sheets", "paper", "sections"}))
        ->capture_default_str()
        ->group("Parts");
    app.add_option("--polycube", request.options.polycube,
                   "polycube of the model: two files of tets, SHAPE POLYCUBE (Medit or VTK)")
        ->expected(2)
        ->group("Parts");
    app.add_option("--sweep", request.options.sweep,
                   "how far planes at concave edges of the polycube reach: local or global")
        ->check(CLI::IsMember({"local", "global"}))
        ->capture_default_str()
        ->group("Parts");
    app.add_flag("--boxes", request.options.boxes,
                 "keep every box of the polycube as a part, also where fewer would do")
        ->group("Parts");
    add_size(app, "--max-size", request.options.max_size_mm,
             "largest part as it stands: 100x100x80mm; smaller than the chamber")
        ->group("Parts");
    add_hand_options(app, request.options);
    app.add_flag("--dry-run", command->dry_run, "say what would be done, write nothing")
        ->group("General");
    app.add_flag("--force", request.force,
                 "write into a directory that holds other things, or another model's job")
        ->group("General");
    return [command, &app](const decomp::Run& run) {
        take_edits(app, command->request.options);
        return run_job(*command, run);
    };
}

Json job_summary(const cam::job::JobFile& job) {
    const cam::job::Totals totals = cam::job::totals_of(job);
    Json json;
    json["repair"] = job.model.repair_status;
    json["tier"] = job.decomposition.tier;
    json["parts"] = Json::array();
    for (const auto& part : job.parts) {
        json["parts"].push_back(
            {{"id", part.id}, {"extent_mm", extent_json(part.extent_mm)}, {"base", part.base}});
    }
    json["plates"] = Json::array();
    for (const auto& plate : job.plates) {
        Json parts = Json::array();
        for (const auto& placed : plate.parts) {
            parts.push_back(placed.id);
        }
        json["plates"].push_back({{"program", cam::job::program_path(plate)},
                                  {"parts", parts},
                                  {"seconds", plate.program.seconds},
                                  {"filament_g", plate.program.filament_g},
                                  {"passed", plate.proof.passed},
                                  {"first_fault", plate.proof.first_fault}});
    }
    json["totals"] = {{"parts", totals.parts},
                      {"plates", totals.plates},
                      {"seconds", totals.seconds},
                      {"filament_g", totals.filament_g},
                      {"passed", totals.passed}};
    return json;
}

}  // namespace tools
