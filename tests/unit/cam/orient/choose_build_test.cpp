// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/choose_build.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>

namespace {

using cam::orient::BuildChoice;
using cam::orient::rank_builds;
using cam::profile::FdmMachine;
using decomp::part::Fidelity;
using decomp::part::Part;

FdmMachine machine(double x, double y, double z) {
    FdmMachine out;
    out.chamber.min_mm = {-x / 2, -y / 2, 0};
    out.chamber.max_mm = {x / 2, y / 2, z};
    out.process.layer_height_mm = 0.2;
    out.process.skirt_loops = 0;
    return out;
}

Part whole(const tests::TriMesh& mesh) {
    Part part;
    part.mesh = mesh;
    part.sources.resize(mesh.triangles.size());
    return part;
}

/// A ball of radius 20 cut off at a height; the flat is a cut face of plane 3.
Part dome(double height) {
    Part part = whole(tests::sphere(20, 64, 41));
    for (auto& point : part.mesh.points) {
        point.z() = std::max(point.z(), height);
    }
    std::erase_if(part.mesh.triangles, [&](const auto& t) {
        return part.mesh.points[t[0]].z() == height && part.mesh.points[t[1]].z() == height &&
               part.mesh.points[t[2]].z() == height;
    });
    // The rim's ring is the last above the flat: close it with a fan.
    part.sources.resize(part.mesh.triangles.size());
    std::vector<std::uint32_t> rim;
    for (std::uint32_t v = 0; v < part.mesh.points.size(); ++v) {
        const bool used =
            std::any_of(part.mesh.triangles.begin(), part.mesh.triangles.end(),
                        [&](const auto& t) { return std::find(t.begin(), t.end(), v) != t.end(); });
        if (used && part.mesh.points[v].z() == height) {
            rim.push_back(v);
        }
    }
    for (std::size_t i = 1; i + 1 < rim.size(); ++i) {
        part.mesh.triangles.push_back({rim[0], rim[i + 1], rim[i]});
        part.sources.push_back({3, 1});
    }
    return part;
}

TEST(Orient, ADomeStandsOnItsCutFaceWithoutSupport) {
    const auto choices = rank_builds(dome(1), machine(100, 100, 100));
    ASSERT_FALSE(choices.empty());
    EXPECT_TRUE(choices[0].on_cut_face);
    EXPECT_EQ(choices[0].base_plane, 3);
    EXPECT_EQ(choices[0].support_area_mm2, 0);
    EXPECT_TRUE(choices[0].stable);
    EXPECT_TRUE(choices[0].fits());
}

TEST(Orient, APartWithACutFaceIsNotOfferedTheAxes) {
    for (const BuildChoice& choice : rank_builds(dome(1), machine(100, 100, 100))) {
        EXPECT_TRUE(choice.on_flat);
    }
}

TEST(Orient, ABallHasOnlyTheAxes) {
    const auto choices = rank_builds(whole(tests::sphere(20, 64, 41)), machine(100, 100, 100));
    EXPECT_EQ(choices.size(), 6U);
    EXPECT_FALSE(choices[0].on_flat);
    EXPECT_GT(choices[0].support_area_mm2, 0);
}

TEST(Orient, ATableStandsOnItsTopBecauseThatNeedsLessSupport) {
    const auto table = tests::revolved(60, {{40, 60}, {40, 50}, {8, 50}, {8, 0}}, 0, 48);
    const auto choices = rank_builds(whole(table), machine(100, 100, 100));
    const Eigen::Vector3d up = choices[0].pose.turn(Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(up.z(), -1, 1e-9);
    EXPECT_EQ(choices[0].support_area_mm2, 0);
}

TEST(Orient, TheLeastSupportOfAllPosesThatFitComesFirst) {
    const auto table = tests::revolved(60, {{40, 60}, {40, 50}, {8, 50}, {8, 0}}, 0, 48);
    const auto choices = rank_builds(whole(table), machine(100, 100, 100));
    for (const BuildChoice& choice : choices) {
        if (choice.fits() && choice.stable && choice.on_flat) {
            EXPECT_GE(choice.support_area_mm2, choices[0].support_area_mm2);
        }
    }
}

TEST(Orient, APoseThatDoesNotFitComesAfterOneThatDoes) {
    const auto slab = tests::box({0, 0, 0}, {10, 80, 90});
    const auto choices = rank_builds(whole(slab), machine(100, 95, 20));
    EXPECT_TRUE(choices[0].fits());
    EXPECT_NEAR(choices[0].size_mm.z(), 10, 1e-9);
}

TEST(Orient, TheBrimCountsAsPartOfTheFootprint) {
    FdmMachine bed = machine(100, 100, 100);
    const Part box = whole(tests::box({0, 0, 0}, {92, 92, 92}));
    EXPECT_TRUE(rank_builds(box, bed)[0].fits());
    bed.process.brim_width_mm = 5;
    EXPECT_FALSE(rank_builds(box, bed)[0].fits());
    bed.process.brim_width_mm = 0;
    bed.process.skirt_loops = 3;
    bed.process.skirt_distance_mm = 3;
    EXPECT_FALSE(rank_builds(box, bed)[0].fits());
}

TEST(Orient, ThePlacedMeshStandsExactlyAtZeroAndIsCentred) {
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.linear() = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.33).normalized().toRotationMatrix();
    Part part = dome(1);
    part.mesh = decomp::mesh::transformed(part.mesh, map);
    const auto choices = rank_builds(part, machine(100, 100, 100));
    const auto mesh = cam::orient::placed(part, choices[0]);
    const auto box = decomp::mesh::bounds(mesh);
    EXPECT_EQ(box.min().z(), 0);
    EXPECT_NEAR(box.center().x(), 0, 1e-9);
    EXPECT_NEAR(box.center().y(), 0, 1e-9);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (part.sources[i].is_cut()) {
            for (const auto v : mesh.triangles[i]) {
                EXPECT_EQ(mesh.points[v].z(), 0);
            }
        }
    }
    EXPECT_NEAR(decomp::mesh::volume_mm3(mesh), decomp::mesh::volume_mm3(part.mesh), 1e-6);
}

TEST(Orient, TheJudgeNamesTheViolationAndTheCutThatHelps) {
    cam::profile::FdmSetup setup;
    setup.machine = machine(100, 100, 100.2);
    const auto judge = cam::orient::fdm_judge(setup);
    const Part tower = whole(tests::box({0, 0, 0}, {90, 90, 250}));
    const auto verdict = judge(tower, Fidelity::Exact);
    ASSERT_EQ(verdict.violations.size(), 1U);
    EXPECT_NEAR(verdict.violations[0].by_ratio, 2.5, 1e-9);
    ASSERT_EQ(verdict.cuts_that_help.size(), 2U);
    for (const auto& plane : verdict.cuts_that_help) {
        EXPECT_NEAR(std::abs(plane.normal.z()), 1, 1e-9);
        const double z = plane.offset_mm / plane.normal.z();
        EXPECT_TRUE(std::abs(z - 250.0 / 3) < 1e-6 || std::abs(z - 500.0 / 3) < 1e-6);
    }
    EXPECT_TRUE(judge(whole(tests::box({0, 0, 0}, {90, 90, 90})), Fidelity::Estimate).ok());
}

TEST(Orient, ThePoseJudgedIsThePoseOfThePlacedMesh) {
    cam::profile::FdmSetup setup;
    setup.machine = machine(120, 60, 50);
    const Part part = whole(tests::box({3, 4, 5}, {43, 114, 50}));
    const auto verdict = cam::orient::fdm_judge(setup)(part, Fidelity::Exact);
    ASSERT_TRUE(verdict.ok());
    const Eigen::Vector3d size =
        decomp::mesh::bounds(cam::orient::placed(part, verdict.best_pose)).sizes();
    EXPECT_LE(size.x(), 120);
    EXPECT_LE(size.y(), 60);
    EXPECT_LE(size.z(), 50);
}

}  // namespace
