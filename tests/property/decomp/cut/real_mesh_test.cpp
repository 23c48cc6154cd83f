// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/rng.h"
#include "decomp/io/read_mesh.h"
#include "tests/unit/decomp/cut/support.h"

#include <cstdlib>
#include <iostream>
#include <map>

using decomp::cut::Complex;
using decomp::part::Plane;

class RealMesh : public testing::TestWithParam<const char*> {};

TEST_P(RealMesh, CutInEveryDirectionIsSound) {
    const char* folder = std::getenv("HEW_MODELS");
    if (folder == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    const auto mesh =
        decomp::io::read_mesh(std::string(folder) + "/" + GetParam(), {}, decomp::Run{});
    ASSERT_TRUE(mesh.has_value()) << mesh.error().text();
    const double diagonal = decomp::mesh::diagonal_mm(*mesh);
    const Eigen::Vector3d centre = decomp::mesh::bounds(*mesh).center();
    Complex complex = tests::complex_of(*mesh);
    decomp::Rng rng(7);
    for (int i = 0; i < 7; ++i) {
        const Eigen::Vector3d normal =
            Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))
                .normalized();
        const double shift = rng.uniform(-0.2, 0.2) * diagonal;
        const std::int32_t count = complex.region_count();
        for (std::int32_t region = 0; region < count; ++region) {
            if (rng.below(3) == 0 && region > 0) {
                continue;
            }
            const Plane plane = complex.nudged_off_vertices(
                region, {normal, normal.dot(centre) + shift}, 3e-5 * diagonal);
            const auto ids = complex.split(region, plane);
            ASSERT_TRUE(ids.has_value()) << ids.error().text();
        }
    }
    tests::expect_sound(complex, *mesh);
}

/// At right angles to each axis, in the inner plane that holds the most points: flat faces, holes,
/// rims.
TEST_P(RealMesh, CutInItsFlatFacesIsSound) {
    const char* folder = std::getenv("HEW_MODELS");
    if (folder == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    const auto mesh =
        decomp::io::read_mesh(std::string(folder) + "/" + GetParam(), {}, decomp::Run{});
    ASSERT_TRUE(mesh.has_value()) << mesh.error().text();
    const Eigen::AlignedBox3d box = decomp::mesh::bounds(*mesh);
    Complex complex = tests::complex_of(*mesh);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        std::map<double, int> counts;
        for (const auto& p : mesh->points) {
            const double share = (p[axis] - box.min()[axis]) / box.sizes()[axis];
            if (share > 0.05 && share < 0.95) {
                ++counts[p[axis]];
            }
        }
        const auto most = std::max_element(counts.begin(), counts.end(),
                                           [](auto& l, auto& r) { return l.second < r.second; });
        if (most != counts.end()) {
            tests::split_all(complex, {Eigen::Vector3d::Unit(axis), most->first});
        }
    }
    EXPECT_TRUE(complex.volumes_sum_exactly());
    const auto assembly = complex.assemble(tests::all_regions(complex), decomp::Run{});
    if (!assembly) {  // the next layer of points may lie within rounding of the plane
        EXPECT_EQ(assembly.error().code, "cut.rounding_intersects") << assembly.error().text();
        std::cout << assembly.error().text() << "\n";
        return;
    }
    tests::expect_caps_match(*assembly);
}

INSTANTIATE_TEST_SUITE_P(
    Models, RealMesh,
    testing::Values("paper/hfd_maxplank.obj", "paper/cinolib_3holes.obj", "paper/hfd_BU.obj",
                    "real/od_nefertiti_lr.obj", "real/tm_plate_holes.stl", "real/od_spot.obj",
                    "real/od_hammer.obj", "paper/av_fandisk.mesh", "real/av_chamfer.mesh"),
    [](const auto& model) {
        std::string name = model.param;
        std::erase_if(name, [](char c) { return c == '/' || c == '.' || c == '_'; });
        return name;
    });
