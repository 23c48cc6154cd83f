// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/frame.h"
#include "decomp/base/result.h"
#include "decomp/part/part.h"
#include "decomp/pipeline/decompose.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The job directory: what is in it, how it is made, resumed and reported. docs/formats.md has the
/// schema.
namespace cam::job {

/// STEP files of the parts, as `--step` asks for them.
struct StepWish {
    bool wanted = false;
    std::optional<double> tolerance_mm;  ///< empty: kPrintedStepMm
    std::string schema = "ap214";        ///< ap203, ap214, ap242
    bool many_faces = false;             ///< more faces than CAD programs bear are no error
    std::optional<double> stock_mm;     ///< a block around each part, this much larger; empty: none
    std::vector<std::string> fixtures;  ///< models that stand beside each part: absolute paths

    bool operator==(const StepWish&) const = default;
};

/// What was asked of the pipeline; everything here may change its results.
struct JobOptions {
    std::string machine;                ///< profile name or path
    std::string material;               ///< empty: the machine's own
    std::vector<std::string> settings;  ///< "process.layer_height_mm=0.15"
    std::string unit;  ///< of the file: mm, cm, m, in; empty: the file's own, or mm
    double scale = 1;
    std::string up = "z";                 ///< axis of the file that points up: x -x y -y z -z auto
    std::optional<double> height_mm;      ///< wished extent along up
    std::string body;                     ///< of a STEP or BREP file; empty: all
    std::optional<double> deflection_mm;  ///< of a STEP or BREP file; empty: by its size
    double angle_deg = 20;                ///< of a STEP or BREP file: turn between chords
    std::uint64_t seed = 1;
    int max_parts = 200;
    std::string mode = "sheets";        ///< where the cuts come from: sheets, paper, sections
    std::string sweep = "local";        ///< local, global
    bool boxes = false;                 ///< every box of the polycube stays a part
    std::vector<std::string> polycube;  ///< files of shape and polycube, tets; empty: made here
    std::optional<Eigen::Vector3d> max_size_mm;  ///< of a part as it stands, besides the chamber
    std::string plan;                ///< file of a plan, carried out instead of searching; or empty
    std::vector<std::string> edits;  ///< by hand, in order: decomp::plan::parse_edit()
    StepWish step;

    bool operator==(const JobOptions&) const = default;
};

struct InputFile {
    std::string name;  ///< without folder
    std::uint64_t bytes = 0;
    std::string sha256;
};

/// The shape in the model frame and what repair did to it.
struct ModelFacts {
    std::array<double, 16> model_from_file{};
    std::size_t triangles = 0;
    Eigen::Vector3d extent_mm = Eigen::Vector3d::Zero();
    double volume_mm3 = 0;
    std::string repair_status;  ///< clean, fixed, united, wrapped
    std::vector<std::string> repair_changes;
    double volume_before_mm3 = 0;
    double hausdorff_mm = 0;
};

struct PartFacts {
    std::string id;  ///< "P01"
    std::size_t triangles = 0;
    double volume_mm3 = 0;
    Eigen::Vector3d extent_mm = Eigen::Vector3d::Zero();  ///< as printed
    decomp::Pose<decomp::PartBedFrame, decomp::ModelFrame> part_from_model;
    std::string base;  ///< "plane 3", or the axis of the model frame that points down, e.g. "-z"
    double support_area_mm2 = 0;
    std::vector<std::string> violations;  ///< "chamber.x by 1.2"; empty when the part fits
};

struct DecompositionFacts {
    std::string tier;
    int cuts = 0;
    std::vector<decomp::part::Plane> planes;
    std::vector<decomp::part::Interface> interfaces;
    std::vector<std::string> notes;
    std::optional<decomp::pipeline::BoxFacts> polycube;  ///< when there was one
    std::vector<double> necks_mm;  ///< of the interfaces; none in jobs of older versions

    /// 0: not known.
    [[nodiscard]] double neck_mm(std::size_t interface) const {
        return interface < necks_mm.size() ? necks_mm[interface] : 0;
    }
};

/// A part as a STEP solid: step/ID.step.
struct StepPartFacts {
    std::string id;
    std::uint64_t bytes = 0;
    std::size_t faces = 0;
    std::size_t planes = 0;  ///< of more than one triangle
    std::size_t cylinders = 0;
    std::size_t cones = 0;
    std::size_t tori = 0;
    std::size_t removed_points = 0;
    double decimation_mm = 0;  ///< distance to the part, either way
    double sagitta_mm = 0;     ///< of the chords that curved faces replace
    double volume_mm3 = 0;     ///< as the geometry kernel has it
};

/// A part on a plate: its part bed frame stands at `offset_mm` on the bed, unturned.
struct PlacedPart {
    std::string id;
    Eigen::Vector2d offset_mm = Eigen::Vector2d::Zero();
};

struct ProgramFacts {
    double seconds = 0;
    double filament_mm = 0;
    double filament_g = 0;
    double cost = 0;
};

struct ProofFacts {
    bool passed = false;
    std::size_t faults = 0;
    std::string first_fault;  ///< "line 120: proof.outside_chamber: …"; empty when passed
    double out_of_part_percent = 0;
    double uncovered_skin_percent = 0;
    double solid_fill_ratio = 0;
    double max_flow_mm3_per_s = 0;
    int floating_islands = 0;
};

struct PlateFacts {
    std::string name;  ///< "plate-1"
    std::vector<PlacedPart> parts;
    ProgramFacts program;
    ProofFacts proof;
    std::string converted;  ///< path of the converter's file, e.g. plates/plate-1.x3g; empty: none
};

struct OutputFile {
    std::string path;  ///< relative to the job directory, with '/'
    std::string sha256;

    bool operator==(const OutputFile&) const = default;
};

/// A finished stage: `key` is the hash of everything that it read. It is done while the key is what
/// it would be today and every output has its hash.
struct StageRecord {
    std::string name;
    std::string key;
    std::vector<OutputFile> outputs;
};

/// job.json as a value.
struct JobFile {
    std::string version;
    InputFile input;
    JobOptions options;
    std::string profile_sha256;
    bool finished = false;  ///< false while a run is under way or was interrupted
    ModelFacts model;
    DecompositionFacts decomposition;
    std::vector<PartFacts> parts;
    std::vector<PlateFacts> plates;
    std::vector<StepPartFacts> step_parts;
    std::vector<StageRecord> stages;

    [[nodiscard]] const StageRecord* stage(std::string_view name) const;
    [[nodiscard]] const PartFacts* part(std::string_view id) const;
};

/// "PROGRAM.proof.json"
[[nodiscard]] std::string sidecar_path(const std::string& program);

/// "plates/plate-1.gcode"
[[nodiscard]] std::string program_path(const PlateFacts& plate);

/// Where a part stands on the bed: base at z = 0, its part bed frame moved to the offset.
[[nodiscard]] decomp::Pose<decomp::BedFrame, decomp::PartBedFrame> bed_from_part(
    const Eigen::Vector2d& offset_mm);

/// The text of job.json: fixed key order, shortest numbers, a final newline.
[[nodiscard]] std::string job_json(const JobFile& job);

/// @error job.unreadable (with the key), job.schema (a schema that this version does not know)
[[nodiscard]] decomp::Result<JobFile> parse_job_json(std::string_view text,
                                                     const std::string& where);

/// Reads DIRECTORY/job.json. @error job.not_a_job, and as parse_job_json()
[[nodiscard]] decomp::Result<JobFile> read_job(const std::filesystem::path& directory);

/// As read_job(), for verbs that need a job whose files belong together. @error job.unfinished, as
/// read_job()
[[nodiscard]] decomp::Result<JobFile> read_finished_job(const std::filesystem::path& directory);

}  // namespace cam::job
