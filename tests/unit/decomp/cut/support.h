// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cut/complex.h"
#include "decomp/cut/written.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace tests {

using decomp::cut::Complex;
using decomp::part::Plane;

inline Complex complex_of(const TriMesh& mesh) {
    auto made = Complex::from_volume(mesh);
    EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().text());
    return std::move(*made);
}

/// Splits every region of the complex by a plane.
inline void split_all(Complex& complex, const Plane& plane) {
    const std::int32_t count = complex.region_count();
    for (std::int32_t region = 0; region < count; ++region) {
        const auto ids = complex.split(region, plane);
        ASSERT_TRUE(ids.has_value()) << ids.error().text();
    }
}

inline std::vector<std::int32_t> all_regions(const Complex& complex) {
    std::vector<std::int32_t> order;
    for (std::int32_t region = 0; region < complex.region_count(); ++region) {
        if (!complex.is_empty(region)) {
            order.push_back(region);
        }
    }
    return order;
}

using Corners = std::array<std::array<double, 3>, 3>;

/// Corners of a triangle, rotated so that the least comes first.
inline Corners corners_of(const TriMesh& mesh, std::size_t triangle, bool flip) {
    Corners c{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d& p = mesh.points[mesh.triangles[triangle].at(k)];
        c.at(k) = {p.x(), p.y(), p.z()};
    }
    if (flip) {
        std::swap(c[1], c[2]);
    }
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    return c;
}

/// Every cut triangle of a part occurs in the part that it names, bit for bit and the other way
/// round.
inline void expect_caps_match(const decomp::part::Assembly& assembly) {
    std::vector<std::multiset<std::pair<std::int32_t, Corners>>> caps(assembly.parts.size());
    std::vector<std::multiset<std::pair<std::int32_t, Corners>>> wanted(assembly.parts.size());
    for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
        const auto& part = assembly.parts[i];
        for (std::size_t t = 0; t < part.sources.size(); ++t) {
            if (part.sources[t].is_cut()) {
                const auto neighbour = static_cast<std::size_t>(part.sources[t].neighbour);
                caps[i].emplace(part.sources[t].neighbour, corners_of(part.mesh, t, false));
                wanted.at(neighbour).emplace(static_cast<std::int32_t>(i),
                                             corners_of(part.mesh, t, true));
            }
        }
    }
    EXPECT_EQ(caps, wanted);
}

/// Assembles all regions and asserts what must hold for every assembly.
inline decomp::part::Assembly expect_sound(const Complex& complex, const TriMesh& input) {
    EXPECT_TRUE(complex.volumes_sum_exactly());
    const auto assembly = complex.assemble(all_regions(complex), decomp::Run{});
    EXPECT_TRUE(assembly.has_value()) << (assembly ? "" : assembly.error().text());
    if (!assembly) {
        return {};
    }
    double volume = 0;
    for (const auto& part : assembly->parts) {
        const auto report = decomp::cut::check_written(part.mesh);
        EXPECT_TRUE(report.sound()) << part.id;
        EXPECT_EQ(part.sources.size(), part.mesh.triangles.size());
        volume += decomp::mesh::volume_mm3(part.mesh);
    }
    EXPECT_NEAR(volume, decomp::mesh::volume_mm3(input), 1e-11 * std::abs(volume));
    expect_caps_match(*assembly);
    return *assembly;
}

}  // namespace tests
