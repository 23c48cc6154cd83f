// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/maker_detail.h"
#include "cam/job/report.h"
#include "cam/job/step_files.h"
#include "cam/orient/choose_build.h"
#include "cam/verify/proof_json.h"
#include "decomp/base/file.h"
#include "decomp/base/hash.h"
#include "decomp/base/number.h"
#include "decomp/plan/plan_file.h"

#include <utility>

namespace cam::job {

using decomp::Run;
using decomp::Status;

namespace {

/// Shares of the progress bar, about proportional to measured times.
constexpr double kModelWeight = 5;
constexpr double kPartsWeight = 25;
constexpr double kProgramsWeight = 45;
constexpr double kProofsWeight = 20;
constexpr double kRestWeight = 5;

/// Every body gets a Run of its own to hand down.
StageRunner::Body with_run(auto body) {
    return [body = std::move(body)](const Run& run) mutable {
        Run own = run;
        return body(own);
    };
}

}  // namespace

Maker::Maker(const MakeRequest& request, profile::FdmSetup setup, std::string model_bytes,
             ByHand by_hand, JobFile& job, Run run)
    : request_(request),
      setup_(std::move(setup)),
      model_bytes_(std::move(model_bytes)),
      by_hand_(std::move(by_hand)),
      job_(job),
      run_(std::move(run)),
      stages_(request.directory, job, run_) {
    run_.seed = request.options.seed;
    for (const std::string& file : request.options.polycube) {
        const auto bytes = decomp::read_file(file);
        polycube_hashes_.push_back(bytes ? decomp::sha256_hex(*bytes) : "");
    }
}

StageKey Maker::model_key() const {
    const JobOptions& options = job_.options;
    StageKey key("model", kModelRevision);
    key.add("input", job_.input.sha256)
        .add("extension", std::filesystem::path(job_.input.name).extension().string())
        .add("unit", options.unit)
        .add("scale", options.scale)
        .add("up", options.up)
        .add("height", options.height_mm ? decomp::shortest(*options.height_mm) : "")
        .add("body", options.body)
        .add("deflection", options.deflection_mm ? decomp::shortest(*options.deflection_mm) : "")
        .add("angle", options.angle_deg);
    return key;
}

StageKey Maker::parts_key() const {
    StageKey key("parts", kPartsRevision);
    key.add("model", stages_.hash_of("model.ply"))
        .add("max_parts", std::to_string(job_.options.max_parts))
        .add("mode", job_.options.mode)
        .add("sweep", job_.options.sweep)
        .add("boxes", job_.options.boxes ? "kept" : "united")
        .add("seed", std::to_string(job_.options.seed));
    for (const std::string& hash : polycube_hashes_) {
        key.add("polycube", hash);
    }
    // What the plan says, however its file is laid out.
    if (by_hand_.plan) {
        key.add("plan", decomp::plan::plan_toml(*by_hand_.plan));
    }
    for (const std::string& edit : job_.options.edits) {
        key.add("edit", edit);
    }
    // Not the whole profile: another material or infill leaves the parts as they are.
    for (const double value : orient::judged_values(judged_machine())) {
        key.add("judged", value);
    }
    return key;
}

void Maker::add_parts(StageKey& key) const {
    for (const PartFacts& part : job_.parts) {
        key.add(part.id, stages_.hash_of("parts/" + part.id + ".ply"))
            .add("pose", part.part_from_model.map().matrix());
    }
}

StageKey Maker::arrange_key() const {
    StageKey key("arrange", kArrangeRevision);
    key.add("profile", setup_.hash);
    add_parts(key);
    return key;
}

void Maker::add_plate(StageKey& key, const PlateFacts& plate) const {
    key.add("profile", setup_.hash);
    for (const PlacedPart& placed : plate.parts) {
        const PartFacts* part = job_.part(placed.id);
        key.add(placed.id, stages_.hash_of("parts/" + placed.id + ".ply"))
            .add("pose", part->part_from_model.map().matrix())
            .add("x", placed.offset_mm.x())
            .add("y", placed.offset_mm.y());
    }
}

StageKey Maker::program_key(const PlateFacts& plate) const {
    StageKey key("program", kProgramRevision);
    key.add("title", job_.input.name);
    add_plate(key, plate);
    return key;
}

StageKey Maker::proof_key(const PlateFacts& plate) const {
    StageKey key("proof", verify::kCheckerVersion);
    key.add("program", stages_.hash_of(program_path(plate)));
    add_plate(key, plate);
    return key;
}

StageKey Maker::convert_key(const PlateFacts& plate) const {
    const auto& converter = setup_.machine.converter;
    StageKey key("convert", 1);
    key.add("program", stages_.hash_of(program_path(plate)))
        .add("converter", converter.program)
        .add("arguments", converter.arguments)
        .add("extension", converter.extension);
    return key;
}

StageKey Maker::pictures_key() const {
    StageKey key("pictures", kPicturesRevision);
    add_parts(key);
    return key;
}

StageKey Maker::assembly_key() const {
    StageKey key("assembly", 1);
    add_parts(key);
    return key;
}

StageKey Maker::report_key() const {
    StageKey key("report", 1);
    key.add("report", report_json(job_));
    return key;
}

Status Maker::make_plate(std::size_t index) {
    const auto share = static_cast<double>(job_.plates.size());
    PlateFacts& plate = job_.plates[index];
    if (auto done =
            stages_.run("program " + plate.name, program_key(plate), kProgramsWeight / share,
                        with_run([&](Run& run) { return make_program(plate, run); }));
        !done) {
        return done;
    }
    if (auto done = stages_.run("proof " + plate.name, proof_key(plate), kProofsWeight / share,
                                with_run([&](Run& run) { return prove(plate, run); }));
        !done) {
        return done;
    }
    if (setup_.machine.converter.program.empty()) {
        plate.converted.clear();
        return {};
    }
    Status converted = stages_.run("convert " + plate.name, convert_key(plate), 0,
                                   with_run([&](Run& run) { return convert_program(plate, run); }));
    if (!converted && converted.error().code == "post.converter_missing") {
        plate.converted.clear();
        run_.warn(program_path(plate) + " stays as it is: " + converted.error().message + "; " +
                  converted.error().hint);
        return {};
    }
    return converted;
}

Status Maker::make_all() {
    const bool programs = request_.extent == Extent::Programs;
    stages_.expect(kModelWeight + kPartsWeight + kRestWeight +
                   (programs ? kProgramsWeight + kProofsWeight : 0));
    const auto step = [&](const char* name, auto key, double weight, auto body) {
        return stages_.run(name, key, weight, with_run(body));
    };
    if (auto done =
            step("model", model_key(), kModelWeight, [&](Run& run) { return make_model(run); });
        !done) {
        return done;
    }
    if (auto done =
            step("parts", parts_key(), kPartsWeight, [&](Run& run) { return make_parts(run); });
        !done) {
        return done;
    }
    if (auto done = step("pictures", pictures_key(), 0.6 * kRestWeight,
                         [&](Run& run) { return make_pictures(run); });
        !done) {
        return done;
    }
    if (auto done = step("assembly", assembly_key(), 0.3 * kRestWeight,
                         [&](Run& run) { return make_assembly(run); });
        !done) {
        return done;
    }
    if (!programs) {
        job_.plates.clear();
    } else {
        if (auto done = step("arrange", arrange_key(), 0, [&](Run& run) { return arrange(run); });
            !done) {
            return done;
        }
        for (std::size_t i = 0; i < job_.plates.size(); ++i) {
            if (auto done = make_plate(i); !done) {
                return done;
            }
        }
    }
    if (job_.options.step.wanted) {
        if (auto done = step("step", step_key(job_, stages_), 0.3 * kRestWeight,
                             [&](Run& run) { return step_files(request_.directory, job_, run); });
            !done) {
            return done;
        }
    } else {
        job_.step_parts.clear();
    }
    const auto report = [&](Run&) -> Files {
        return std::vector<FileBytes>{{"report.json", report_json(job_)}};
    };
    if (auto done = step("report", report_key(), 0.1 * kRestWeight, report); !done) {
        return done;
    }
    return stages_.finish();
}

std::vector<std::string> Maker::kept_stages(bool& complete) const {
    std::vector<std::string> kept;
    complete = false;
    const auto holds = [&](const std::string& name, const StageKey& key) {
        const bool done = stages_.is_done(name, key);
        if (done) {
            kept.push_back(name);
        }
        return done;
    };
    if (!holds("model", model_key()) || !holds("parts", parts_key()) ||
        !holds("pictures", pictures_key()) || !holds("assembly", assembly_key())) {
        return kept;
    }
    if (request_.extent == Extent::Programs) {
        if (!holds("arrange", arrange_key())) {
            return kept;
        }
        bool all = true;
        for (const PlateFacts& plate : job_.plates) {
            all = holds("program " + plate.name, program_key(plate)) && all;
            all = holds("proof " + plate.name, proof_key(plate)) && all;
        }
        if (!all) {
            return kept;
        }
    }
    if (job_.options.step.wanted && !holds("step", step_key(job_, stages_))) {
        return kept;
    }
    complete = holds("report", report_key());
    return kept;
}

}  // namespace cam::job
