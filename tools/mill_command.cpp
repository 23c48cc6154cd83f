// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/feeds/feeds.h"
#include "cam/mill/plan.h"
#include "cam/post/post_mill.h"
#include "cam/profile/read_mill.h"
#include "decomp/base/file.h"
#include "decomp/base/number.h"
#include "decomp/io/write_mesh.h"
#include "tools/check_input.h"
#include "tools/exit_code.h"
#include "tools/job_options.h"
#include "tools/mill_proof.h"
#include "tools/mill_report.h"
#include "tools/values.h"

#include <filesystem>
#include <memory>
#include <system_error>

namespace tools {

namespace {

namespace fs = std::filesystem;
using decomp::Result;
using decomp::Run;

struct Command {
    CheckRequest input;
    std::string material = "pine";
    std::string tools = "default";
    std::string stock = "box";
    std::string setups = "auto";
    double scallop_mm = 0.01;
    double lines_deg = 0;
    fs::path out;
    bool force = false;
};

std::vector<std::string> names_in(const std::string& list) {
    std::vector<std::string> names;
    if (list == "default") {
        return names;
    }
    std::size_t from = 0;
    while (from <= list.size()) {
        const std::size_t comma = std::min(list.find(',', from), list.size());
        names.push_back(list.substr(from, comma - from));
        from = comma + 1;
    }
    return names;
}

Result<cam::mill::MillTask> task_of(const Command& command, const cam::profile::MillSetup& setup,
                                    const cam::profile::MillMaterial& material,
                                    std::vector<std::string>& notes) {
    cam::mill::MillTask task;
    for (const auto& tool : setup.tools) {
        const cam::feeds::Feeds feeds = cam::feeds::feeds_for(tool, material, setup.machine);
        for (const std::string& note : feeds.notes) {
            notes.push_back(tool.name + ": " + note);
        }
        task.cutters.push_back({tool, feeds.values});
    }
    if (command.stock != "box") {
        const auto size = parse_size_mm(command.stock);
        if (!size) {
            return decomp::fail(size.error());
        }
        task.stock_mm = *size;
    }
    task.setups = command.setups == "1"   ? cam::mill::Setups::One
                  : command.setups == "2" ? cam::mill::Setups::Two
                                          : cam::mill::Setups::Auto;
    task.scallop_mm = command.scallop_mm;
    task.lines = decomp::Angle::degrees(command.lines_deg);
    return task;
}

/// Whether a program stays within the travel of its machine, wherever the zero is set.
decomp::Status fits(const cam::path::MillPlan& plan, const cam::profile::MillMachine& machine) {
    const Eigen::Vector3d travel = machine.travel.max_mm - machine.travel.min_mm;
    for (const auto& program : plan.programs) {
        const Eigen::Vector3d needed =
            program.stock.sizes() + Eigen::Vector3d(0, 0, program.safe_z - program.stock.max().z());
        if ((needed - travel).maxCoeff() > 0) {
            return decomp::fail(
                "mill.too_large",
                "the block needs " + decomp::decimal(needed.x(), 0) + " x " +
                    decomp::decimal(needed.y(), 0) + " x " + decomp::decimal(needed.z(), 0) +
                    " mm of travel, the machine has " + decomp::decimal(travel.x(), 0) + " x " +
                    decomp::decimal(travel.y(), 0) + " x " + decomp::decimal(travel.z(), 0) + " mm",
                machine.name, "cut the part smaller: hew decompose");
        }
    }
    return {};
}

Result<std::vector<MillFile>> written_programs(const Command& command,
                                               const cam::path::MillPlan& plan,
                                               const cam::profile::MillSetup& setup) {
    std::vector<MillFile> files;
    for (std::size_t i = 0; i < plan.programs.size(); ++i) {
        auto text = cam::post::post_mill(plan.programs[i], plan.tools, setup,
                                         command.out.stem().string() + " " + plan.programs[i].name);
        if (!text) {
            return decomp::fail(text.error());
        }
        std::string name = command.out.filename().string();
        if (plan.programs.size() > 1) {
            name = command.out.stem().string() + "-" + std::to_string(i + 1) + "-" +
                   plan.programs[i].name + command.out.extension().string();
        }
        files.push_back({std::move(name), std::move(*text)});
    }
    return files;
}

Result<std::vector<ProvedMilling>> proofs_of(const std::vector<MillFile>& programs,
                                             const cam::path::MillPlan& plan,
                                             const decomp::mesh::TriMesh& part,
                                             const cam::profile::MillSetup& setup, Run& run) {
    std::vector<ProvedMilling> proofs;
    proofs.reserve(programs.size());
    for (std::size_t i = 0; i < programs.size(); ++i) {
        auto proof = prove_milling(programs[i].text, plan, i, part, setup, run);
        if (!proof) {
            return decomp::fail(proof.error());
        }
        proofs.push_back(std::move(*proof));
    }
    return proofs;
}

/// What stands on a sheet beside its programs, by name.
void name_files(MillSheet& sheet, std::vector<MillFile> programs, const std::string& stem) {
    sheet.part_file = stem + ".part.stl";
    for (const MillFile& program : programs) {
        sheet.pictures.push_back(fs::path(program.name).stem().string() + ".stock.png");
    }
    sheet.programs = std::move(programs);
}

/// The programs and what is written beside them: the part as it was planned, proofs, the sheet.
std::vector<MillFile> all_files(const MillSheet& sheet, const std::vector<ProvedMilling>& proofs,
                                const decomp::mesh::TriMesh& part, const std::string& stem) {
    std::vector<MillFile> files = sheet.programs;
    files.push_back({sheet.part_file, decomp::io::stl_bytes(part)});
    for (std::size_t i = 0; i < proofs.size(); ++i) {
        const std::string& program = sheet.programs[i].name;
        files.push_back({program + ".proof.json", proofs[i].sidecar});
        files.push_back({fs::path(program).stem().string() + ".stock.ply", proofs[i].stock});
        files.push_back({sheet.pictures[i], proofs[i].picture});
    }
    files.push_back({"setup.json", setup_json(sheet).dump(1) + "\n"});
    files.push_back({stem + ".html", sheet_html(sheet)});
    return files;
}

decomp::Status refuse_existing(const fs::path& file) {
    if (fs::exists(file)) {
        return decomp::fail("file.exists", "the file exists already", file.string(),
                            "mill every part into a folder of its own, or add --force");
    }
    return {};
}

/// What every run writes, whatever the plan: known before an hour of planning.
decomp::Status refuse_earlier_run(const Command& command) {
    const fs::path directory = command.out.parent_path();
    const std::string stem = command.out.stem().string();
    for (const std::string& name :
         {std::string("setup.json"), stem + ".part.stl", stem + ".html"}) {
        if (auto free = refuse_existing(directory / name); !free) {
            return free;
        }
    }
    return {};
}

/// All or none where a file is in the way.
decomp::Status write_files(const fs::path& directory, const std::vector<MillFile>& files,
                           bool force) {
    for (const MillFile& file : files) {
        auto free = force ? decomp::Status{} : refuse_existing(directory / file.name);
        if (!free) {
            return free;
        }
    }
    std::error_code ignored;
    fs::create_directories(directory, ignored);
    for (const MillFile& file : files) {
        auto done = decomp::write_file(directory / file.name, file.text, decomp::Overwrite::Allow);
        if (!done) {
            return done;
        }
    }
    return {};
}

Answer answer_of(const MillSheet& sheet, const std::vector<ProvedMilling>& proofs,
                 const fs::path& directory) {
    Answer answer;
    answer.json["programs"] = Json::array();
    bool passed = true;
    for (std::size_t i = 0; i < proofs.size(); ++i) {
        Json figures = proofs[i].figures;
        figures["file"] = sheet.programs[i].name;
        answer.text += (directory / sheet.programs[i].name).string() + "  " +
                       duration_text(figures["seconds"].get<double>()) + "\n" + proofs[i].text;
        answer.json["programs"].push_back(std::move(figures));
        passed = passed && proofs[i].passed;
    }
    answer.json["warnings"] = sheet.plan->warnings;
    answer.json["proved"] = passed;
    answer.exit_code = passed ? kOk : kProofFailed;
    for (const std::string& warning : sheet.plan->warnings) {
        answer.text += "warning: " + warning + "\n";
    }
    return answer;
}

Result<Answer> mill(const Command& command, const Run& outer) {
    Run run = outer;
    const auto setup = cam::profile::read_mill_setup(command.input.machine, names_in(command.tools),
                                                     command.input.settings);
    if (!setup) {
        return decomp::fail(setup.error());
    }
    const auto material = cam::profile::read_mill_material(command.material);
    if (!material) {
        return decomp::fail(material.error());
    }
    if (!command.force) {
        if (const auto free = refuse_earlier_run(command); !free) {
            return decomp::fail(free.error());
        }
    }
    const auto input = read_check_input(command.input, run);
    if (!input) {
        return decomp::fail(input.error());
    }
    if (input->parts.size() != 1) {
        return decomp::fail("usage.part", "which part of the job?",
                            command.input.mesh.path.string(), "add --part P01");
    }
    MillSheet sheet;
    const auto task = task_of(command, *setup, *material, sheet.notes);
    if (!task) {
        return decomp::fail(task.error());
    }
    const auto plan = cam::mill::plan_milling(input->parts.front(), *task, run);
    if (!plan) {
        return decomp::fail(plan.error());
    }
    if (const auto fit = fits(*plan, setup->machine); !fit) {
        return decomp::fail(fit.error());
    }
    auto programs = written_programs(command, *plan, *setup);
    if (!programs) {
        return decomp::fail(programs.error());
    }
    const decomp::mesh::TriMesh& part = input->parts.front().mesh;
    const auto proofs = proofs_of(*programs, *plan, part, *setup, run);
    if (!proofs) {
        return decomp::fail(proofs.error());
    }
    const std::string stem = command.out.stem().string();
    sheet.plan = &*plan;
    sheet.setup = &*setup;
    sheet.material = material->title;
    name_files(sheet, std::move(*programs), stem);
    const fs::path directory = command.out.parent_path();
    const auto written =
        write_files(directory, all_files(sheet, *proofs, part, stem), command.force);
    if (!written) {
        return decomp::fail(written.error());
    }
    Answer answer = answer_of(sheet, *proofs, directory);
    answer.text += (directory / (stem + ".html")).string() + "  set-up sheet\n";
    return answer;
}

}  // namespace

Action declare_mill(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("input", command->input.mesh.path, "a mesh, or a job directory with --part")
        ->required();
    app.add_option("--part", command->input.part, "part of the job, e.g. P03");
    app.add_option("-o,--out", command->out,
                   "program to write; of two set-ups NAME-1-top and NAME-2-bottom")
        ->required();
    app.add_option("--machine", command->input.machine,
                   "mill: a name from 'hew machines', or a .toml file")
        ->required()
        ->group("Machine");
    app.add_option("--material", command->material, "what is milled")
        ->capture_default_str()
        ->group("Machine");
    app.add_option("--set", command->input.settings,
                   "change a value of the profile: KEY=VALUE, e.g. spindle.max_rpm=18000")
        ->allow_extra_args(false)
        ->group("Machine");
    app.add_option("--tools", command->tools,
                   "cutters in the order of use, e.g. flat-6,ball-3; default: the machine's own");
    app.add_option("--stock", command->stock,
                   "block at hand, e.g. 120x100x40mm; box: what the part needs");
    app.add_option("--setups", command->setups, "auto, 1, or 2 with a turn of the block")
        ->check(CLI::IsMember({"auto", "1", "2"}));
    app.add_option("--scallop", command->scallop_mm,
                   "ridges between the lines of finishing at most, mm")
        ->check(CLI::Range(0.001, 1.0));
    app.add_option("--lines", command->lines_deg, "direction of the lines of finishing, degrees");
    add_model_options(app, command->input.mesh.unit, command->input.mesh.scale,
                      command->input.mesh.up, command->input.mesh.height_mm);
    add_solid_options(app, command->input.mesh.body, command->input.mesh.deflection_mm,
                      command->input.mesh.angle_deg);
    app.add_flag("--force", command->force, "overwrite")->group("General");
    return [command](const Run& run) { return mill(*command, run); };
}

}  // namespace tools
