// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/lone_part.h"
#include "decomp/base/file.h"
#include "tools/exit_code.h"
#include "tools/job_options.h"
#include "tools/program_answer.h"

#include <algorithm>
#include <filesystem>
#include <memory>

namespace tools {

namespace {

namespace fs = std::filesystem;
using decomp::Result;
using decomp::Run;

struct Command {
    fs::path program;
    cam::job::MeshRequest part;
    std::string machine;
    std::string material;
    std::vector<std::string> settings;
    bool in_place = false;
    bool foreign = false;
};

Result<Answer> verify_lone(const Command& command, Run& run) {
    if (command.part.path.empty() || command.machine.empty()) {
        return decomp::fail("usage.verify", "a lone program needs --part and --machine",
                            command.program.string(),
                            "hew verify part.gcode --part part.stl --machine prusa-mk3s");
    }
    const auto setup =
        cam::profile::read_fdm_setup(command.machine, command.material, command.settings);
    if (!setup) {
        return decomp::fail(setup.error());
    }
    const auto program = decomp::read_file(command.program);
    if (!program) {
        return decomp::fail(program.error());
    }
    auto part = cam::job::read_lone_part(command.part, *setup, run);
    if (part && command.in_place) {
        auto solid = cam::job::read_solid(command.part, run);
        if (!solid) {
            return decomp::fail(solid.error());
        }
        *part = {part->id, std::move(*solid), Eigen::Vector2d::Zero(), {}};
    }
    if (!part) {
        return decomp::fail(part.error());
    }
    const auto proof = cam::verify::examine(*program, cam::job::placed_parts({*part}), *setup,
                                            {.strangers_program = command.foreign}, run);
    if (!proof) {
        return decomp::fail(proof.error());
    }
    return proof_answer(*proof);
}

/// Proves every plate of a job again.
Result<Answer> verify_job(const Command& command, Run& run) {
    const fs::path& directory = command.program;
    const auto job = cam::job::read_finished_job(directory);
    if (!job) {
        return decomp::fail(job.error());
    }
    const auto setup = cam::job::setup_of(*job, directory);
    if (!setup) {
        return decomp::fail(setup.error());
    }
    if (job->plates.empty()) {
        return decomp::fail("job.no_programs", "the job has no programs yet", directory.string(),
                            "run 'hew make' with the same options");
    }
    Answer answer;
    answer.json["plates"] = Json::array();
    for (const cam::job::PlateFacts& plate : job->plates) {
        const std::string name = cam::job::program_path(plate);
        const auto program = decomp::read_file(directory / name);
        if (!program) {
            return decomp::fail(program.error());
        }
        const auto parts = cam::job::job_plate(directory, *job, plate);
        if (!parts) {
            return decomp::fail(parts.error());
        }
        const auto proof =
            cam::verify::examine(*program, cam::job::placed_parts(*parts), *setup, {}, run);
        if (!proof) {
            return decomp::fail(proof.error());
        }
        Answer one = proof_answer(*proof);
        one.json["program"] = name;
        answer.json["plates"].push_back(std::move(one.json));
        answer.text += name + ": " + one.text;
        answer.exit_code = std::max(answer.exit_code, one.exit_code);
    }
    answer.json["passed"] = answer.exit_code == kOk;
    return answer;
}

}  // namespace

Action declare_verify(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("program", command->program, "G-code, or a job directory")->required();
    app.add_option("--part", command->part.path,
                   "mesh of the part; it stands in the middle of the bed");
    app.add_flag("--in-place", command->in_place,
                 "the mesh is already in the machine's coordinates");
    app.add_flag("--foreign", command->foreign,
                 "written by another slicer: unknown commands are notes, not faults");
    add_machine_options(app, command->machine, command->material, command->settings, false);
    add_model_options(app, command->part.unit, command->part.scale, command->part.up,
                      command->part.height_mm);
    add_solid_options(app, command->part.body, command->part.deflection_mm,
                      command->part.angle_deg);
    return [command](const Run& outer) {
        Run run = outer;
        return fs::is_directory(command->program) ? verify_job(*command, run)
                                                  : verify_lone(*command, run);
    };
}

}  // namespace tools
