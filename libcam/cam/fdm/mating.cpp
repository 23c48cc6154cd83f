// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/mating.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace cam::fdm {

namespace {

struct GridPoint {
    std::int64_t x, y, z;
};

/// Where the triangle's sides meet the height: two points, or none.
polygon::Path section(const std::array<GridPoint, 3>& corners, std::int64_t z) {
    polygon::Path out;
    for (std::size_t i = 0; i < 3; ++i) {
        const GridPoint& a = corners.at(i);
        const GridPoint& b = corners.at((i + 1) % 3);
        if ((a.z < z) != (b.z < z)) {
            const double t = static_cast<double>(z - a.z) / static_cast<double>(b.z - a.z);
            out.push_back({a.x + std::llround(t * static_cast<double>(b.x - a.x)),
                           a.y + std::llround(t * static_cast<double>(b.y - a.y))});
        }
    }
    return out;
}

}  // namespace

std::vector<polygon::Paths> mating_lines(const decomp::mesh::TriMesh& mesh,
                                         const std::vector<bool>& mating,
                                         const std::vector<std::int64_t>& heights) {
    std::vector<polygon::Paths> out(heights.size());
    for (std::size_t i = 0; i < mating.size() && i < mesh.triangles.size(); ++i) {
        if (!mating[i]) {
            continue;
        }
        std::array<GridPoint, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& p = mesh.points[mesh.triangles[i].at(k)];
            corners.at(k) = {polygon::nanometres(p.x()), polygon::nanometres(p.y()),
                             polygon::nanometres(p.z())};
        }
        const auto [low, high] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
        const auto first = std::upper_bound(heights.begin(), heights.end(), low);
        const auto last = std::upper_bound(first, heights.end(), high);
        for (auto z = first; z != last; ++z) {
            polygon::Path line = section(corners, *z);
            if (line.size() == 2 && line[0] != line[1]) {
                out[static_cast<std::size_t>(z - heights.begin())].push_back(std::move(line));
            }
        }
    }
    return out;
}

}  // namespace cam::fdm
