// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/lone_part.h"
#include "decomp/base/file.h"
#include "decomp/base/number.h"
#include "tools/exit_code.h"
#include "tools/job_options.h"
#include "tools/program_answer.h"
#include "tools/values.h"

#include <filesystem>
#include <memory>

namespace tools {

namespace {

namespace fs = std::filesystem;
using decomp::Result;
using decomp::Run;

struct Command {
    cam::job::MeshRequest mesh;
    std::string part;
    std::string machine;
    std::string material;
    std::vector<std::string> settings;
    fs::path out;
    bool dry_run = false;
    bool force = false;
};

/// The part on its plate, its profile and where the program goes.
struct Task {
    cam::job::PartOnPlate part;
    cam::profile::FdmSetup setup;
    fs::path program;
};

Result<Task> task_of_job(const Command& command) {
    if (command.part.empty()) {
        return decomp::fail("usage.part", "which part of the job?", command.mesh.path.string(),
                            "add --part P01; the programs of whole plates are made by 'hew make'");
    }
    const auto job = cam::job::read_finished_job(command.mesh.path);
    if (!job) {
        return decomp::fail(job.error());
    }
    auto setup = cam::job::setup_of(*job, command.mesh.path);
    if (!setup) {
        return decomp::fail(setup.error());
    }
    auto part = cam::job::job_part(command.mesh.path, *job, command.part,
                                   cam::job::middle_of_bed(setup->machine));
    if (!part) {
        return decomp::fail(part.error());
    }
    const fs::path program = command.out.empty()
                                 ? command.mesh.path / "programs" / (command.part + ".gcode")
                                 : command.out;
    return Task{std::move(*part), std::move(*setup), program};
}

Result<Task> task_of_mesh(const Command& command, Run& run) {
    if (command.machine.empty() || command.out.empty()) {
        return decomp::fail("usage.slice", "a lone mesh needs --machine and -o",
                            command.mesh.path.string(),
                            "hew slice part.stl --machine prusa-mk3s -o part.gcode");
    }
    auto setup = cam::profile::read_fdm_setup(command.machine, command.material, command.settings);
    if (!setup) {
        return decomp::fail(setup.error());
    }
    auto part = cam::job::read_lone_part(command.mesh, *setup, run);
    if (!part) {
        return decomp::fail(part.error());
    }
    return Task{std::move(*part), std::move(*setup), command.out};
}

Result<Answer> slice(const Command& command, const Run& outer) {
    Run run = outer;
    auto task =
        fs::is_directory(command.mesh.path) ? task_of_job(command) : task_of_mesh(command, run);
    if (!task) {
        return decomp::fail(task.error());
    }
    const fs::path sidecar = cam::job::sidecar_path(task->program.string());
    if (!command.force && !command.dry_run && fs::exists(task->program)) {
        return decomp::fail("file.exists", "the file exists already", task->program.string(),
                            "choose another name, or add --force");
    }
    const auto proved = cam::job::slice_and_prove({task->part}, task->setup, task->part.id, run);
    if (!proved) {
        return decomp::fail(proved.error());
    }
    if (!command.dry_run) {
        std::error_code ignored;
        fs::create_directories(task->program.parent_path(), ignored);
        for (const auto& [path, text] :
             {std::pair(task->program, &proved->text), std::pair(sidecar, &proved->sidecar)}) {
            if (const auto written = decomp::write_file(path, *text, decomp::Overwrite::Allow);
                !written) {
                return decomp::fail(written.error());
            }
        }
    }
    Answer answer = proof_answer(proved->proof);
    answer.json["program"] = command.dry_run ? "" : task->program.string();
    answer.json["seconds"] = proved->facts.seconds;
    answer.json["filament_mm"] = proved->facts.filament_mm;
    answer.json["filament_g"] = proved->facts.filament_g;
    answer.json["bytes"] = proved->text.size();
    answer.text =
        (command.dry_run ? "nothing was written: this was a dry run" : task->program.string()) +
        "\n" + duration_text(proved->facts.seconds) + ", " +
        decomp::decimal(proved->facts.filament_g, 1) + " g\n" + answer.text;
    return answer;
}

}  // namespace

Action declare_slice(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("input", command->mesh.path,
                   "a job directory, or a mesh that stands as it is printed")
        ->required();
    app.add_option("--part", command->part, "part of the job, e.g. P03");
    app.add_option("-o,--out", command->out,
                   "program to write; of a job: programs/PART.gcode in it");
    add_machine_options(app, command->machine, command->material, command->settings, false);
    add_model_options(app, command->mesh.unit, command->mesh.scale, command->mesh.up,
                      command->mesh.height_mm);
    add_solid_options(app, command->mesh.body, command->mesh.deflection_mm,
                      command->mesh.angle_deg);
    app.add_flag("--dry-run", command->dry_run, "plan and prove, write nothing")->group("General");
    app.add_flag("--force", command->force, "overwrite")->group("General");
    return [command](const Run& run) { return slice(*command, run); };
}

}  // namespace tools
