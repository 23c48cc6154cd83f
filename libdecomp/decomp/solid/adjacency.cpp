// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/adjacency.h"

#include <algorithm>
#include <tuple>

namespace decomp::solid {

Result<Adjacency> adjacency_of(const mesh::TriMesh& mesh) {
    struct Row {
        std::uint32_t low = 0;
        std::uint32_t high = 0;
        std::uint32_t half_edge = 0;
    };

    std::vector<Row> rows;
    const auto count = static_cast<std::uint32_t>(3 * mesh.triangles.size());
    rows.reserve(count);
    for (std::uint32_t h = 0; h < count; ++h) {
        const std::uint32_t a = start_of(mesh, h);
        const std::uint32_t b = end_of(mesh, h);
        rows.push_back({std::min(a, b), std::max(a, b), h});
    }
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
        return std::tie(a.low, a.high, a.half_edge) < std::tie(b.low, b.high, b.half_edge);
    });
    Adjacency adjacency;
    adjacency.twin.resize(count);
    for (std::size_t i = 0; i < rows.size(); i += 2) {
        const auto same = [&](std::size_t j) {
            return j < rows.size() && rows[j].low == rows[i].low && rows[j].high == rows[i].high;
        };
        if (!same(i + 1) || same(i + 2) ||
            start_of(mesh, rows[i].half_edge) == start_of(mesh, rows[i + 1].half_edge)) {
            return fail("solid.not_closed", "the mesh is not the surface of a solid",
                        "edge of points " + std::to_string(rows[i].low) + " and " +
                            std::to_string(rows[i].high),
                        "repair the mesh first");
        }
        adjacency.twin[rows[i].half_edge] = rows[i + 1].half_edge;
        adjacency.twin[rows[i + 1].half_edge] = rows[i].half_edge;
    }
    return adjacency;
}

}  // namespace decomp::solid
