// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/proof_json.h"

#include "decomp/base/hash.h"
#include "decomp/base/number.h"

#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

namespace cam::verify {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "hew.proof/1";

void append_word(std::string& bytes, std::uint64_t value, int count) {
    for (int k = 0; k < count; ++k) {
        bytes += static_cast<char>(value >> (8U * static_cast<unsigned>(k)) & 0xFFU);
    }
}

/// Rounded so that the text does not depend on the last bits of a sum.
double rounded(double value) { return std::round(value * 1e6) / 1e6; }

/// One table drives writing and reading of the figures.
template <class Body>
void for_each_figure(Figures& f, const Body& body) {
    body("lines", f.lines);
    body("layers", f.layers);
    body("filament_mm", f.filament_mm);
    body("extruded_mm3", f.extruded_mm3);
    body("max_flow_mm3_per_s", f.max_flow_mm3_per_s);
    body("out_of_part_mm3", f.out_of_part_mm3);
    body("out_of_part_percent", f.out_of_part_percent);
    body("uncovered_skin_percent", f.uncovered_skin_percent);
    body("worst_layer_uncovered_percent", f.worst_layer_uncovered_percent);
    body("solid_fill_ratio", f.solid_fill_ratio);
    body("solid_layers", f.solid_layers);
    body("floating_islands", f.floating_islands);
    body("hanging_mm2", f.hanging_mm2);
    body("moves_below_printed", f.moves_below_printed);
    body("moves_outside_chamber", f.moves_outside_chamber);
    body("blob_mm3", f.blob_mm3);
    body("declared_mm3", f.declared_mm3);
    body("air_percent", f.air_percent);
    body("internal_bridge_percent", f.internal_bridge_percent);
    body("first_layer_mm2", f.first_layer_mm2);
    body("first_layer_percent", f.first_layer_percent);
    body("support_contact_mm2", f.support_contact_mm2);
    body("round_holes", f.round_holes);
    body("hole_error_mm", f.hole_error_mm);
    body("worst_hole_error_mm", f.worst_hole_error_mm);
    body("outer_walls", f.outer_walls);
    body("mating_walls", f.mating_walls);
    body("mating_seams_percent", f.mating_seams_percent);
}

void read_record(const Json& json, ProofRecord& record) {
    record.checker = json.at("checker").get<int>();
    record.program_sha256 = json.at("program_sha256").get<std::string>();
    record.profile_sha256 = json.at("profile_sha256").get<std::string>();
    for (const Json& part : json.at("parts")) {
        record.parts.push_back(
            {part.at("id").get<std::string>(), part.at("sha256").get<std::string>()});
    }
    const Json& figures = json.at("figures");
    for_each_figure(record.proof.figures,
                    [&](const char* key, auto& value) { figures.at(key).get_to(value); });
    for (const Json& fault : json.at("faults")) {
        record.proof.faults.push_back({fault.at("code").get<std::string>(),
                                       fault.at("line").get<long>(), fault.at("layer").get<int>(),
                                       fault.at("text").get<std::string>()});
    }
    for (const Json& note : json.at("notes")) {
        record.proof.notes.push_back(note.get<std::string>());
    }
}

}  // namespace

std::string mesh_hash(const decomp::mesh::TriMesh& mesh) {
    std::string bytes;
    bytes.reserve(16 + mesh.points.size() * 24 + mesh.triangles.size() * 12);
    append_word(bytes, mesh.points.size(), 8);
    append_word(bytes, mesh.triangles.size(), 8);
    for (const Eigen::Vector3d& point : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) {
            append_word(bytes, std::bit_cast<std::uint64_t>(point[axis]), 8);
        }
    }
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t index : triangle) {
            append_word(bytes, index, 4);
        }
    }
    return decomp::sha256_hex(bytes);
}

ProofRecord proof_record(std::string_view program, const std::vector<PlacedPart>& parts,
                         const profile::FdmSetup& setup, Proof proof) {
    ProofRecord record;
    record.program_sha256 = decomp::sha256_hex(program);
    record.profile_sha256 = setup.hash;
    for (const PlacedPart& part : parts) {
        record.parts.push_back({part.id, mesh_hash(part.mesh)});
    }
    record.proof = std::move(proof);
    return record;
}

std::string proof_json(const ProofRecord& record) {
    Json json;
    json["schema"] = kSchema;
    json["checker"] = record.checker;
    json["program_sha256"] = record.program_sha256;
    json["profile_sha256"] = record.profile_sha256;
    json["parts"] = Json::array();
    for (const PartHash& part : record.parts) {
        json["parts"].push_back({{"id", part.id}, {"sha256", part.sha256}});
    }
    json["passed"] = record.proof.passed();
    Figures figures = record.proof.figures;
    for_each_figure(figures, [&](const char* key, auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
            json["figures"][key] = rounded(value);
        } else {
            json["figures"][key] = value;
        }
    });
    json["faults"] = Json::array();
    for (const Fault& fault : record.proof.faults) {
        json["faults"].push_back({{"code", fault.code},
                                  {"line", fault.line},
                                  {"layer", fault.layer},
                                  {"text", fault.text}});
    }
    json["notes"] = record.proof.notes;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

decomp::Result<ProofRecord> read_proof_json(std::string_view text) {
    const char* hint = "prove the program again: hew verify";
    try {
        const Json json = Json::parse(text);
        if (json.at("schema").get<std::string>() != kSchema) {
            return decomp::fail("proof.bad_sidecar", "the schema is not hew.proof/1", "schema",
                                hint);
        }
        ProofRecord record;
        read_record(json, record);
        if (json.at("passed").get<bool>() != record.proof.passed()) {
            return decomp::fail("proof.bad_sidecar", "\"passed\" contradicts the faults", "passed",
                                hint);
        }
        return record;
    } catch (const Json::exception& exception) {
        return decomp::fail("proof.bad_sidecar", exception.what(), {}, hint);
    }
}

decomp::Status accept(const ProofRecord& record, std::string_view program,
                      std::string_view profile_sha256) {
    const char* hint = "prove the program again: hew verify";
    if (record.program_sha256 != decomp::sha256_hex(program)) {
        return decomp::fail("proof.stale", "the program is not the one that was proved", {}, hint);
    }
    if (record.profile_sha256 != profile_sha256) {
        return decomp::fail("proof.stale", "the profile is not the one of the proof", {}, hint);
    }
    if (record.checker != kCheckerVersion) {
        return decomp::fail("proof.stale", "the proof is of another checker", {}, hint);
    }
    if (!record.proof.passed()) {
        return decomp::fail("proof.failed", std::to_string(record.proof.faults.size()) +
                                                " fault(s) in the program");
    }
    return {};
}

}  // namespace cam::verify
