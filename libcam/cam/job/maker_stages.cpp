// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/lone_part.h"
#include "cam/job/maker_detail.h"
#include "cam/orient/choose_build.h"
#include "cam/plate/pack.h"
#include "cam/post/convert.h"
#include "cam/render/render.h"
#include "cam/verify/proof_json.h"
#include "decomp/base/file.h"
#include "decomp/base/hash.h"
#include "decomp/base/number.h"
#include "decomp/cut/written.h"
#include "decomp/io/orient.h"
#include "decomp/io/part_ply.h"
#include "decomp/io/read_mesh.h"
#include "decomp/io/write_3mf.h"
#include "decomp/io/write_mesh.h"
#include "decomp/mesh/measure.h"
#include "decomp/pipeline/decompose.h"
#include "decomp/plan/plan_file.h"
#include "decomp/repair/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cam::job {

using decomp::fail;
using decomp::Result;
using decomp::Run;
using decomp::mesh::TriMesh;

namespace {

using Pose = decomp::Pose<decomp::PartBedFrame, decomp::ModelFrame>;

constexpr double kExplode = 0.3;

/// The STL of a part as it is printed. STL is float32, so the part is checked again after that
/// rounding; programs are made from the doubles and do not depend on it.
std::string stl_of(const TriMesh& printed, const std::string& id, const Run& run) {
    const TriMesh rounded = decomp::cut::float_mesh(printed).mesh;
    const decomp::cut::WrittenReport report = decomp::cut::check_written(rounded);
    if (!report.sound()) {
        run.warn("parts/" + id + ".stl: " +
                 (report.intersections.empty() ? "touches itself along an edge"
                                               : "rounding to float made triangles cross") +
                 "; parts/" + id + ".ply and the program are exact");
    }
    return decomp::io::stl_bytes(rounded);
}

/// Turn and scale that to_model_frame() gave a mesh: the turn from the images of the unit points,
/// the scale from the heights before and after.
std::array<double, 16> model_from_file(decomp::io::Up up, const TriMesh& before,
                                       const TriMesh& after) {
    TriMesh axes;
    axes.points = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
    axes.triangles = {{0, 1, 2}};
    axes = decomp::io::to_model_frame(std::move(axes), up, std::nullopt);
    Eigen::Matrix3d turn;
    turn << axes.points[0], axes.points[1], axes.points[2];
    const double height_before = (turn.cwiseAbs() * decomp::mesh::bounds(before).sizes()).z();
    const double height_after = decomp::mesh::bounds(after).sizes().z();
    const double scale = height_before > 0 ? height_after / height_before : 1;
    std::array<double, 16> out{};
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> map(out.data());
    map.topLeftCorner<3, 3>() = scale * turn;
    map(3, 3) = 1;
    return out;
}

/// Without negative zeros, which job.json does not keep: what is used now is what will be read
/// back.
Pose without_negative_zeros(const Pose& pose) {
    std::array<double, 16> values = pose.row_major();
    for (double& value : values) {
        value += 0.0;
    }
    return Pose::from_row_major(values);
}

std::string violation_text(const decomp::part::Violation& violation) {
    return violation.constraint + " by " + decomp::decimal(violation.by_ratio, 3);
}

Result<decomp::pipeline::DecomposeOptions> decompose_options(const JobOptions& wishes) {
    const auto mode = decomp::pipeline::mode_named(wishes.mode);
    if (!mode) {
        return fail(mode.error());
    }
    decomp::pipeline::DecomposeOptions options;
    options.max_parts = wishes.max_parts;
    options.mode = *mode;
    options.global_sweep = wishes.sweep == "global";
    options.keep_boxes = wishes.boxes;
    return options;
}

/// What the job keeps of a part, given its pose, the part so placed, and the judge's word.
PartFacts facts_of(const decomp::part::Part& part, const Pose& pose, const TriMesh& printed,
                   const decomp::part::Verdict& verdict) {
    PartFacts facts;
    facts.id = part.id;
    facts.triangles = part.mesh.triangles.size();
    facts.volume_mm3 = decomp::mesh::volume_mm3(part.mesh);
    facts.extent_mm = decomp::mesh::bounds(printed).sizes();
    facts.part_from_model = pose;
    facts.base = base_of(part, pose);
    facts.support_area_mm2 = verdict.support_area_mm2;
    facts.violations.reserve(verdict.violations.size());
    for (const auto& violation : verdict.violations) {
        facts.violations.push_back(violation_text(violation));
    }
    return facts;
}

}  // namespace

std::string base_of(const decomp::part::Part& part,
                    const decomp::Pose<decomp::PartBedFrame, decomp::ModelFrame>& pose) {
    constexpr double kLevel = 1 - 1e-6;
    constexpr double kOnBedMm = 1e-3;
    double largest = 0;
    std::string base;
    for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i) {
        const Eigen::Vector3d normal = pose.turn(decomp::mesh::double_area_normal(part.mesh, i));
        const Eigen::Vector3d corner = pose * part.mesh.points[part.mesh.triangles[i][0]];
        if (part.sources[i].is_cut() && normal.norm() > largest &&
            -normal.z() >= kLevel * normal.norm() && std::abs(corner.z()) <= kOnBedMm) {
            largest = normal.norm();
            base = "plane " + std::to_string(part.sources[i].plane);
        }
    }
    if (!base.empty()) {
        return base;
    }
    const Eigen::Vector3d down = pose.inverse().turn(-Eigen::Vector3d::UnitZ());
    Eigen::Index axis = 0;
    if (down.cwiseAbs().maxCoeff(&axis) < kLevel) {
        return "flat";
    }
    return std::string(down[axis] < 0 ? "-" : "+") + "xyz"[axis];
}

Result<decomp::part::Part> read_job_part(const std::filesystem::path& directory, const JobFile& job,
                                         const std::string& id) {
    const std::string path = "parts/" + id + ".ply";
    const auto bytes = decomp::read_file(directory / path);
    if (!bytes) {
        return fail(bytes.error());
    }
    const StageRecord* stage = job.stage("parts");
    const bool known =
        stage != nullptr &&
        std::any_of(stage->outputs.begin(), stage->outputs.end(), [&](const auto& o) {
            return o.path == path && o.sha256 == decomp::sha256_hex(*bytes);
        });
    if (!known) {
        return fail("job.changed", "the part is not the one that the job wrote",
                    (directory / path).string(), "run 'hew make' again: it makes the part anew");
    }
    return decomp::io::parse_part_ply(*bytes, (directory / path).string());
}

Maker::Files Maker::make_model(Run& run) {
    auto read =
        decomp::io::parse_mesh(model_bytes_, job_.input.name, read_options(job_.options), run);
    if (!read) {
        return fail(read.error());
    }
    auto up = decomp::io::parse_up(job_.options.up);
    if (!up) {
        return fail(up.error());
    }
    if (*up == decomp::io::Up::Auto) {
        up = decomp::io::choose_up(*read);
    }
    const TriMesh turned = decomp::io::to_model_frame(*read, *up, job_.options.height_mm);
    ModelFacts facts;
    facts.model_from_file = model_from_file(*up, *read, turned);
    auto repaired = decomp::repair::repair(turned, {}, run);
    if (!repaired) {
        return fail(repaired.error());
    }
    const decomp::repair::RepairReport& report = repaired->report;
    facts.repair_status = decomp::repair::name_of(report.status);
    facts.repair_changes = report.changes;
    facts.volume_before_mm3 = report.volume_before_mm3;
    facts.hausdorff_mm = report.hausdorff_mm;
    facts.triangles = repaired->mesh.triangles.size();
    facts.volume_mm3 = decomp::mesh::volume_mm3(repaired->mesh);
    facts.extent_mm = decomp::mesh::bounds(repaired->mesh).sizes();
    for (const std::string& change : facts.repair_changes) {
        run.info("repair: " + change);
    }
    job_.model = std::move(facts);
    return std::vector<FileBytes>{{"model.ply", decomp::io::ply_bytes(repaired->mesh)}};
}

Maker::Files Maker::make_parts(Run& run) {
    auto model = decomp::io::read_mesh(request_.directory / "model.ply", {}, run);
    if (!model) {
        return fail(model.error());
    }
    auto options = decompose_options(job_.options);
    if (!options) {
        return fail(options.error());
    }
    const auto map = map_for(*model, run);
    if (!map) {
        return fail(map.error());
    }
    options->map = *map;
    options->plan = by_hand_.plan;
    options->edits = by_hand_.edits;
    profile::FdmSetup judged = setup_;
    judged.machine = judged_machine();
    auto decomposed = decomp::pipeline::decompose(*model, *options, orient::fdm_judge(judged), run);
    if (!decomposed) {
        return fail(decomposed.error());
    }
    job_.decomposition = {decomposed->tier,
                          decomposed->cuts,
                          decomposed->assembly.planes,
                          decomposed->assembly.interfaces,
                          decomposed->notes,
                          decomposed->boxes,
                          decomposed->necks_mm};
    for (const std::string& note : decomposed->notes) {
        run.info("decomposition: " + note);
    }
    job_.parts.clear();
    std::vector<FileBytes> files;
    for (std::size_t i = 0; i < decomposed->assembly.parts.size(); ++i) {
        const decomp::part::Part& part = decomposed->assembly.parts[i];
        const Pose pose = without_negative_zeros(decomposed->poses[i]);
        const TriMesh printed = orient::placed(part, pose);
        PartFacts facts = facts_of(part, pose, printed, decomposed->verdicts[i]);
        if (!facts.violations.empty()) {
            return fail("job.part_does_not_fit",
                        "the part exceeds the machine: " + facts.violations.front(), part.id);
        }
        files.push_back({"parts/" + part.id + ".ply", decomp::io::part_ply_bytes(part)});
        files.push_back({"parts/" + part.id + ".stl", stl_of(printed, part.id, run)});
        job_.parts.push_back(std::move(facts));
    }
    files.push_back({"plan.toml", decomp::plan::plan_toml(decomposed->plan, decomposed->regions)});
    return files;
}

Maker::Files Maker::make_pictures(Run& run) const {
    const auto assembly = read_assembly(request_.directory, job_);
    if (!assembly) {
        return fail(assembly.error());
    }
    auto png = render::render_meshes_png(render::explode(*assembly, kExplode), {}, run);
    if (!png) {
        return fail(png.error());
    }
    return std::vector<FileBytes>{{"parts.png", std::move(*png)}};
}

Maker::Files Maker::make_assembly(Run& run) const {
    const auto assembly = read_assembly(request_.directory, job_);
    if (!assembly) {
        return fail(assembly.error());
    }
    std::vector<decomp::io::ThreemfObject> objects;
    for (const auto& part : assembly->parts) {
        objects.push_back({part.id, part.mesh, Eigen::Isometry3d::Identity()});
    }
    auto bytes = decomp::io::threemf_bytes(objects);
    if (!bytes) {
        return fail(bytes.error());
    }
    run.progress("assembly", 1);
    return std::vector<FileBytes>{{"assembly.3mf", std::move(*bytes)}};
}

Maker::Files Maker::arrange(Run& run) {
    std::vector<plate::Footprint> footprints;
    for (const PartFacts& facts : job_.parts) {
        auto part = job_part(request_.directory, job_, facts.id, Eigen::Vector2d::Zero());
        if (!part) {
            return fail(part.error());
        }
        footprints.push_back(footprint_of(facts.id, part->mesh, setup_.machine));
    }
    const auto placements = plate::pack(footprints, setup_.machine);
    if (!placements) {
        return fail(placements.error());
    }
    std::vector<PlateFacts> plates;
    for (const plate::Placement& placement : *placements) {
        const auto index = static_cast<std::size_t>(placement.plate);
        while (plates.size() <= index) {
            PlateFacts fresh;
            // A plate that stays as it was keeps its program's figures: they belong to the
            // program's stage.
            if (plates.size() < job_.plates.size()) {
                fresh = job_.plates[plates.size()];
                fresh.parts.clear();
            }
            fresh.name = "plate-" + std::to_string(plates.size() + 1);
            plates.push_back(std::move(fresh));
        }
        plates[index].parts.push_back(
            {job_.parts[placement.part].id, placement.offset + Eigen::Vector2d::Zero()});
    }
    for (PlateFacts& plate : plates) {
        std::sort(plate.parts.begin(), plate.parts.end(),
                  [](const auto& a, const auto& b) { return a.id < b.id; });
    }
    job_.plates = std::move(plates);
    run.progress("arrange", 1);
    return std::vector<FileBytes>{};
}

Maker::Files Maker::make_program(PlateFacts& plate, Run& run) const {
    const auto parts = job_plate(request_.directory, job_, plate);
    if (!parts) {
        return fail(parts.error());
    }
    auto program = program_plate(*parts, setup_, job_.input.name + " " + plate.name, run);
    if (!program) {
        return fail(program.error());
    }
    plate.program = program->facts;
    return std::vector<FileBytes>{{program_path(plate), std::move(program->text)}};
}

Maker::Files Maker::prove(PlateFacts& plate, Run& run) const {
    const auto parts = job_plate(request_.directory, job_, plate);
    if (!parts) {
        return fail(parts.error());
    }
    const auto program = decomp::read_file(request_.directory / program_path(plate));
    if (!program) {
        return fail(program.error());
    }
    const auto placed = placed_parts(*parts);
    const auto proof = verify::examine(*program, placed, setup_, {}, run);
    if (!proof) {
        return fail(proof.error());
    }
    plate.proof = proof_facts(*proof);
    return std::vector<FileBytes>{
        {sidecar_path(program_path(plate)),
         verify::proof_json(verify::proof_record(*program, placed, setup_, *proof))}};
}

Maker::Files Maker::convert_program(PlateFacts& plate, Run& run) const {
    const auto& converter = setup_.machine.converter;
    const std::string path = "plates/" + plate.name + "." + converter.extension;
    // Straight to its final name, which converters like to write into the file; convert() renames.
    const auto done = post::convert(request_.directory / program_path(plate),
                                    request_.directory / path, converter, run);
    if (!done) {
        return fail(done.error());
    }
    auto bytes = decomp::read_file(request_.directory / path);
    if (!bytes) {
        return fail(bytes.error());
    }
    plate.converted = path;
    return std::vector<FileBytes>{{path, std::move(*bytes)}};
}

}  // namespace cam::job
