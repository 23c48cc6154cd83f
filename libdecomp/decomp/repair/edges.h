// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace decomp::repair {

/// Side k of a triangle runs from corner k to corner k + 1.
struct Side {
    std::uint32_t low = 0;   ///< the lower of its two points
    std::uint32_t high = 0;  ///< the higher
    std::uint32_t triangle = 0;
    std::uint8_t k = 0;
    bool forward = false;  ///< runs from low to high

    [[nodiscard]] bool same_edge(const Side& other) const {
        return low == other.low && high == other.high;
    }

    // clang-tidy 14 sees a null pointer in the comparison that the compiler makes.
    // NOLINTNEXTLINE(modernize-use-nullptr)
    auto operator<=>(const Side&) const = default;
};

/// All sides, those of one edge together; triangles in rising order within an edge.
inline std::vector<Side> sorted_sides(const mesh::TriMesh& mesh) {
    std::vector<Side> sides;
    sides.reserve(mesh.triangles.size() * 3);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::uint8_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[i].at(k);
            const std::uint32_t b = mesh.triangles[i].at((k + 1U) % 3);
            sides.push_back({std::min(a, b), std::max(a, b), i, k, a < b});
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

/// Calls visit(begin, end) for the sides of each edge.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, Visit visit) {
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        for (end = begin; end < sides.size() && sides[end].same_edge(sides[begin]); ++end) {
        }
        visit(begin, end);
    }
}

/// Union-find; the lowest member names its set.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }

    void unite(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t root_a = find(a);
        const std::uint32_t root_b = find(b);
        parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace decomp::repair
