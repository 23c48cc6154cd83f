// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/formats.h"
#include "decomp/io/text_scanner.h"

#include <algorithm>
#include <limits>

namespace decomp::io {

namespace {

constexpr std::int64_t kMostPoints = std::numeric_limits<std::uint32_t>::max();

/// Extra numbers that follow the three coordinates of a vertex, from the letters before "OFF".
int extra_numbers(std::string_view keyword) {
    const std::string_view letters = keyword.substr(0, keyword.size() - 3);
    int extra = 0;
    extra += letters.find("ST") != std::string_view::npos ? 2 : 0;
    extra += letters.find('N') != std::string_view::npos ? 3 : 0;
    return extra;
}

Status read_vertices(TextScanner& scanner, std::int64_t count, bool has_colours, int extra,
                     mesh::TriMesh& mesh) {
    mesh.points.reserve(std::min(static_cast<std::size_t>(count), scanner.rest() / 6));
    for (std::int64_t i = 0; i < count; ++i) {
        Eigen::Vector3d point;
        for (int axis = 0; axis < 3; ++axis) {
            if (!scanner.number(point[axis])) {
                return scanner.expected("a coordinate");
            }
        }
        if (!point.allFinite()) {
            return scanner.error("io.not_finite", "a coordinate that is no number");
        }
        mesh.points.push_back(point);
        double ignored = 0;
        for (int k = 0; k < extra && !has_colours; ++k) {
            if (!scanner.number(ignored)) {
                return scanner.expected("a number");
            }
        }
        if (has_colours) {  // three or four numbers, so the rest of the line
            scanner.next_line();
        }
    }
    return {};
}

Status read_faces(TextScanner& scanner, std::int64_t count, mesh::TriMesh& mesh) {
    mesh.triangles.reserve(std::min(static_cast<std::size_t>(count), scanner.rest() / 8));
    std::vector<std::uint32_t> corners;
    for (std::int64_t i = 0; i < count; ++i) {
        std::int64_t sides = 0;
        if (!scanner.integer(sides)) {
            return scanner.expected("the number of corners of a face");
        }
        if (sides < 0 || static_cast<std::size_t>(sides) > scanner.rest()) {
            return scanner.error("io.syntax", "a face with " + std::to_string(sides) + " corners");
        }
        corners.clear();
        for (std::int64_t k = 0; k < sides; ++k) {
            std::int64_t corner = 0;
            if (!scanner.integer(corner)) {
                return scanner.expected("the number of a vertex");
            }
            if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.points.size()) {
                return scanner.error("io.index_out_of_range",
                                     "a face names vertex " + std::to_string(corner) + " of " +
                                         std::to_string(mesh.points.size()) + " (the first is 0)");
            }
            corners.push_back(static_cast<std::uint32_t>(corner));
        }
        append_polygon(mesh, corners);
        scanner.next_line();  // a colour may follow
    }
    return {};
}

}  // namespace

Result<mesh::TriMesh> parse_off(std::string_view bytes, std::string_view name) {
    TextScanner scanner(bytes, name);
    TextScanner ahead = scanner;
    const std::string_view keyword = ahead.word();
    int extra = 0;
    bool has_colours = false;
    if (keyword.ends_with("OFF")) {
        const std::string_view letters = keyword.substr(0, keyword.size() - 3);
        if (letters.find_first_of("4n") != std::string_view::npos) {
            return ahead.error("io.unsupported", "an OFF file of a dimension other than 3");
        }
        if (ahead.word_in_line() == "BINARY") {
            return ahead.error("io.unsupported", "a binary OFF file",
                               "save it as ASCII OFF, PLY or STL");
        }
        has_colours = letters.find('C') != std::string_view::npos;
        extra = extra_numbers(keyword);
        scanner.word();
    }
    std::int64_t vertices = 0;
    std::int64_t faces = 0;
    if (!scanner.integer(vertices) || !scanner.integer(faces)) {
        return scanner.expected("the number of vertices and faces");
    }
    if (vertices < 0 || faces < 0 || vertices > kMostPoints || faces > kMostPoints) {
        return scanner.error("io.too_large", "a header with counts outside 0 to 4294967295");
    }
    scanner.next_line();  // the number of edges, which nobody keeps
    mesh::TriMesh mesh;
    if (Status status = read_vertices(scanner, vertices, has_colours, extra, mesh); !status) {
        return fail(status.error());
    }
    if (Status status = read_faces(scanner, faces, mesh); !status) {
        return fail(status.error());
    }
    return mesh;
}

}  // namespace decomp::io
