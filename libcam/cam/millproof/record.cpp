// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/record.h"

#include "cam/millproof/heights.h"
#include "decomp/base/hash.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace cam::millproof {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY and hashes are written as they lie");

constexpr const char* kSchema = "hew.millproof/1";
constexpr const char* kAgain = "plan and prove it again: hew mill";

template <class T>
void append(std::string& to, const T& value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    to.append(bytes, sizeof(T));
}

std::string hash_of(const decomp::mesh::TriMesh& mesh) {
    std::string bytes;
    for (const Eigen::Vector3d& point : mesh.points) {
        append(bytes, point.x());
        append(bytes, point.y());
        append(bytes, point.z());
    }
    for (const decomp::mesh::Triangle& triangle : mesh.triangles) {
        append(bytes, triangle);
    }
    return decomp::sha256_hex(bytes);
}

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

/// Heights of the part at the corners of squares, by its up-facing triangles; NaN where none is.
std::vector<double> part_heights(const MillJob& job, const Nodes& corners) {
    std::vector<double> out(corners.count(), std::nan(""));
    for (const decomp::mesh::Triangle& triangle : job.part->triangles) {
        visit_nodes(*job.part, triangle, corners, [&](std::size_t corner, double z) {
            double& at = out[corner];
            at = std::isnan(at) ? z : std::max(at, z);
        });
    }
    return out;
}

/// The colour of a square by its mildest corner: on a wall one lies below and one above.
std::array<std::uint8_t, 3> colour_of(const std::array<double, 4>& deviations, double range) {
    double mildest = std::nan("");
    for (const double here : deviations) {
        if (!std::isnan(here) && (std::isnan(mildest) || std::abs(here) < std::abs(mildest))) {
            mildest = here;
        }
    }
    return deviation_colour(mildest, range);
}

}  // namespace

std::array<std::uint8_t, 3> deviation_colour(double deviation_mm, double range_mm) {
    if (std::isnan(deviation_mm)) {
        return {170, 170, 170};
    }
    const double t = std::clamp(std::abs(deviation_mm) / range_mm, 0.0, 1.0);
    const auto strong = static_cast<std::uint8_t>(std::lround(70 + 185 * t));
    const auto weak = static_cast<std::uint8_t>(std::lround(190 * (1 - t)));
    if (deviation_mm > range_mm / 10) {
        return {strong, weak, 60};
    }
    if (deviation_mm < -range_mm / 10) {
        return {60, weak, strong};
    }
    return {90, 190, 90};
}

std::string proof_json(const MillProof& proof, std::string_view program, const MillJob& job,
                       const ProofOptions& options, std::string_view profile_sha256) {
    using nlohmann::ordered_json;
    const Figures& f = proof.figures;
    ordered_json out;
    out["schema"] = kSchema;
    out["checker"] = kMillCheckerVersion;
    out["passed"] = proof.passed();
    out["program_sha256"] = decomp::sha256_hex(program);
    out["part_sha256"] = hash_of(*job.part);
    out["profile_sha256"] = profile_sha256;
    out["dialect"] = job.dialect.name;
    out["tools"] = ordered_json::array();
    for (const ProofTool& tool : job.tools) {
        out["tools"].push_back(tool.tool.name);
    }
    out["options"] = {{"cell_mm", options.cell_mm},
                      {"sample_mm", options.sample_mm},
                      {"max_gouge_mm", options.max_gouge_mm},
                      {"max_excess_mm", options.max_excess_mm},
                      {"reach_mm", options.reach_mm}};
    out["figures"] = {{"lines", f.lines},
                      {"cut_mm", rounded(f.cut_mm)},
                      {"rapid_mm", rounded(f.rapid_mm)},
                      {"seconds", rounded(f.seconds)},
                      {"max_gouge_mm", rounded(f.max_gouge_mm)},
                      {"max_excess_mm", rounded(f.max_excess_mm)},
                      {"excess_999_mm", rounded(f.excess_999_mm)},
                      {"unreachable", rounded(f.unreachable)},
                      {"left", rounded(f.left)},
                      {"rapid_hits", f.rapid_hits}};
    out["faults"] = ordered_json::array();
    for (const Fault& fault : proof.faults) {
        out["faults"].push_back({{"kind", fault.kind}, {"line", fault.line}, {"what", fault.what}});
    }
    return out.dump(1) + "\n";
}

bool is_mill_record(std::string_view text) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    return json.is_object() && json.contains("schema") && json["schema"] == kSchema;
}

decomp::Result<MillRecord> read_proof_json(std::string_view text) {
    try {
        const auto json = nlohmann::json::parse(text);
        if (json.at("schema").get<std::string>() != kSchema) {
            return decomp::fail("proof.bad_sidecar", "the schema is not " + std::string(kSchema),
                                "schema", kAgain);
        }
        MillRecord record;
        json.at("checker").get_to(record.checker);
        json.at("passed").get_to(record.passed);
        json.at("program_sha256").get_to(record.program_sha256);
        json.at("profile_sha256").get_to(record.profile_sha256);
        json.at("tools").get_to(record.tools);
        record.faults = json.at("faults").size();
        if (record.passed != (record.faults == 0)) {
            return decomp::fail("proof.bad_sidecar", "\"passed\" contradicts the faults", "passed",
                                kAgain);
        }
        return record;
    } catch (const nlohmann::json::exception& exception) {
        return decomp::fail("proof.bad_sidecar", exception.what(), {}, kAgain);
    }
}

decomp::Status accept(const MillRecord& record, std::string_view program,
                      std::string_view profile_sha256) {
    if (record.program_sha256 != decomp::sha256_hex(program)) {
        return decomp::fail("proof.stale", "the program is not the one that was proved", {},
                            kAgain);
    }
    if (record.profile_sha256 != profile_sha256) {
        return decomp::fail("proof.stale", "machine or tools are not those of the proof", {},
                            kAgain);
    }
    if (record.checker != kMillCheckerVersion) {
        return decomp::fail("proof.stale", "the proof is of another checker", {}, kAgain);
    }
    if (!record.passed) {
        return decomp::fail("proof.failed",
                            std::to_string(record.faults) + " fault(s) in the program");
    }
    return {};
}

DeviationMesh deviation_mesh(const StockMap& stock, const MillJob& job, double range_mm, int step) {
    DeviationMesh out;
    Nodes nodes;
    nodes.origin = stock.origin.array() + stock.cell_mm / 2;
    nodes.side = stock.cell_mm * step;
    nodes.columns = (stock.columns - 1) / step + 1;
    nodes.rows = (stock.rows - 1) / step + 1;
    const std::vector<double> part = part_heights(job, nodes);
    std::vector<Eigen::Vector3d>& points = out.mesh.points;
    points.reserve(nodes.count());
    for (int row = 0; row < nodes.rows; ++row) {
        for (int column = 0; column < nodes.columns; ++column) {
            const float z =
                stock.height[static_cast<std::size_t>(row) * static_cast<std::size_t>(step) *
                                 static_cast<std::size_t>(stock.columns) +
                             static_cast<std::size_t>(column) * static_cast<std::size_t>(step)];
            points.emplace_back(nodes.origin.x() + column * nodes.side,
                                nodes.origin.y() + row * nodes.side, z);
        }
    }
    for (int row = 0; row + 1 < nodes.rows; ++row) {
        for (int column = 0; column + 1 < nodes.columns; ++column) {
            const std::array<std::size_t, 4> corners{
                nodes.index(column, row), nodes.index(column + 1, row),
                nodes.index(column + 1, row + 1), nodes.index(column, row + 1)};
            std::array<double, 4> deviations{};
            for (std::size_t i = 0; i < 4; ++i) {
                deviations[i] = points[corners[i]].z() - part[corners[i]];
            }
            const std::array<std::uint8_t, 3> paint = colour_of(deviations, range_mm);
            const auto at = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[i]); };
            out.mesh.triangles.push_back({at(0), at(1), at(2)});
            out.mesh.triangles.push_back({at(0), at(2), at(3)});
            out.colours.push_back(paint);
            out.colours.push_back(paint);
        }
    }
    return out;
}

std::string deviation_ply(const DeviationMesh& mesh) {
    std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(mesh.mesh.points.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(mesh.mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\nproperty uchar red\n"
                      "property uchar green\nproperty uchar blue\nend_header\n";
    for (const Eigen::Vector3d& point : mesh.mesh.points) {
        append(out, static_cast<float>(point.x()));
        append(out, static_cast<float>(point.y()));
        append(out, static_cast<float>(point.z()));
    }
    for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
        append(out, std::uint8_t{3});
        append(out, mesh.mesh.triangles[i]);
        append(out, mesh.colours[i]);
    }
    return out;
}

}  // namespace cam::millproof
