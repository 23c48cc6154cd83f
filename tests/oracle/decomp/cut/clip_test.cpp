// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/rng.h"
#include "decomp/io/read_mesh.h"
#include "tests/oracle/decomp/cut/cgal_clip.h"
#include "tests/unit/decomp/cut/support.h"

#include <cstdlib>

using decomp::cut::Complex;
using decomp::part::Plane;

namespace {

/// Volume of all regions below the plane.
double volume_below(const decomp::mesh::TriMesh& mesh, const Plane& plane) {
    Complex complex = tests::complex_of(mesh);
    double below = 0;
    const std::int32_t count = complex.region_count();
    for (std::int32_t region = 0; region < count; ++region) {
        const auto ids = complex.split(region, plane);
        EXPECT_TRUE(ids.has_value());
        for (const std::int32_t id : *ids) {
            const auto part = complex.region(id);
            double lowest = 0;
            for (const auto& p : part.mesh.points) {
                const double height = plane.normal.dot(p) - plane.offset_mm;
                lowest = std::abs(height) > std::abs(lowest) ? height : lowest;
            }
            below += lowest < 0 ? complex.volume_mm3(id) : 0;
        }
    }
    return below;
}

void compare(const decomp::mesh::TriMesh& mesh, std::uint64_t seed, int planes) {
    decomp::Rng rng(seed);
    const double volume = decomp::mesh::volume_mm3(mesh);
    const double diagonal = decomp::mesh::diagonal_mm(mesh);
    const Eigen::Vector3d centre = decomp::mesh::bounds(mesh).center();
    int compared = 0;
    for (int i = 0; i < planes; ++i) {
        const Eigen::Vector3d normal(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
        const Plane plane{normal.normalized(),
                          normal.normalized().dot(centre) + rng.uniform(-0.2, 0.2) * diagonal};
        const auto oracle = tests::clipped_volume(mesh, plane);
        if (oracle) {
            EXPECT_NEAR(volume_below(mesh, plane), *oracle, 1e-9 * volume) << i;
            ++compared;
        }
    }
    EXPECT_GE(2 * compared, planes);  // the oracle must not refuse most of them
}

}  // namespace

TEST(ClipOracle, AgreesOnTorusSphereAndHollowBall) {
    compare(tests::torus(10, 3, 60, 30), 1, 10);
    compare(tests::sphere(10, 60, 29), 2, 10);
    compare(tests::joined(tests::sphere(10, 30, 15), tests::flipped(tests::sphere(6, 30, 15))), 3,
            10);
}

TEST(ClipOracle, AgreesOnRealMeshes) {
    const char* folder = std::getenv("HEW_MODELS");
    if (folder == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    for (const char* name :
         {"paper/hfd_maxplank.obj", "paper/cinolib_3holes.obj", "real/od_spot.obj"}) {
        const auto mesh =
            decomp::io::read_mesh(std::string(folder) + "/" + name, {}, decomp::Run{});
        ASSERT_TRUE(mesh.has_value()) << name;
        compare(*mesh, 5, 3);
    }
}

TEST(CorefinementOracle, AgreesOnTheOverlapWithABox) {
    // Six planes in a row leave the same volume as the intersection with the box that they bound.
    const auto mesh = tests::torus(10, 3, 60, 30);
    const Eigen::Vector3d low(-3.1, -2.2, -1.3);
    const Eigen::Vector3d high(12.4, 9.7, 2.1);
    Complex complex = tests::complex_of(mesh);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        tests::split_all(complex, {Eigen::Vector3d::Unit(axis), low[axis]});
        tests::split_all(complex, {Eigen::Vector3d::Unit(axis), high[axis]});
    }
    double inside = 0;
    for (const std::int32_t region : tests::all_regions(complex)) {
        const Eigen::AlignedBox3d box = decomp::mesh::bounds(complex.region(region).mesh);
        const bool within =
            (box.min().array() >= low.array()).all() && (box.max().array() <= high.array()).all();
        inside += within ? complex.volume_mm3(region) : 0;
    }
    const auto oracle = tests::common_volume(mesh, tests::box(low, high));
    ASSERT_TRUE(oracle.has_value());
    EXPECT_GT(*oracle, 0);
    EXPECT_NEAR(inside, *oracle, 1e-9 * *oracle);
}
