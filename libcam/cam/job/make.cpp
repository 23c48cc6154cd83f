// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/make.h"

#include "cam/job/lone_part.h"
#include "cam/job/maker_detail.h"
#include "cam/job/report.h"
#include "decomp/base/file.h"
#include "decomp/base/hash.h"
#include "decomp/io/orient.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/measure.h"
#include "decomp/plan/plan_file.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace cam::job {

namespace fs = std::filesystem;
using decomp::fail;
using decomp::Result;
using decomp::Run;
using decomp::Status;

namespace {

constexpr const char* kPlanFile = "plan.toml";

/// Nothing but what a killed run may have left.
bool holds_nothing(const fs::path& directory) {
    std::error_code ignored;
    return std::all_of(
        fs::directory_iterator(directory, ignored), fs::directory_iterator(),
        [](const auto& entry) { return entry.path().filename().string().starts_with(".hew-"); });
}

/// The earlier job of this directory, or an empty one.
Result<JobFile> earlier_job(const MakeRequest& request) {
    std::error_code ignored;
    if (!fs::exists(request.directory / "job.json", ignored)) {
        if (fs::exists(request.directory, ignored) && !holds_nothing(request.directory) &&
            !request.force) {
            return fail("job.not_empty", "the directory holds other things, and no job",
                        request.directory.string(), "choose another directory, or add --force");
        }
        return JobFile{};
    }
    auto job = read_job(request.directory);
    if (!job && request.force) {
        return JobFile{};
    }
    return job;
}

/// Everything that is read before the first stage.
struct Start {
    JobFile job;
    profile::FdmSetup setup;
    std::string model_bytes;
    ByHand by_hand;
};

/// The plan that the job of this directory wrote has been changed since.
bool plan_changed(const fs::path& directory, const JobFile& job) {
    const StageRecord* stage = job.stage("parts");
    const auto bytes = decomp::read_file(directory / kPlanFile);
    return stage != nullptr && bytes &&
           std::any_of(stage->outputs.begin(), stage->outputs.end(), [&](const OutputFile& file) {
               return file.path == kPlanFile && file.sha256 != decomp::sha256_hex(*bytes);
           });
}

/// Plan and edits of the options. @error job.plan_changed, job.plan_in_job, those of plan
Result<ByHand> by_hand_of(const MakeRequest& request, const JobFile& earlier) {
    const JobOptions& options = request.options;
    ByHand out;
    for (const std::string& text : options.edits) {
        auto edit = decomp::plan::parse_edit(text);
        if (!edit) {
            return fail(edit.error());
        }
        out.edits.push_back(std::move(*edit));
    }
    if (options.plan.empty()) {
        if (!request.force && plan_changed(request.directory, earlier)) {
            return fail("job.plan_changed", "plan.toml was changed, and would be written anew",
                        (request.directory / kPlanFile).string(),
                        "carry it out with --plan " + (request.directory / kPlanFile).string() +
                            ", or add --force to lose the changes");
        }
        return out;
    }
    std::error_code ignored;
    if (!out.edits.empty() &&
        fs::equivalent(options.plan, request.directory / kPlanFile, ignored)) {
        return fail("job.plan_in_job",
                    "the edits would be made again with every run, for they go into this plan",
                    options.plan, "copy the plan to another place, or choose another directory");
    }
    const auto text = decomp::read_file(options.plan);
    if (!text) {
        return fail(text.error());
    }
    auto plan = decomp::plan::parse_plan(*text, options.plan);
    if (!plan) {
        return fail(plan.error());
    }
    out.plan = std::make_shared<const decomp::plan::Plan>(std::move(*plan));
    return out;
}

Result<Start> start_of(const MakeRequest& request) {
    auto job = earlier_job(request);
    if (!job) {
        return fail(job.error());
    }
    auto setup = profile::read_fdm_setup(request.options.machine, request.options.material,
                                         request.options.settings);
    if (!setup) {
        return fail(setup.error());
    }
    if (const auto up = decomp::io::parse_up(request.options.up); !up) {
        return fail(up.error());
    }
    auto bytes = decomp::read_file(request.model);
    if (!bytes) {
        return fail(bytes.error());
    }
    const InputFile input{request.model.filename().string(), bytes->size(),
                          decomp::sha256_hex(*bytes)};
    if (!job->input.name.empty() && job->input.name != input.name &&
        job->input.sha256 != input.sha256 && !request.force) {
        return fail("job.other_model", "the directory holds the job of '" + job->input.name + "'",
                    request.directory.string(),
                    "choose another directory, or add --force to replace that job");
    }
    auto by_hand = by_hand_of(request, *job);
    if (!by_hand) {
        return fail(by_hand.error());
    }
    job->version = HEW_VERSION;
    job->input = input;
    // STEP files that 'hew export' once wrote are kept up to date.
    const StepWish earlier_wish = job->options.step;
    job->options = request.options;
    if (!job->options.step.wanted) {
        job->options.step = earlier_wish;
    }
    job->options.material = setup->material.name;
    job->profile_sha256 = setup->hash;
    return Start{std::move(*job), std::move(*setup), std::move(*bytes), std::move(*by_hand)};
}

/// Makes the directory and puts a manifest there before anything else: whatever happens next, it is
/// a job of Hew's.
Status open_directory(const fs::path& directory, const JobFile& job) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error) {
        return fail("file.unwritable", "cannot make the folder: " + error.message(),
                    directory.string());
    }
    if (!fs::exists(directory / "job.json")) {
        return decomp::write_file(directory / "job.json", job_json(job), decomp::Overwrite::Allow);
    }
    return {};
}

}  // namespace

Result<MakeResult> make(const MakeRequest& request, Run& run) {
    auto start = start_of(request);
    if (!start) {
        return fail(start.error());
    }
    if (const auto opened = open_directory(request.directory, start->job); !opened) {
        return fail(opened.error());
    }
    const auto lock = DirectoryLock::take(request.directory);
    if (!lock) {
        return fail(lock.error());
    }
    remove_leftovers(request.directory);
    MakeResult result{std::move(start->job), {}};
    Maker maker(request, std::move(start->setup), std::move(start->model_bytes),
                std::move(start->by_hand), result.job, run);
    const Status made = maker.make_all();
    if (!made) {
        return fail(made.error());
    }
    result.timings = maker.timings();
    const Status written = decomp::write_file(
        request.directory / "timings.json", timings_json(result.timings), decomp::Overwrite::Allow);
    if (!written) {
        return fail(written.error());
    }
    return result;
}

Result<MakePlan> plan_make(const MakeRequest& request, Run& run) {
    auto start = start_of(request);
    if (!start) {
        return fail(start.error());
    }
    const JobOptions& options = request.options;
    auto mesh = decomp::io::parse_mesh(start->model_bytes, start->job.input.name,
                                       read_options(options), run);
    if (!mesh) {
        return fail(mesh.error());
    }
    MakePlan plan;
    const auto up = decomp::io::parse_up(options.up);
    plan.extent_mm =
        decomp::mesh::bounds(decomp::io::to_model_frame(std::move(*mesh), *up, options.height_mm))
            .sizes();
    const auto& chamber = start->setup.machine.chamber;
    plan.chamber_mm =
        chamber.max_mm - chamber.min_mm - chamber.margin_mm * Eigen::Vector3d(2, 2, 1);
    plan.blocks = static_cast<int>(
        plan.extent_mm.cwiseQuotient(plan.chamber_mm).array().ceil().max(1).prod());
    plan.input = start->job.input;
    plan.options = start->job.options;
    plan.profile_sha256 = start->job.profile_sha256;
    const Maker maker(request, std::move(start->setup), std::move(start->model_bytes),
                      std::move(start->by_hand), start->job, run);
    plan.kept = maker.kept_stages(plan.complete);
    return plan;
}

}  // namespace cam::job
