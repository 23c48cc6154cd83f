// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/lone_part.h"
#include "cam/render/render.h"
#include "decomp/base/file.h"
#include "decomp/base/number.h"
#include "tools/exit_code.h"
#include "tools/job_options.h"
#include "tools/program_answer.h"
#include "tools/values.h"

#include <charconv>
#include <filesystem>
#include <memory>
#include <system_error>

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
    std::string picture;
    fs::path picture_file;
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

/// The layers that `--png` names: a number, or a sheet of several.
Result<std::vector<std::size_t>> layers_to_draw(const std::string& word,
                                                const cam::path::LayerStack& stack) {
    constexpr std::size_t kOnSheet = 12;
    if (word == "sheet") {
        return cam::render::spread_layers(stack, kOnSheet);
    }
    std::size_t number = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (fault != std::errc() || end != word.data() + word.size() || number < 1 ||
        number > stack.layers.size()) {
        return decomp::fail(
            "usage.layer", "there is no layer '" + word + "' to draw", {},
            "say 'sheet', or a layer from 1 to " + std::to_string(stack.layers.size()));
    }
    return std::vector<std::size_t>{number - 1};
}

/// Where the picture goes: where it is told to, else beside the program.
fs::path picture_path(const Command& command, const fs::path& program) {
    return command.picture_file.empty() ? fs::path(program).replace_extension(".png")
                                        : command.picture_file;
}

Result<std::string> draw(const Command& command, const cam::path::LayerStack& stack, Run& run) {
    const auto chosen = layers_to_draw(command.picture, stack);
    if (!chosen) {
        return decomp::fail(chosen.error());
    }
    return chosen->size() == 1
               ? cam::render::render_layer_png(stack.layers[chosen->front()], {}, run)
               : cam::render::render_layers_png(stack, *chosen, {}, run);
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
    const fs::path picture = picture_path(command, task->program);
    if (!command.picture.empty() && !command.force && !command.dry_run && fs::exists(picture)) {
        return decomp::fail("file.exists", "the file exists already", picture.string(),
                            "choose another name, or add --force");
    }
    const auto proved = cam::job::slice_and_prove({task->part}, task->setup, task->part.id, run);
    if (!proved) {
        return decomp::fail(proved.error());
    }
    std::vector<std::pair<fs::path, std::string>> files{{task->program, proved->text},
                                                        {sidecar, proved->sidecar}};
    if (!command.picture.empty()) {
        auto png = draw(command, proved->layers, run);
        if (!png) {
            return decomp::fail(png.error());
        }
        files.emplace_back(picture, std::move(*png));
    }
    if (!command.dry_run) {
        std::error_code ignored;
        fs::create_directories(task->program.parent_path(), ignored);
        for (const auto& [path, bytes] : files) {
            if (const auto written = decomp::write_file(path, bytes, decomp::Overwrite::Allow);
                !written) {
                return decomp::fail(written.error());
            }
        }
    }
    Answer answer = proof_answer(proved->proof);
    answer.json["program"] = command.dry_run ? "" : task->program.string();
    answer.json["picture"] = command.picture.empty() ? "" : picture.string();
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
    app.add_option("--png", command->picture,
                   "draw the beads of this layer, or 'sheet': twelve layers from bottom to top");
    app.add_option("--png-out", command->picture_file,
                   "picture to write; default: beside the program");
    app.add_flag("--dry-run", command->dry_run, "plan and prove, write nothing")->group("General");
    app.add_flag("--force", command->force, "overwrite")->group("General");
    return [command](const Run& run) { return slice(*command, run); };
}

}  // namespace tools
