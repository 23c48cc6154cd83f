// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/check_input.h"
#include "tools/check_report.h"
#include "tools/job_options.h"

#include <memory>

namespace tools {

namespace {

decomp::Result<Answer> run_check(const CheckRequest& request, const decomp::Run& outer) {
    decomp::Run run = outer;
    const auto input = read_check_input(request, run);
    if (!input) {
        return decomp::fail(input.error());
    }
    for (const auto& directory : {request.out, request.drop}) {
        std::error_code failed;
        if (!directory.empty()) {
            std::filesystem::create_directories(directory, failed);
        }
        if (failed) {
            return decomp::fail("file.unwritable", failed.message(), directory.string());
        }
    }
    if (request.process == "fdm") {
        return check_printing(request, *input, run);
    }
    return request.process == "mill3" ? check_three_axes(request, *input, run)
                                      : check_four_axes(request, *input, run);
}

}  // namespace

Action declare_check(CLI::App& app, const Common& /*common*/) {
    auto request = std::make_shared<CheckRequest>();
    app.add_option("input", request->mesh.path, "a job directory, or a mesh")->required();
    app.add_option("--process", request->process, "how it is to be made")
        ->required()
        ->check(CLI::IsMember({"fdm", "mill3", "mill4"}));
    app.add_option("--part", request->part, "this part of a job only");
    app.add_option("-o,--out", request->out,
                   "directory for a picture and a coloured mesh of each part");
    app.add_option("--view", request->view,
                   "where the viewer stands; default: under for fdm, else iso")
        ->check(CLI::IsMember({"iso", "under", "front", "back", "left", "right", "top", "bottom"}))
        ->capture_default_str();
    app.add_option("--machine", request->machine,
                   "profile: a name from 'hew machines', or a .toml file")
        ->group("Machine");
    app.add_option("--tool", request->tools,
                   "cutter of the tool library instead of the machine's own; may be repeated")
        ->allow_extra_args(false)
        ->group("Machine");
    app.add_option("--setups", request->setups, "mill3: 2 flips the part, its base is cut too")
        ->check(CLI::IsMember({1, 2}))
        ->capture_default_str()
        ->group("Milling");
    app.add_option("--axis", request->axis,
                   "mill4: rotary axis in the model frame: auto, x, y, z or 0.1,-0.9,0")
        ->capture_default_str()
        ->group("Milling");
    app.add_option("--angles", request->angles, "mill4: positions of A over a turn; default 40")
        ->check(CLI::Range(4, 64))
        ->group("Milling");
    app.add_option("--drop-unreachable", request->drop,
                   "mill4: directory for the parts without what no position of A shows")
        ->group("Milling");
    app.add_option("--set", request->settings, "change a value of the profile: KEY=VALUE")
        ->allow_extra_args(false)
        ->group("Machine");
    add_model_options(app, request->mesh.unit, request->mesh.scale, request->mesh.up,
                      request->mesh.height_mm);
    add_solid_options(app, request->mesh.body, request->mesh.deflection_mm,
                      request->mesh.angle_deg);
    app.add_flag("--force", request->force, "overwrite")->group("General");
    return [request](const decomp::Run& run) { return run_check(*request, run); };
}

}  // namespace tools
