// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/job_file.h"

#include "decomp/base/file.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace cam::job {

using decomp::fail;
using decomp::Result;
using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kSchema = "hew.job/1";

template <class Vector>
Json numbers(const Vector& values) {
    Json out = Json::array();
    for (const double value : values) {
        out.push_back(value + 0.0);  // -0.0 + 0.0 is 0.0
    }
    return out;
}

Eigen::Vector3d vector3(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json options_json(const JobOptions& options) {
    Json json;
    json["unit"] = options.unit;
    json["scale"] = options.scale;
    json["up"] = options.up;
    json["height_mm"] = options.height_mm ? Json(*options.height_mm) : Json(nullptr);
    json["body"] = options.body;
    json["deflection_mm"] = options.deflection_mm ? Json(*options.deflection_mm) : Json(nullptr);
    json["angle_deg"] = options.angle_deg;
    json["seed"] = options.seed;
    json["max_parts"] = options.max_parts;
    json["mode"] = options.mode;
    json["sweep"] = options.sweep;
    json["boxes"] = options.boxes;
    json["polycube"] = Json::array();
    for (const std::string& file : options.polycube) {
        json["polycube"].push_back(std::filesystem::path(file).filename().string());
    }
    json["max_size_mm"] = options.max_size_mm ? numbers(*options.max_size_mm) : Json(nullptr);
    json["plan"] = std::filesystem::path(options.plan).filename().string();
    json["edits"] = options.edits;
    json["settings"] = options.settings;
    if (options.step.wanted) {
        json["step"] = {
            {"tolerance_mm",
             options.step.tolerance_mm ? Json(*options.step.tolerance_mm) : Json(nullptr)},
            {"schema", options.step.schema},
            {"many_faces", options.step.many_faces},
            {"stock_mm", options.step.stock_mm ? Json(*options.step.stock_mm) : Json(nullptr)},
            {"fixtures", options.step.fixtures}};
    }
    return json;
}

JobOptions read_options(const Json& job) {
    JobOptions options;
    const Json& json = job.at("options");
    options.machine = job.at("machine");
    options.material = job.at("material");
    options.unit = json.at("unit");
    options.scale = json.at("scale");
    options.up = json.at("up");
    if (!json.at("height_mm").is_null()) {
        options.height_mm = json.at("height_mm").get<double>();
    }
    // Jobs made before STEP was read lack these.
    options.body = json.value("body", options.body);
    if (json.contains("deflection_mm") && !json.at("deflection_mm").is_null()) {
        options.deflection_mm = json.at("deflection_mm").get<double>();
    }
    options.angle_deg = json.value("angle_deg", options.angle_deg);
    options.seed = json.at("seed");
    options.max_parts = json.at("max_parts");
    options.mode = json.value("mode", options.mode);
    options.sweep = json.value("sweep", options.sweep);
    options.boxes = json.value("boxes", false);
    options.polycube = json.value("polycube", options.polycube);
    if (json.contains("max_size_mm") && !json.at("max_size_mm").is_null()) {
        options.max_size_mm = vector3(json.at("max_size_mm"));
    }
    options.plan = json.value("plan", options.plan);
    options.edits = json.value("edits", options.edits);
    options.settings = json.at("settings").get<std::vector<std::string>>();
    if (json.contains("step")) {
        const Json& step = json.at("step");
        options.step.wanted = true;
        if (!step.at("tolerance_mm").is_null()) {
            options.step.tolerance_mm = step.at("tolerance_mm").get<double>();
        }
        options.step.schema = step.at("schema");
        options.step.many_faces = step.at("many_faces");
        // Jobs made before these were there lack them.
        if (step.contains("stock_mm") && !step.at("stock_mm").is_null()) {
            options.step.stock_mm = step.at("stock_mm").get<double>();
        }
        options.step.fixtures = step.value("fixtures", options.step.fixtures);
    }
    return options;
}

Json model_json(const ModelFacts& model) {
    Json json;
    json["triangles"] = model.triangles;
    json["extent_mm"] = numbers(model.extent_mm);
    json["volume_mm3"] = model.volume_mm3;
    json["repair"] = {{"status", model.repair_status},
                      {"changes", model.repair_changes},
                      {"volume_before_mm3", model.volume_before_mm3},
                      {"hausdorff_mm", model.hausdorff_mm}};
    return json;
}

ModelFacts read_model(const Json& job) {
    ModelFacts model;
    const Json& json = job.at("model");
    model.model_from_file = job.at("model_from_file").get<std::array<double, 16>>();
    model.triangles = json.at("triangles");
    model.extent_mm = vector3(json.at("extent_mm"));
    model.volume_mm3 = json.at("volume_mm3");
    const Json& repair = json.at("repair");
    model.repair_status = repair.at("status");
    model.repair_changes = repair.at("changes").get<std::vector<std::string>>();
    model.volume_before_mm3 = repair.at("volume_before_mm3");
    model.hausdorff_mm = repair.at("hausdorff_mm");
    return model;
}

Json polycube_json(const decomp::pipeline::BoxFacts& facts) {
    Json json;
    json["used"] = facts.used;
    json["boxes"] = facts.boxes;
    json["parts"] = facts.parts;
    json["cuts"] = facts.cuts;
    json["limited_cuts"] = facts.limited_cuts;
    json["shifted_cuts"] = facts.shifted_cuts;
    json["skipped_tongues"] = facts.skipped_tongues;
    json["healed"] = facts.healed;
    json["healed_share"] = facts.healed_share;
    json["mislabeled_share"] = facts.mislabeled_share;
    json["flipped_share"] = facts.flipped_share;
    json["sheets"] = Json::array();
    for (const auto& sheet : facts.sheets) {
        Json corners = Json::array();
        for (const Eigen::Vector3d& corner : sheet.corners) {
            corners.push_back(numbers(corner));
        }
        json["sheets"].push_back({{"plane", numbers(std::array<double, 4>{
                                                sheet.plane.normal.x(), sheet.plane.normal.y(),
                                                sheet.plane.normal.z(), sheet.plane.offset_mm})},
                                  {"axis", sheet.axis},
                                  {"level", sheet.level},
                                  {"snapped", sheet.snapped},
                                  {"area_mm2", sheet.area_mm2},
                                  {"rms_mm", sheet.rms_mm},
                                  {"max_mm", sheet.max_mm},
                                  {"corners", corners}});
    }
    return json;
}

decomp::pipeline::BoxFacts read_polycube(const Json& json) {
    decomp::pipeline::BoxFacts facts;
    facts.used = json.at("used");
    facts.boxes = json.at("boxes");
    facts.parts = json.at("parts");
    facts.cuts = json.at("cuts");
    facts.limited_cuts = json.at("limited_cuts");
    facts.shifted_cuts = json.at("shifted_cuts");
    facts.skipped_tongues = json.at("skipped_tongues");
    facts.healed = json.at("healed");
    facts.healed_share = json.at("healed_share");
    facts.mislabeled_share = json.at("mislabeled_share");
    facts.flipped_share = json.at("flipped_share");
    for (const Json& sheet : json.at("sheets")) {
        decomp::pipeline::SheetFacts out;
        out.plane = {vector3(sheet.at("plane")), sheet.at("plane").at(3).get<double>()};
        out.axis = sheet.at("axis");
        out.level = sheet.at("level");
        out.snapped = sheet.at("snapped");
        out.area_mm2 = sheet.at("area_mm2");
        out.rms_mm = sheet.at("rms_mm");
        out.max_mm = sheet.at("max_mm");
        for (const Json& corner : sheet.at("corners")) {
            out.corners.push_back(vector3(corner));
        }
        facts.sheets.push_back(std::move(out));
    }
    return facts;
}

Json decomposition_json(const DecompositionFacts& facts) {
    Json json;
    json["tier"] = facts.tier;
    json["cuts"] = facts.cuts;
    json["planes"] = Json::array();
    for (const auto& plane : facts.planes) {
        json["planes"].push_back(numbers(std::array<double, 4>{plane.normal.x(), plane.normal.y(),
                                                               plane.normal.z(), plane.offset_mm}));
    }
    json["interfaces"] = Json::array();
    for (const auto& interface : facts.interfaces) {
        json["interfaces"].push_back({{"plane", interface.plane},
                                      {"parts", {interface.part_a, interface.part_b}},
                                      {"area_mm2", interface.area_mm2},
                                      {"neck_mm", facts.neck_mm(json["interfaces"].size())}});
    }
    json["notes"] = facts.notes;
    json["polycube"] = facts.polycube ? polycube_json(*facts.polycube) : Json(nullptr);
    return json;
}

DecompositionFacts read_decomposition(const Json& json) {
    DecompositionFacts facts;
    facts.tier = json.at("tier");
    facts.cuts = json.at("cuts");
    for (const Json& plane : json.at("planes")) {
        facts.planes.push_back({vector3(plane), plane.at(3).get<double>()});
    }
    for (const Json& interface : json.at("interfaces")) {
        facts.interfaces.push_back({interface.at("plane"), interface.at("parts").at(0),
                                    interface.at("parts").at(1), interface.at("area_mm2")});
        facts.necks_mm.push_back(interface.value("neck_mm", 0.0));
    }
    facts.notes = json.at("notes").get<std::vector<std::string>>();
    if (json.contains("polycube") && !json.at("polycube").is_null()) {
        facts.polycube = read_polycube(json.at("polycube"));
    }
    return facts;
}

Json part_json(const JobFile& job, const PartFacts& part) {
    Json json;
    json["id"] = part.id;
    json["mesh"] = "parts/" + part.id + ".ply";
    json["triangles"] = part.triangles;
    json["volume_mm3"] = part.volume_mm3;
    json["extent_mm"] = numbers(part.extent_mm);
    json["part_from_model"] = numbers(part.part_from_model.row_major());
    json["base"] = part.base;
    json["support_area_mm2"] = part.support_area_mm2;
    json["violations"] = part.violations;
    for (const PlateFacts& plate : job.plates) {
        for (const PlacedPart& placed : plate.parts) {
            if (placed.id == part.id) {
                json["plate"] = plate.name;
                json["bed_from_model"] =
                    numbers((bed_from_part(placed.offset_mm) * part.part_from_model).row_major());
            }
        }
    }
    return json;
}

PartFacts read_part(const Json& json) {
    PartFacts part;
    part.id = json.at("id");
    part.triangles = json.at("triangles");
    part.volume_mm3 = json.at("volume_mm3");
    part.extent_mm = vector3(json.at("extent_mm"));
    part.part_from_model = decltype(part.part_from_model)::from_row_major(
        json.at("part_from_model").get<std::array<double, 16>>());
    part.base = json.at("base");
    part.support_area_mm2 = json.at("support_area_mm2");
    part.violations = json.at("violations").get<std::vector<std::string>>();
    return part;
}

Json plate_json(const PlateFacts& plate) {
    Json json;
    json["name"] = plate.name;
    json["program"] = program_path(plate);
    json["proof"] = sidecar_path(program_path(plate));
    json["converted"] = plate.converted;
    json["parts"] = Json::array();
    for (const PlacedPart& placed : plate.parts) {
        json["parts"].push_back({{"id", placed.id}, {"offset_mm", numbers(placed.offset_mm)}});
    }
    const ProgramFacts& program = plate.program;
    json["seconds"] = program.seconds;
    json["filament_mm"] = program.filament_mm;
    json["filament_g"] = program.filament_g;
    json["cost"] = program.cost;
    const ProofFacts& proof = plate.proof;
    json["verdict"] = {{"passed", proof.passed},
                       {"faults", proof.faults},
                       {"first_fault", proof.first_fault},
                       {"out_of_part_percent", proof.out_of_part_percent},
                       {"uncovered_skin_percent", proof.uncovered_skin_percent},
                       {"solid_fill_ratio", proof.solid_fill_ratio},
                       {"max_flow_mm3_per_s", proof.max_flow_mm3_per_s},
                       {"floating_islands", proof.floating_islands}};
    return json;
}

PlateFacts read_plate(const Json& json) {
    PlateFacts plate;
    plate.name = json.at("name");
    plate.converted = json.at("converted");
    for (const Json& placed : json.at("parts")) {
        plate.parts.push_back({placed.at("id"),
                               {placed.at("offset_mm").at(0).get<double>(),
                                placed.at("offset_mm").at(1).get<double>()}});
    }
    plate.program.seconds = json.at("seconds");
    plate.program.filament_mm = json.at("filament_mm");
    plate.program.filament_g = json.at("filament_g");
    plate.program.cost = json.at("cost");
    const Json& verdict = json.at("verdict");
    plate.proof.passed = verdict.at("passed");
    plate.proof.faults = verdict.at("faults");
    plate.proof.first_fault = verdict.at("first_fault").get<std::string>();
    plate.proof.out_of_part_percent = verdict.at("out_of_part_percent");
    plate.proof.uncovered_skin_percent = verdict.at("uncovered_skin_percent");
    plate.proof.solid_fill_ratio = verdict.at("solid_fill_ratio");
    plate.proof.max_flow_mm3_per_s = verdict.at("max_flow_mm3_per_s");
    plate.proof.floating_islands = verdict.at("floating_islands");
    return plate;
}

Json step_part_json(const StepPartFacts& part) {
    return {{"id", part.id},
            {"file", "step/" + part.id + ".step"},
            {"bytes", part.bytes},
            {"faces", part.faces},
            {"planes", part.planes},
            {"cylinders", part.cylinders},
            {"cones", part.cones},
            {"tori", part.tori},
            {"removed_points", part.removed_points},
            {"decimation_mm", part.decimation_mm},
            {"sagitta_mm", part.sagitta_mm},
            {"volume_mm3", part.volume_mm3}};
}

StepPartFacts read_step_part(const Json& json) {
    StepPartFacts part;
    part.id = json.at("id");
    part.bytes = json.at("bytes");
    part.faces = json.at("faces");
    part.planes = json.at("planes");
    part.cylinders = json.at("cylinders");
    // Jobs of before had neither.
    part.cones = json.value("cones", std::size_t{0});
    part.tori = json.value("tori", std::size_t{0});
    part.removed_points = json.at("removed_points");
    part.decimation_mm = json.at("decimation_mm");
    part.sagitta_mm = json.at("sagitta_mm");
    part.volume_mm3 = json.at("volume_mm3");
    return part;
}

Json stage_json(const StageRecord& stage) {
    Json json{{"name", stage.name}, {"key", stage.key}, {"outputs", Json::array()}};
    for (const OutputFile& output : stage.outputs) {
        json["outputs"].push_back({{"path", output.path}, {"sha256", output.sha256}});
    }
    return json;
}

StageRecord read_stage(const Json& json) {
    StageRecord stage{json.at("name"), json.at("key"), {}};
    for (const Json& output : json.at("outputs")) {
        stage.outputs.push_back({output.at("path"), output.at("sha256")});
    }
    return stage;
}

JobFile read_all(const Json& json) {
    JobFile job;
    job.version = json.at("version");
    const Json& input = json.at("input");
    job.input = {input.at("name"), input.at("bytes"), input.at("sha256")};
    job.options = read_options(json);
    job.profile_sha256 = json.at("profile_sha256");
    job.finished = json.at("finished");
    job.model = read_model(json);
    job.decomposition = read_decomposition(json.at("decomposition"));
    for (const Json& part : json.at("parts")) {
        job.parts.push_back(read_part(part));
    }
    for (const Json& plate : json.at("plates")) {
        job.plates.push_back(read_plate(plate));
    }
    if (json.contains("step")) {
        for (const Json& part : json.at("step")) {
            job.step_parts.push_back(read_step_part(part));
        }
    }
    for (const Json& stage : json.at("stages")) {
        job.stages.push_back(read_stage(stage));
    }
    return job;
}

}  // namespace

const StageRecord* JobFile::stage(std::string_view name) const {
    const auto it =
        std::find_if(stages.begin(), stages.end(), [&](const auto& s) { return s.name == name; });
    return it == stages.end() ? nullptr : &*it;
}

const PartFacts* JobFile::part(std::string_view id) const {
    const auto it =
        std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.id == id; });
    return it == parts.end() ? nullptr : &*it;
}

std::string sidecar_path(const std::string& program) { return program + ".proof.json"; }

std::string program_path(const PlateFacts& plate) { return "plates/" + plate.name + ".gcode"; }

decomp::Pose<decomp::BedFrame, decomp::PartBedFrame> bed_from_part(
    const Eigen::Vector2d& offset_mm) {
    Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
    map.translation() = Eigen::Vector3d(offset_mm.x(), offset_mm.y(), 0);
    return decomp::Pose<decomp::BedFrame, decomp::PartBedFrame>(map);
}

std::string job_json(const JobFile& job) {
    Json json;
    json["schema"] = kSchema;
    json["version"] = job.version;
    json["input"] = {
        {"name", job.input.name}, {"bytes", job.input.bytes}, {"sha256", job.input.sha256}};
    json["machine"] = job.options.machine;
    json["material"] = job.options.material;
    json["profile_sha256"] = job.profile_sha256;
    json["options"] = options_json(job.options);
    json["finished"] = job.finished;
    json["model_from_file"] = numbers(job.model.model_from_file);
    json["model"] = model_json(job.model);
    json["decomposition"] = decomposition_json(job.decomposition);
    json["parts"] = Json::array();
    for (const PartFacts& part : job.parts) {
        json["parts"].push_back(part_json(job, part));
    }
    json["plates"] = Json::array();
    for (const PlateFacts& plate : job.plates) {
        json["plates"].push_back(plate_json(plate));
    }
    if (job.options.step.wanted) {
        json["step"] = Json::array();
        for (const StepPartFacts& part : job.step_parts) {
            json["step"].push_back(step_part_json(part));
        }
    }
    json["stages"] = Json::array();
    for (const StageRecord& stage : job.stages) {
        json["stages"].push_back(stage_json(stage));
    }
    return json.dump(1) + '\n';
}

Result<JobFile> parse_job_json(std::string_view text, const std::string& where) {
    try {
        const Json json = Json::parse(text);
        if (json.value("schema", "") != kSchema) {
            return fail("job.schema",
                        "the schema is '" + json.value("schema", "") + "', this version reads '" +
                            kSchema + "'",
                        where, "use the version of Hew that made the job, or make it again");
        }
        return read_all(json);
    } catch (const nlohmann::json::exception& error) {
        return fail("job.unreadable", std::string("not a job manifest: ") + error.what(), where,
                    "remove job.json and make the job again with --force");
    }
}

Result<JobFile> read_job(const std::filesystem::path& directory) {
    const std::filesystem::path path = directory / "job.json";
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return fail("job.not_a_job", "there is no job.json in this directory", directory.string(),
                    "give a directory that 'hew make -o DIRECTORY' wrote");
    }
    const auto text = decomp::read_file(path);
    if (!text) {
        return fail(text.error());
    }
    return parse_job_json(*text, path.string());
}

Result<JobFile> read_finished_job(const std::filesystem::path& directory) {
    auto job = read_job(directory);
    if (job && !job->finished) {
        return fail("job.unfinished", "the job was interrupted, its files may not belong together",
                    directory.string(),
                    "run 'hew make' again with the same options: it continues where it stood");
    }
    return job;
}

}  // namespace cam::job
