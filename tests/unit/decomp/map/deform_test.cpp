// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/deform.h"

#include "decomp/mesh/measure.h"
#include "decomp/tets/tetrahedralise.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace {

using namespace decomp;

/// Mean of |n_x| + |n_y| + |n_z| by the area of the surface.
double misalignment(const mesh::TriMesh& surface, const std::vector<Eigen::Vector3d>& normals) {
    double sum = 0;
    double area = 0;
    for (std::size_t t = 0; t < normals.size(); ++t) {
        const double mine = mesh::double_area_normal(surface, t).norm();
        sum += mine * normals[t].lpNorm<1>();
        area += mine;
    }
    return sum / area;
}

TEST(Deform, TurnsTheNormalsOfASphereTowardsTheAxes) {
    const auto surface = tests::sphere(10, 32, 17);
    decomp::Run run;
    const auto tets = tets::tetrahedralise(surface, run);
    ASSERT_TRUE(tets.has_value());
    const auto still = map::deformed_normals(*tets, surface, {.pull = 0, .stages = 1}, run);
    ASSERT_EQ(still.size(), surface.triangles.size());
    EXPECT_NEAR(misalignment(surface, still), 1.5, 0.02);  // the mean over a sphere
    const auto weak = map::deformed_normals(*tets, surface, {.pull = 0.3}, run);
    const auto strong = map::deformed_normals(*tets, surface, {.pull = 3}, run);
    EXPECT_LT(misalignment(surface, weak), misalignment(surface, still));
    EXPECT_LT(misalignment(surface, strong), misalignment(surface, weak) - 0.05);
    for (const Eigen::Vector3d& normal : strong) {
        EXPECT_NEAR(normal.norm(), 1, 1e-12);
    }
}

TEST(Deform, LeavesABoxAlone) {
    const auto surface = tests::box({0, 0, 0}, {3, 2, 1});
    decomp::Run run;
    const auto tets = tets::tetrahedralise(surface, run);
    ASSERT_TRUE(tets.has_value());
    const auto normals = map::deformed_normals(*tets, surface, {}, run);
    for (std::size_t t = 0; t < normals.size(); ++t) {
        EXPECT_GT(normals[t].dot(mesh::double_area_normal(surface, t).normalized()), 0.999);
    }
}

}  // namespace
