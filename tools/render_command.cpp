// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/lone_part.h"
#include "cam/render/render.h"
#include "decomp/base/file.h"
#include "tools/job_options.h"

#include <filesystem>
#include <memory>

namespace tools {

namespace {

namespace fs = std::filesystem;
namespace render = cam::render;
using decomp::Result;
using decomp::Run;

struct Command {
    cam::job::MeshRequest mesh;
    fs::path out;
    std::string view = "iso";
    double explode = 0.3;
    std::string part;
    std::size_t layers = 0;
    std::string machine;
    std::string material;
    std::vector<std::string> settings;
    int width_px = 1200;
    int height_px = 900;
    bool force = false;
};

Result<std::string> draw_layers(const Command& command, Run& run) {
    cam::job::PartOnPlate part;
    cam::profile::FdmSetup setup;
    if (fs::is_directory(command.mesh.path)) {
        const auto job = cam::job::read_finished_job(command.mesh.path);
        if (!job) {
            return decomp::fail(job.error());
        }
        auto known = cam::job::setup_of(*job, command.mesh.path);
        if (!known) {
            return decomp::fail(known.error());
        }
        setup = std::move(*known);
        const std::string id =
            command.part.empty() && !job->parts.empty() ? job->parts.front().id : command.part;
        auto read =
            cam::job::job_part(command.mesh.path, *job, id, cam::job::middle_of_bed(setup.machine));
        if (!read) {
            return decomp::fail(read.error());
        }
        part = std::move(*read);
    } else {
        if (command.machine.empty()) {
            return decomp::fail("usage.machine_needed", "the layers of a lone mesh need --machine",
                                command.mesh.path.string(),
                                "hew render part.stl --layers 6 --machine prusa-mk3s -o l.png");
        }
        auto known =
            cam::profile::read_fdm_setup(command.machine, command.material, command.settings);
        if (!known) {
            return decomp::fail(known.error());
        }
        setup = std::move(*known);
        auto read = cam::job::read_lone_part(command.mesh, setup, run);
        if (!read) {
            return decomp::fail(read.error());
        }
        part = std::move(*read);
    }
    const auto stack = cam::job::plan_plate({part}, setup, run);
    if (!stack) {
        return decomp::fail(stack.error());
    }
    return render::render_layers_png(*stack, render::spread_layers(*stack, command.layers),
                                     {.width_px = command.width_px, .height_px = command.height_px},
                                     run);
}

Result<std::string> draw(const Command& command, Run& run) {
    const auto view = render::view_named(command.view);
    if (!view) {
        return decomp::fail(view.error());
    }
    if (command.layers > 0) {
        return draw_layers(command, run);
    }
    const render::ViewOptions options{
        .view = *view, .width_px = command.width_px, .height_px = command.height_px};
    if (!fs::is_directory(command.mesh.path)) {
        const auto mesh = cam::job::read_drawable(command.mesh, run);
        if (!mesh) {
            return decomp::fail(mesh.error());
        }
        render::Item item;
        item.mesh = &*mesh;
        return render::render_meshes_png({item}, options, run);
    }
    const auto job = cam::job::read_finished_job(command.mesh.path);
    if (!job) {
        return decomp::fail(job.error());
    }
    const auto assembly = cam::job::read_assembly(command.mesh.path, *job);
    if (!assembly) {
        return decomp::fail(assembly.error());
    }
    return render::render_meshes_png(render::explode(*assembly, command.explode), options, run);
}

Result<Answer> run_render(const Command& command, const Run& outer) {
    Run run = outer;
    const auto png = draw(command, run);
    if (!png) {
        return decomp::fail(png.error());
    }
    const auto written = decomp::write_file(
        command.out, *png, command.force ? decomp::Overwrite::Allow : decomp::Overwrite::Refuse);
    if (!written) {
        return decomp::fail(written.error());
    }
    Answer answer;
    answer.json = {{"file", command.out.string()}, {"bytes", png->size()}};
    answer.text = command.out.string() + "\n";
    return answer;
}

}  // namespace

Action declare_render(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("input", command->mesh.path, "a job directory, or a mesh")->required();
    app.add_option("-o,--out", command->out, "PNG to write")->required();
    app.add_option("--view", command->view, "where the viewer stands")
        ->check(CLI::IsMember({"iso", "under", "front", "back", "left", "right", "top", "bottom"}))
        ->capture_default_str();
    app.add_option("--explode", command->explode, "how far the parts of a job move apart")
        ->check(CLI::Range(0.0, 5.0))
        ->capture_default_str();
    app.add_option("--layers", command->layers, "draw this many layers of a part instead")
        ->check(CLI::Range(1, 64));
    app.add_option("--part", command->part,
                   "part of the job whose layers are drawn; default: the first");
    app.add_option("--size-x", command->width_px, "width, pixels")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    app.add_option("--size-y", command->height_px, "height, pixels")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    add_machine_options(app, command->machine, command->material, command->settings, false);
    add_model_options(app, command->mesh.unit, command->mesh.scale, command->mesh.up,
                      command->mesh.height_mm);
    add_solid_options(app, command->mesh.body, command->mesh.deflection_mm,
                      command->mesh.angle_deg);
    app.add_flag("--force", command->force, "overwrite")->group("General");
    return [command](const Run& run) { return run_render(*command, run); };
}

}  // namespace tools
