// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/lone_part.h"

#include "cam/job/maker_detail.h"
#include "cam/orient/choose_build.h"
#include "cam/verify/proof_json.h"
#include "decomp/base/nearest.h"
#include "decomp/base/number.h"
#include "decomp/io/orient.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/repair.h"

#include <numbers>
#include <utility>

namespace cam::job {

using decomp::fail;
using decomp::Result;
using decomp::Run;

namespace {

constexpr double kProgramShare = 0.7;

/// A part alone must stand inside the chamber; the proof would say so too, but only after all the
/// work.
decomp::Status check_chamber(const PartOnPlate& part, const profile::FdmMachine::Chamber& chamber) {
    const Eigen::AlignedBox3d box = decomp::mesh::bounds(part.mesh);
    const Eigen::Vector3d room =
        chamber.max_mm - chamber.min_mm - chamber.margin_mm * Eigen::Vector3d(2, 2, 1);
    for (int axis = 0; axis < 3; ++axis) {
        if (box.sizes()[axis] > room[axis]) {
            return fail(
                "job.part_too_large",
                "the part is " + decomp::decimal(box.sizes()[axis], 1) + " mm along " +
                    "XYZ"[axis] + ", the chamber holds " + decomp::decimal(room[axis], 1) + " mm",
                part.id, "cut it with 'hew make', turn it with --up, or scale it with --height");
        }
    }
    return {};
}

}  // namespace

namespace {

template <class Options>
decomp::io::ReadOptions read_options_of(const Options& options) {
    return {.scale = options.scale,
            .unit = options.unit,
            .body = options.body,
            .deflection_mm = options.deflection_mm,
            .angle = options.angle_deg * std::numbers::pi / 180};
}

}  // namespace

decomp::io::ReadOptions read_options(const MeshRequest& request) {
    return read_options_of(request);
}

decomp::io::ReadOptions read_options(const JobOptions& options) { return read_options_of(options); }

Result<decomp::mesh::TriMesh> read_drawable(const MeshRequest& request, Run& run) {
    const auto up = decomp::io::parse_up(request.up);
    if (!up) {
        return fail(up.error());
    }
    auto mesh = decomp::io::read_mesh(request.path, read_options(request), run);
    if (!mesh) {
        return mesh;
    }
    return decomp::io::to_model_frame(std::move(*mesh), *up, request.height_mm);
}

Result<decomp::mesh::TriMesh> read_solid(const MeshRequest& request, Run& run) {
    auto mesh = read_drawable(request, run);
    if (!mesh) {
        return mesh;
    }
    auto repaired = decomp::repair::repair(*mesh, {}, run);
    if (!repaired) {
        return fail(repaired.error());
    }
    for (const std::string& change : repaired->report.changes) {
        run.info("repair: " + change);
    }
    return std::move(repaired->mesh);
}

Result<PartOnPlate> read_lone_part(const MeshRequest& request, const profile::FdmSetup& setup,
                                   Run& run) {
    auto mesh = read_solid(request, run);
    if (!mesh) {
        return fail(mesh.error());
    }
    return PartOnPlate{
        request.path.stem().string(), to_part_bed(*mesh), middle_of_bed(setup.machine), {}};
}

Result<profile::FdmSetup> setup_of(const JobFile& job, const std::filesystem::path& directory) {
    auto setup =
        profile::read_fdm_setup(job.options.machine, job.options.material, job.options.settings);
    if (setup && setup->hash != job.profile_sha256) {
        return fail("job.profile_changed",
                    "the profile '" + job.options.machine + "' has changed since the job was made",
                    directory.string(),
                    "run 'hew make' again: it makes anew what depends on the profile");
    }
    return setup;
}

Result<PartOnPlate> job_part(const std::filesystem::path& directory, const JobFile& job,
                             const std::string& id, const Eigen::Vector2d& offset_mm) {
    const PartFacts* facts = job.part(id);
    if (facts == nullptr) {
        std::vector<std::string> ids;
        for (const PartFacts& part : job.parts) {
            ids.push_back(part.id);
        }
        return fail("job.no_such_part", "the job has no part '" + id + "'", directory.string(),
                    ids.empty() ? ""
                                : "parts are " + ids.front() + " to " + ids.back() + ". " +
                                      decomp::did_you_mean(id, ids));
    }
    const auto part = read_job_part(directory, job, id);
    if (!part) {
        return fail(part.error());
    }
    PartOnPlate out{id, orient::placed(*part, facts->part_from_model), offset_mm, {}};
    for (const decomp::part::FacetSource& source : part->sources) {
        out.mating.push_back(source.is_cut());
    }
    return out;
}

Result<std::vector<PartOnPlate>> job_plate(const std::filesystem::path& directory,
                                           const JobFile& job, const PlateFacts& plate) {
    std::vector<PartOnPlate> parts;
    for (const PlacedPart& placed : plate.parts) {
        auto part = job_part(directory, job, placed.id, placed.offset_mm);
        if (!part) {
            return fail(part.error());
        }
        parts.push_back(std::move(*part));
    }
    return parts;
}

Result<decomp::part::Assembly> read_assembly(const std::filesystem::path& directory,
                                             const JobFile& job) {
    decomp::part::Assembly assembly;
    assembly.planes = job.decomposition.planes;
    assembly.interfaces = job.decomposition.interfaces;
    for (const PartFacts& facts : job.parts) {
        auto part = read_job_part(directory, job, facts.id);
        if (!part) {
            return fail(part.error());
        }
        assembly.parts.push_back(std::move(*part));
    }
    return assembly;
}

Result<ProvedProgram> slice_and_prove(const std::vector<PartOnPlate>& parts,
                                      const profile::FdmSetup& setup, const std::string& title,
                                      Run& run) {
    for (const PartOnPlate& part : parts) {
        if (const auto fits = check_chamber(part, setup.machine.chamber); !fits) {
            return fail(fits.error());
        }
    }
    Run planning = run;
    planning.progress_sink = [&](const decomp::Progress& p) {
        run.progress("program", kProgramShare * p.fraction);
    };
    auto program = program_plate(parts, setup, title, planning);
    if (!program) {
        return fail(program.error());
    }
    Run proving = run;
    proving.progress_sink = [&](const decomp::Progress& p) {
        run.progress("proof", kProgramShare + (1 - kProgramShare) * p.fraction);
    };
    const auto placed = placed_parts(parts);
    auto proof = verify::examine(program->text, placed, setup, {}, proving);
    if (!proof) {
        return fail(proof.error());
    }
    std::string sidecar =
        verify::proof_json(verify::proof_record(program->text, placed, setup, *proof));
    return ProvedProgram{std::move(program->text), std::move(sidecar), program->facts,
                         std::move(*proof), std::move(program->layers)};
}

}  // namespace cam::job
