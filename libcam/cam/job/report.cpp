// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/report.h"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

namespace cam::job {

using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kSchema = "hew.report/1";

/// On the decimal grid, and never -0.
double rounded(double value, int decimals) {
    const double grid = std::pow(10.0, decimals);
    return std::round(value * grid) / grid + 0.0;
}

Json extent_json(const Eigen::Vector3d& extent) {
    return {rounded(extent.x(), 3), rounded(extent.y(), 3), rounded(extent.z(), 3)};
}

Json decomposition_json(const DecompositionFacts& facts) {
    Json planes = Json::array();
    for (const auto& plane : facts.planes) {
        planes.push_back({plane.normal.x() + 0.0, plane.normal.y() + 0.0, plane.normal.z() + 0.0,
                          plane.offset_mm + 0.0});
    }
    return {{"tier", facts.tier}, {"cuts", facts.cuts}, {"planes", planes}, {"notes", facts.notes}};
}

Json part_json(const JobFile& job, std::size_t index) {
    const PartFacts& part = job.parts[index];
    Json neighbours = Json::array();
    for (const auto& interface : job.decomposition.interfaces) {
        const auto self = static_cast<std::int32_t>(index);
        if (interface.part_a == self || interface.part_b == self) {
            const auto other = static_cast<std::size_t>(
                interface.part_a == self ? interface.part_b : interface.part_a);
            neighbours.push_back(job.parts.at(other).id);
        }
    }
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    return {{"id", part.id},
            {"triangles", part.triangles},
            {"volume_mm3", rounded(part.volume_mm3, 3)},
            {"extent_mm", extent_json(part.extent_mm)},
            {"base", part.base},
            {"support_area_mm2", rounded(part.support_area_mm2, 2)},
            {"neighbours", neighbours}};
}

Json plate_json(const PlateFacts& plate) {
    Json parts = Json::array();
    for (const PlacedPart& placed : plate.parts) {
        parts.push_back(placed.id);
    }
    const ProofFacts& proof = plate.proof;
    return {{"program", program_path(plate)},
            {"converted", plate.converted},
            {"parts", parts},
            {"seconds", rounded(plate.program.seconds, 0)},
            {"filament_mm", rounded(plate.program.filament_mm, 1)},
            {"filament_g", rounded(plate.program.filament_g, 2)},
            {"cost", rounded(plate.program.cost, 2)},
            {"proof",
             {{"passed", proof.passed},
              {"faults", proof.faults},
              {"first_fault", proof.first_fault},
              {"out_of_part_percent", rounded(proof.out_of_part_percent, 4)},
              {"uncovered_skin_percent", rounded(proof.uncovered_skin_percent, 4)},
              {"solid_fill_ratio", rounded(proof.solid_fill_ratio, 4)},
              {"max_flow_mm3_per_s", rounded(proof.max_flow_mm3_per_s, 3)},
              {"floating_islands", proof.floating_islands}}}};
}

}  // namespace

Totals totals_of(const JobFile& job) {
    Totals totals;
    totals.parts = job.parts.size();
    totals.plates = job.plates.size();
    totals.passed = !job.plates.empty();
    for (const PlateFacts& plate : job.plates) {
        totals.seconds += plate.program.seconds;
        totals.filament_mm += plate.program.filament_mm;
        totals.filament_g += plate.program.filament_g;
        totals.cost += plate.program.cost;
        totals.passed = totals.passed && plate.proof.passed;
    }
    return totals;
}

std::string report_json(const JobFile& job) {
    Json json;
    json["schema"] = kSchema;
    json["version"] = job.version;
    json["input"] = {{"name", job.input.name},
                     {"triangles", job.model.triangles},
                     {"extent_mm", extent_json(job.model.extent_mm)},
                     {"volume_mm3", rounded(job.model.volume_mm3, 3)}};
    json["machine"] = job.options.machine;
    json["repair"] = {{"status", job.model.repair_status},
                      {"changes", job.model.repair_changes},
                      {"volume_before_mm3", rounded(job.model.volume_before_mm3, 3)},
                      {"volume_after_mm3", rounded(job.model.volume_mm3, 3)},
                      {"hausdorff_mm", rounded(job.model.hausdorff_mm, 6)}};
    json["decomposition"] = decomposition_json(job.decomposition);
    json["parts"] = Json::array();
    for (std::size_t i = 0; i < job.parts.size(); ++i) {
        json["parts"].push_back(part_json(job, i));
    }
    json["interfaces"] = Json::array();
    for (const auto& interface : job.decomposition.interfaces) {
        json["interfaces"].push_back(
            {{"plane", interface.plane},
             {"parts", Json::array({job.parts.at(static_cast<std::size_t>(interface.part_a)).id,
                                    job.parts.at(static_cast<std::size_t>(interface.part_b)).id})},
             {"area_mm2", rounded(interface.area_mm2, 3)},
             {"neck_mm", rounded(job.decomposition.neck_mm(json["interfaces"].size()), 3)}});
    }
    json["plates"] = Json::array();
    for (const PlateFacts& plate : job.plates) {
        json["plates"].push_back(plate_json(plate));
    }
    if (job.options.step.wanted) {
        json["step"] = Json::array();
        for (const StepPartFacts& part : job.step_parts) {
            json["step"].push_back({{"file", "step/" + part.id + ".step"},
                                    {"bytes", part.bytes},
                                    {"faces", part.faces},
                                    {"planes", part.planes},
                                    {"cylinders", part.cylinders},
                                    {"cones", part.cones},
                                    {"tori", part.tori},
                                    {"decimation_mm", rounded(part.decimation_mm, 6)},
                                    {"sagitta_mm", rounded(part.sagitta_mm, 6)},
                                    {"volume_mm3", rounded(part.volume_mm3, 3)}});
        }
    }
    const Totals totals = totals_of(job);
    json["totals"] = {{"parts", totals.parts},
                      {"plates", totals.plates},
                      {"seconds", rounded(totals.seconds, 0)},
                      {"filament_mm", rounded(totals.filament_mm, 1)},
                      {"filament_g", rounded(totals.filament_g, 2)},
                      {"cost", rounded(totals.cost, 2)},
                      {"passed", totals.passed}};
    return json.dump(1) + '\n';
}

std::string timings_json(const std::vector<StageTiming>& timings) {
    Json json{{"schema", "hew.timings/1"}, {"stages", Json::array()}};
    double wall_s = 0;
    double cpu_s = 0;
    for (const StageTiming& timing : timings) {
        json["stages"].push_back({{"name", timing.name},
                                  {"kept", timing.kept},
                                  {"wall_s", rounded(timing.wall_s, 3)},
                                  {"cpu_s", rounded(timing.cpu_s, 3)}});
        wall_s += timing.wall_s;
        cpu_s += timing.cpu_s;
    }
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    json["total"] = {{"wall_s", rounded(wall_s, 3)},
                     {"cpu_s", rounded(cpu_s, 3)},
                     {"peak_mb", rounded(static_cast<double>(usage.ru_maxrss) / 1024.0, 1)}};
    return json.dump(1) + '\n';
}

}  // namespace cam::job
