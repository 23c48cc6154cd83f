// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/step_files.h"

#include "cam/job/maker_detail.h"
#include "cam/job/step_surroundings.h"
#include "cam/render/render.h"
#include "decomp/base/file.h"
#include "decomp/base/hash.h"
#include "decomp/base/number.h"
#include "decomp/brep/write_step.h"
#include "decomp/mesh/measure.h"
#include "decomp/solid/make_solid.h"

#include <array>
#include <cmath>
#include <utility>

namespace cam::job {

using decomp::fail;
using decomp::Result;
using decomp::Run;
using decomp::brep::StepBody;
using decomp::solid::Detail;

namespace {

/// Of the volume, for rounding alone.
constexpr double kRounding = 1e-9;

std::array<double, 3> colour_of(std::size_t index) {
    const render::Rgb rgb = render::part_colour(index);
    return {rgb.red / 255.0, rgb.green / 255.0, rgb.blue / 255.0};
}

struct WrittenPart {
    decomp::solid::MadeSolid made;
    decomp::brep::StepFile file;
};

/// The kernel's own check, and a volume that the deviation explains.
bool is_sound(const WrittenPart& written, const decomp::mesh::TriMesh& mesh, double tolerance_mm) {
    const auto& figures = written.file.figures.at(0);
    const double volume_mm3 = decomp::mesh::volume_mm3(mesh);
    const bool as_it_was = written.made.report.removed_points == 0 &&
                           written.made.report.moved_mm == 0 && written.made.report.sagitta_mm == 0;
    const double allowed_mm3 =
        kRounding * volume_mm3 + (as_it_was ? 0
                                            : (tolerance_mm + written.made.report.sagitta_mm) *
                                                  decomp::mesh::area_mm2(mesh));
    return figures.valid && figures.closed &&
           std::abs(figures.volume_mm3 - volume_mm3) <= allowed_mm3;
}

/// How the parts of one job are written.
struct StepStyle {
    double tolerance_mm;
    bool many_faces;
    decomp::brep::StepSchema schema;
};

/// One part's file with what stands around the part in it. The part comes first.
Result<std::string> with_surroundings(const PartFacts& facts, StepBody part, const StepWish& wish,
                                      const std::vector<StepBody>& fixtures, const StepStyle& style,
                                      const Run& run) {
    std::vector<StepBody> bodies{std::move(part)};
    if (wish.stock_mm) {
        auto stock = stock_body(facts, *wish.stock_mm, run);
        if (!stock) {
            return fail(stock.error());
        }
        bodies.push_back(std::move(*stock));
    }
    bodies.insert(bodies.end(), fixtures.begin(), fixtures.end());
    auto file = decomp::brep::write_step(bodies, facts.id, style.schema, run);
    if (!file) {
        return fail(file.error());
    }
    return std::move(file->text);
}

/// The least simple solid that is sound.
Result<WrittenPart> write_part(const decomp::part::Part& part, const Eigen::Isometry3d& placed,
                               const StepStyle& style, std::array<double, 3> colour,
                               const Run& run) {
    for (const Detail detail : {Detail::Curved, Detail::Flat, Detail::CutsAlone}) {
        auto made = decomp::solid::make_solid(
            part, {.tolerance_mm = style.tolerance_mm, .detail = detail, .force = style.many_faces},
            run);
        if (!made) {
            return fail(made.error());
        }
        // Recognised where the part came from, with its exact directions; then moved.
        made->solid = decomp::solid::moved(std::move(made->solid), placed);
        auto file =
            decomp::brep::write_step({{part.id, made->solid, colour}}, part.id, style.schema, run);
        if (!file) {
            return fail(file.error());
        }
        WrittenPart written{std::move(*made), std::move(*file)};
        if (is_sound(written, part.mesh, style.tolerance_mm)) {
            return written;
        }
        run.info("step/" + part.id + ".step: not sound with " +
                 std::string(detail == Detail::Curved ? "curved faces" : "joined faces") +
                 ", made again without");
    }
    return fail("job.step_unsound", "the part cannot be made a sound solid", part.id,
                "try another --step-tol, or use parts/" + part.id + ".stl");
}

StepPartFacts facts_of(const std::string& id, const WrittenPart& written) {
    const decomp::solid::SolidReport& report = written.made.report;
    StepPartFacts facts;
    facts.id = id;
    facts.bytes = written.file.text.size();
    facts.faces = report.faces;
    facts.planes = report.planes;
    facts.cylinders = report.cylinders;
    facts.cones = report.cones;
    facts.tori = report.tori;
    facts.removed_points = report.removed_points;
    facts.decimation_mm = report.decimation_mm;
    facts.sagitta_mm = report.sagitta_mm;
    facts.volume_mm3 = written.file.figures.at(0).volume_mm3;
    return facts;
}

}  // namespace

StageKey step_key(const JobFile& job, const StageRunner& stages) {
    constexpr int kRevision = 3;
    const StepWish& wish = job.options.step;
    StageKey key("step", kRevision);
    key.add("tolerance", wish.tolerance_mm.value_or(kPrintedStepMm))
        .add("schema", wish.schema)
        .add("many", wish.many_faces ? "1" : "0")
        .add("title", job.input.name);
    if (wish.stock_mm) {
        key.add("stock", *wish.stock_mm);
    }
    for (const std::string& file : wish.fixtures) {
        const auto bytes = decomp::read_file(file);
        key.add("fixture", bytes ? decomp::sha256_hex(*bytes) : "");
    }
    for (const PartFacts& part : job.parts) {
        key.add(part.id, stages.hash_of("parts/" + part.id + ".ply"))
            .add("pose", part.part_from_model.map().matrix());
    }
    return key;
}

Result<std::vector<FileBytes>> step_files(const std::filesystem::path& directory, JobFile& job,
                                          Run& run) {
    const StepWish& wish = job.options.step;
    const auto schema = decomp::brep::parse_schema(wish.schema);
    if (!schema) {
        return fail(schema.error());
    }
    const StepStyle style{wish.tolerance_mm.value_or(kPrintedStepMm), wish.many_faces, *schema};
    const auto fixtures = fixture_bodies(wish, style.tolerance_mm, run);
    if (!fixtures) {
        return fail(fixtures.error());
    }
    job.step_parts.clear();
    std::vector<FileBytes> files;
    std::vector<decomp::brep::StepBody> bodies;
    for (std::size_t i = 0; i < job.parts.size(); ++i) {
        const PartFacts& facts = job.parts[i];
        auto part = read_job_part(directory, job, facts.id);
        if (!part) {
            return fail(part.error());
        }
        auto written = write_part(*part, facts.part_from_model.map(), style, colour_of(i), run);
        if (!written) {
            return fail(written.error());
        }
        job.step_parts.push_back(facts_of(facts.id, *written));
        std::string text = std::move(written->file.text);
        if (wish.stock_mm || !fixtures->empty()) {
            auto around = with_surroundings(facts, {facts.id, written->made.solid, colour_of(i)},
                                            wish, *fixtures, style, run);
            if (!around) {
                return fail(around.error());
            }
            text = std::move(*around);
            job.step_parts.back().bytes = text.size();
        }
        files.push_back({"step/" + facts.id + ".step", std::move(text)});
        bodies.push_back({facts.id, std::move(written->made.solid), colour_of(i),
                          facts.part_from_model.inverse().map(), false});
        run.progress("step",
                     static_cast<double>(i + 1) / static_cast<double>(job.parts.size() + 1));
    }
    auto assembly = decomp::brep::write_step(
        bodies, std::filesystem::path(job.input.name).stem().string(), *schema, run);
    if (!assembly) {
        return fail(assembly.error());
    }
    files.push_back({"step/assembly.step", std::move(assembly->text)});
    run.progress("step", 1);
    return files;
}

Result<JobFile> export_step(const std::filesystem::path& directory, const StepWish& wish,
                            const Run& run) {
    auto job = read_finished_job(directory);
    if (!job) {
        return job;
    }
    const auto lock = DirectoryLock::take(directory);
    if (!lock) {
        return fail(lock.error());
    }
    job->options.step = wish;
    job->options.step.wanted = true;
    StageRunner stages(directory, *job, run);
    stages.expect(1);
    const auto made = stages.run("step", step_key(*job, stages), 1, [&](const Run& outer) {
        Run inner = outer;
        return step_files(directory, *job, inner);
    });
    stages.keep_others();
    // Whatever became of the STEP files, the job that they belong to is whole.
    const auto finished = stages.finish();
    if (!made) {
        return fail(made.error());
    }
    if (!finished) {
        return fail(finished.error());
    }
    return job;
}

}  // namespace cam::job
