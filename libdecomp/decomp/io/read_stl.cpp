// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/formats.h"
#include "decomp/io/text_scanner.h"

#include <cmath>
#include <cstring>

namespace decomp::io {

namespace {

static_assert(std::endian::native == std::endian::little,
              "STL is little-endian, and so is this reader");

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;
constexpr std::uint32_t kMostFacets = 1'400'000'000;  // three corners each must fit 32-bit indices

mesh::TriMesh triangles_of_triples(std::vector<Eigen::Vector3d> points) {
    mesh::TriMesh mesh;
    mesh.triangles.reserve(points.size() / 3);
    for (std::uint32_t i = 0; i + 2 < points.size(); i += 3) {
        mesh.triangles.push_back({i, i + 1, i + 2});
    }
    mesh.points = std::move(points);
    merge_equal_points(mesh);
    return mesh;
}

}  // namespace

Result<mesh::TriMesh> parse_stl_binary(std::string_view bytes, std::string_view name) {
    if (bytes.size() < kHeaderBytes) {
        return fail("io.truncated", "the file ends within the 84 bytes of a binary STL header",
                    std::string(name), "save or download the file again");
    }
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kHeaderBytes - 4, 4);
    if (count > kMostFacets) {
        return fail("io.too_large", "a header that announces " + std::to_string(count) + " facets",
                    std::string(name) + ": byte 80", "save the file again with fewer facets");
    }
    if ((bytes.size() - kHeaderBytes) / kFacetBytes < count) {
        return fail("io.truncated",
                    "the header announces " + std::to_string(count) + " facets, the file holds " +
                        std::to_string((bytes.size() - kHeaderBytes) / kFacetBytes),
                    std::string(name) + ": byte " + std::to_string(bytes.size()),
                    "save or download the file again");
    }
    std::vector<Eigen::Vector3d> points;
    points.reserve(std::size_t{3} * count);
    for (std::uint32_t facet = 0; facet < count; ++facet) {
        const std::size_t at = kHeaderBytes + kFacetBytes * facet + 12;
        float corner[9];
        std::memcpy(corner, bytes.data() + at, sizeof(corner));
        for (int k = 0; k < 9; k += 3) {
            const Eigen::Vector3d point(corner[k], corner[k + 1], corner[k + 2]);
            if (!point.allFinite()) {
                return fail("io.not_finite",
                            "facet " + std::to_string(facet) + " has a corner that is no number",
                            std::string(name) + ": byte " + std::to_string(at));
            }
            points.push_back(point);
        }
    }
    return triangles_of_triples(std::move(points));
}

Result<mesh::TriMesh> parse_stl_ascii(std::string_view bytes, std::string_view name) {
    TextScanner scanner(bytes, name, '\0');
    std::vector<Eigen::Vector3d> points;
    while (true) {
        const std::string_view word = scanner.word();
        if (word.empty()) {
            break;
        }
        if (equals_ignoring_case(word, "solid") || equals_ignoring_case(word, "endsolid")) {
            scanner.next_line();
            continue;
        }
        if (equals_ignoring_case(word, "endfacet") && points.size() % 3 != 0) {
            return scanner.error("io.syntax", "a facet that does not have three vertices");
        }
        if (!equals_ignoring_case(word, "vertex")) {
            continue;
        }
        Eigen::Vector3d point;
        for (int axis = 0; axis < 3; ++axis) {
            if (!scanner.number(point[axis])) {
                return scanner.expected("a coordinate");
            }
        }
        if (!point.allFinite()) {
            return scanner.error("io.not_finite", "a coordinate that is no number");
        }
        points.push_back(point);
    }
    if (points.size() % 3 != 0) {
        return scanner.error("io.truncated", "the file ends within a facet",
                             "save or download the file again");
    }
    if (points.size() / 3 > kMostFacets) {
        return scanner.error("io.too_large", "more facets than 32-bit indices can name");
    }
    return triangles_of_triples(std::move(points));
}

}  // namespace decomp::io
