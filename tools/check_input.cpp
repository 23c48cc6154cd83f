// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/check_input.h"

#include "cam/job/job_file.h"
#include "decomp/base/nearest.h"
#include "decomp/io/read_mesh.h"

namespace tools {

namespace fs = std::filesystem;
using decomp::fail;
using decomp::Result;
using decomp::Run;

namespace {

Result<CheckInput> read_job_parts(const CheckRequest& request, const Run& run) {
    const auto job = cam::job::read_finished_job(request.mesh.path);
    if (!job) {
        return fail(job.error());
    }
    auto assembly = cam::job::read_assembly(request.mesh.path, *job);
    if (!assembly) {
        return fail(assembly.error());
    }
    CheckInput input;
    input.cut = true;
    for (std::size_t i = 0; i < assembly->parts.size(); ++i) {
        assembly->parts[i].id = job->parts[i].id;
    }
    if (request.part.empty()) {
        auto whole = decomp::io::read_mesh(request.mesh.path / "model.ply", {}, run);
        if (!whole) {
            return fail(whole.error());
        }
        input.whole = std::move(*whole);
        input.parts = std::move(assembly->parts);
        return input;
    }
    std::vector<std::string> ids;
    for (auto& part : assembly->parts) {
        ids.push_back(part.id);
        if (part.id == request.part) {
            input.parts.push_back(std::move(part));
        }
    }
    if (input.parts.empty()) {
        return fail("job.no_such_part", "the job has no part '" + request.part + "'",
                    request.mesh.path.string(), decomp::did_you_mean(request.part, ids));
    }
    return input;
}

}  // namespace

Result<CheckInput> read_check_input(const CheckRequest& request, Run& run) {
    if (fs::is_directory(request.mesh.path)) {
        return read_job_parts(request, run);
    }
    auto mesh = cam::job::read_solid(request.mesh, run);
    if (!mesh) {
        return fail(mesh.error());
    }
    CheckInput input;
    decomp::part::Part part;
    part.id = request.mesh.path.stem().string();
    part.mesh = std::move(*mesh);
    part.sources.resize(part.mesh.triangles.size());
    input.whole = part.mesh;
    input.parts.push_back(std::move(part));
    return input;
}

}  // namespace tools
