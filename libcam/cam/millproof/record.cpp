// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/record.h"

#include "decomp/base/hash.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace cam::millproof {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY and hashes are written as they lie");

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

std::array<std::uint8_t, 3> colour(double deviation, double range) {
    const double t = std::clamp(std::abs(deviation) / range, 0.0, 1.0);
    const auto strong = static_cast<std::uint8_t>(std::lround(70 + 185 * t));
    const auto weak = static_cast<std::uint8_t>(std::lround(190 * (1 - t)));
    if (deviation > range / 10) {
        return {strong, weak, 60};
    }
    if (deviation < -range / 10) {
        return {60, weak, strong};
    }
    return {90, 190, 90};
}

/// Heights of the part at the corners of squares, by its up-facing triangles; NaN where none is.
std::vector<double> part_heights(const MillJob& job, const Eigen::Vector2d& origin, double side,
                                 int columns, int rows) {
    std::vector<double> out(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                            std::nan(""));
    for (const decomp::mesh::Triangle& triangle : job.part->triangles) {
        const Eigen::Vector3d& a = job.part->points[triangle[0]];
        const Eigen::Vector3d& b = job.part->points[triangle[1]];
        const Eigen::Vector3d& c = job.part->points[triangle[2]];
        const double area2 = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
        if (!(area2 > 0)) {
            continue;
        }
        const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c);
        const Eigen::Vector3d high = a.cwiseMax(b).cwiseMax(c);
        const auto first = [&](int axis) {
            return std::max(0, static_cast<int>(std::ceil((low[axis] - origin[axis]) / side)));
        };
        for (int row = first(1); row < rows && origin.y() + row * side <= high.y(); ++row) {
            for (int column = first(0); column < columns && origin.x() + column * side <= high.x();
                 ++column) {
                const double x = origin.x() + column * side - a.x();
                const double y = origin.y() + row * side - a.y();
                const double u = (x * (c - a).y() - y * (c - a).x()) / area2;
                const double v = ((b - a).x() * y - (b - a).y() * x) / area2;
                if (u >= 0 && v >= 0 && u + v <= 1) {
                    double& at =
                        out[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                            static_cast<std::size_t>(column)];
                    const double z = a.z() + u * (b - a).z() + v * (c - a).z();
                    at = std::isnan(at) ? z : std::max(at, z);
                }
            }
        }
    }
    return out;
}

}  // namespace

std::string proof_json(const MillProof& proof, std::string_view program, const MillJob& job,
                       const ProofOptions& options, std::string_view profile_sha256) {
    using nlohmann::ordered_json;
    const Figures& f = proof.figures;
    ordered_json out;
    out["schema"] = "hew.millproof/1";
    out["checker"] = kMillCheckerVersion;
    out["passed"] = proof.passed();
    out["program_sha256"] = decomp::sha256_hex(program);
    out["part_sha256"] = hash_of(*job.part);
    out["profile_sha256"] = profile_sha256;
    out["dialect"] = job.dialect.name;
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

DeviationMesh deviation_mesh(const StockMap& stock, const MillJob& job, double range_mm, int step) {
    DeviationMesh out;
    const int columns = (stock.columns - 1) / step + 1;
    const int rows = (stock.rows - 1) / step + 1;
    const double side = stock.cell_mm * step;
    const Eigen::Vector2d origin = stock.origin.array() + stock.cell_mm / 2;
    const std::vector<double> part = part_heights(job, origin, side, columns, rows);
    const auto index = [&](int column, int row) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const float z = stock.height[static_cast<std::size_t>(row * step) *
                                             static_cast<std::size_t>(stock.columns) +
                                         static_cast<std::size_t>(column * step)];
            out.mesh.points.emplace_back(origin.x() + column * side, origin.y() + row * side, z);
        }
    }
    for (int row = 0; row + 1 < rows; ++row) {
        for (int column = 0; column + 1 < columns; ++column) {
            const std::size_t a = index(column, row);
            const std::size_t corners[4] = {a, a + 1, index(column + 1, row + 1),
                                            index(column, row + 1)};
            // The mildest corner: on a wall one lies below and one above.
            double deviation = std::nan("");
            for (const std::size_t corner : corners) {
                const double here = out.mesh.points[corner].z() - part[corner];
                if (!std::isnan(here) &&
                    (std::isnan(deviation) || std::abs(here) < std::abs(deviation))) {
                    deviation = here;
                }
            }
            const std::array<std::uint8_t, 3> paint =
                std::isnan(deviation) ? std::array<std::uint8_t, 3>{170, 170, 170}
                                      : colour(deviation, range_mm);
            const auto at = [&](int i) { return static_cast<std::uint32_t>(corners[i]); };
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
        append(out, Eigen::Vector3f(point.cast<float>()));
    }
    for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
        append(out, std::uint8_t{3});
        append(out, mesh.mesh.triangles[i]);
        append(out, mesh.colours[i]);
    }
    return out;
}

}  // namespace cam::millproof
