// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/part_ply.h"

#include "decomp/base/file.h"
#include "decomp/io/byte_writer.h"
#include "decomp/io/formats.h"

namespace decomp::io {

namespace {

constexpr std::string_view kIdComment = "hew.part/1 id ";

}  // namespace

std::string part_ply_bytes(const part::Part& part) {
    const mesh::TriMesh& mesh = part.mesh;
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment unit mm\ncomment ";
    out += kIdComment;
    out += part.id + "\nelement vertex " + std::to_string(mesh.points.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
           std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nproperty int source\nproperty int neighbour\n"
           "property int patch\nend_header\n";
    out.reserve(out.size() + 24 * mesh.points.size() + 25 * mesh.triangles.size());
    for (const auto& point : mesh.points) {
        for (int axis = 0; axis < 3; ++axis) {
            append_raw(out, point[axis]);
        }
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        append_raw(out, std::uint8_t{3});
        for (const std::uint32_t corner : mesh.triangles[i]) {
            append_raw(out, corner);
        }
        const part::FacetSource source =
            i < part.sources.size() ? part.sources[i] : part::FacetSource{};
        append_raw(out, source.plane);
        append_raw(out, source.neighbour);
        append_raw(out, std::int32_t{-1});
    }
    return out;
}

Result<part::Part> parse_part_ply(std::string_view bytes, std::string_view name) {
    if (!bytes.starts_with("ply")) {
        return fail("io.unknown_format", "not a PLY file", std::string(name));
    }
    Result<PlyContents> ply = parse_ply(bytes, name, {"source", "neighbour"});
    if (!ply) {
        return fail(ply.error());
    }
    part::Part part;
    for (const std::string& comment : ply->comments) {
        if (comment.starts_with(kIdComment)) {
            part.id = comment.substr(kIdComment.size());
        }
    }
    part.mesh = std::move(ply->mesh);
    part.sources.resize(part.mesh.triangles.size());
    for (const auto& column : ply->columns) {
        if (!column.empty() && column.size() != part.sources.size()) {
            return fail("io.not_a_part", "a face without its source or neighbour",
                        std::string(name));
        }
    }
    for (std::size_t i = 0; i < part.sources.size(); ++i) {
        part.sources[i].plane = ply->columns[0].empty() ? -1 : ply->columns[0][i];
        part.sources[i].neighbour = ply->columns[1].empty() ? -1 : ply->columns[1][i];
    }
    return part;
}

Result<part::Part> read_part_ply(const std::filesystem::path& path) {
    const Result<std::string> bytes = read_file(path);
    if (!bytes) {
        return fail(bytes.error());
    }
    return parse_part_ply(*bytes, path.string());
}

}  // namespace decomp::io
