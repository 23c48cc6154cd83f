// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of broken input has a verdict. The table of files needs HEW_MODELS; the stand-ins
// below, made in code, are of the same kinds and hold the same in any checkout.
#include "decomp/base/rng.h"
#include "decomp/io/write_mesh.h"
#include "tests/oracle/decomp/repair/verdict.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>

namespace {

using decomp::mesh::TriMesh;
using tests::Expected;

constexpr double kBlock = 3.9370079 * 3.9370079 * 3.9370079;

const std::map<std::string, Expected>& expected_verdicts() {
    static const std::map<std::string, Expected> kTable{
        {"admesh_block_exact-bad.stl", {"fixed", kBlock, 1e-3}},
        {"admesh_block_normal-directions-bad.stl", {"fixed", kBlock, 1e-6}},
        {"admesh_block_remove-unconnected-bad.stl", {"fixed", 2 * kBlock, 1e-4}},
        {"cgal_blobby-shuffled.off", {"fixed", 0.0500825, 1e-5}},
        {"cherchi_three_cubes.stl", {"united", 21.3864, 1e-5}},
        {"gc_hourglass_ico.obj", {"fixed", 5.07219, 1e-5}},
        {"gc_moebius.obj", {"repair.not_a_solid"}},
        {"manifold_boxNotManifold.obj", {"fixed", 1e-3, 1e-6}},
        {"tm_empty.obj", {"io.empty"}},
        {"tm_empty.stl", {"io.empty"}},
        {"tm_negative_indices.obj", {"clean", 8, 1e-12}},
        {"tm_notenoughindices.obj", {"io.syntax"}},
        {"tm_soup.stl", {"repair.not_a_solid"}},
        {"tm_wallhole.obj", {"clean", 1066.6667, 1e-6}},
    };
    return kTable;
}

TEST(Nasty, EveryFileOfTheCollectionHasItsVerdict) {
    const char* models = std::getenv("HEW_MODELS");
    if (models == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    std::size_t files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(models) / "nasty")) {
        const std::string name = entry.path().filename().string();
        SCOPED_TRACE(name);
        const auto expected = expected_verdicts().find(name);
        ASSERT_NE(expected, expected_verdicts().end()) << "no verdict is expected of this file";
        tests::expect_verdict(decomp::io::read_mesh(entry.path(), {}, decomp::Run{}),
                              expected->second);
        ++files;
    }
    EXPECT_EQ(files, expected_verdicts().size());
}

// Each triangle turned at random.
TriMesh shuffled(TriMesh mesh) {
    decomp::Rng rng(7);
    for (auto& triangle : mesh.triangles) {
        if (rng.below(2) == 1) {
            std::swap(triangle[1], triangle[2]);
        }
    }
    for (std::size_t i = mesh.triangles.size(); i > 1; --i) {
        std::swap(mesh.triangles[i - 1], mesh.triangles[rng.below(i)]);
    }
    return mesh;
}

TriMesh moebius_band() {
    constexpr std::uint32_t kAround = 40;
    TriMesh mesh;
    for (std::uint32_t i = 0; i < kAround; ++i) {
        const double turn = 2 * std::numbers::pi * i / kAround;
        for (const double side : {-2.0, 2.0}) {
            const double r = 10 + side * std::cos(turn / 2);
            mesh.points.emplace_back(r * std::cos(turn), r * std::sin(turn),
                                     side * std::sin(turn / 2));
        }
    }
    for (std::uint32_t i = 0; i < kAround; ++i) {
        const bool last = i + 1 == kAround;  // where the sides change over
        const std::uint32_t next = last ? 1 : 2 * i + 2;
        const std::uint32_t next_other = last ? 0 : 2 * i + 3;
        mesh.triangles.push_back({2 * i, next, 2 * i + 1});
        mesh.triangles.push_back({2 * i + 1, next, next_other});
    }
    return mesh;
}

TriMesh scattered_triangles() {
    decomp::Rng rng(3);
    TriMesh mesh;
    for (std::uint32_t i = 0; i < 100; ++i) {
        const Eigen::Vector3d centre(rng.uniform(), rng.uniform(), rng.uniform());
        for (int k = 0; k < 3; ++k) {
            mesh.points.emplace_back(
                centre + 0.2 * Eigen::Vector3d(rng.uniform(), rng.uniform(), rng.uniform()));
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// A box of 4 x 4 x 4 with a 2 x 2 channel along Z; top and bottom are polygons with a slit to the
/// hole.
constexpr const char* kFrameObj =
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 3 1 0\nv 3 3 0\nv 1 3 0\n"
    "v 0 0 4\nv 4 0 4\nv 4 4 4\nv 0 4 4\nv 1 1 4\nv 3 1 4\nv 3 3 4\nv 1 3 4\n"
    "f 1 5 6 7 8 5 1 4 3 2\nf 9 10 11 12 9 13 16 15 14 13\n"
    "f 1 2 10 9\nf 2 3 11 10\nf 3 4 12 11\nf 4 1 9 12\n"
    "f 5 13 14 6\nf 6 14 15 7\nf 7 15 16 8\nf 8 16 13 5\n";

decomp::Result<TriMesh> through_stl(const TriMesh& mesh) {
    return decomp::io::parse_mesh(decomp::io::stl_bytes(mesh), "stand-in.stl", {}, decomp::Run{});
}

TEST(NastyStandIn, ACornerOffByAHairIsMovedOntoItsNeighbours) {
    TriMesh block = tests::box({-2, -2, -2}, {2, 2, 2});
    block.points.emplace_back(-2.0005, -2, -2);
    block.triangles[0][0] = 8;
    tests::expect_verdict(through_stl(block), {"fixed", 64, 1e-3});
}

TEST(NastyStandIn, OneTriangleThatFacesInwardIsTurned) {
    TriMesh block = tests::box({-2, -2, -2}, {2, 2, 2});
    std::swap(block.triangles[0][1], block.triangles[0][2]);
    tests::expect_verdict(through_stl(block), {"fixed", 64, 1e-12});
}

TEST(NastyStandIn, ALooseTriangleBesideTwoBlocksIsRemoved) {
    TriMesh blocks =
        tests::joined(tests::box({0, 0, 0}, {4, 4, 4}), tests::box({9, 9, 9}, {13, 13, 13}));
    TriMesh loose;
    loose.points = {{-17, -18, -17}, {-18, -18, -17}, {-18, -17, -17}};
    loose.triangles = {{0, 1, 2}};
    tests::expect_verdict(through_stl(tests::joined(blocks, loose)), {"fixed", 128, 1e-12});
}

TEST(NastyStandIn, TrianglesTurnedAndOrderedAtRandomFaceOneWayAgain) {
    const TriMesh blob = tests::torus(10, 3, 40, 20);
    tests::expect_verdict(through_stl(shuffled(blob)),
                          {"fixed", decomp::mesh::volume_mm3(blob), 1e-6});
}

TEST(NastyStandIn, ThreeBoxesThatOverlapAreUnited) {
    TriMesh boxes =
        tests::joined(tests::box({0, 0, 0}, {2, 2, 2}), tests::box({1, 1, 1}, {3, 3, 3}));
    boxes = tests::joined(boxes, tests::box({1, 0, 1}, {3, 1, 3}));
    // 8 + 8 + 4, less the overlaps 1 and 1 of the first with the others.
    tests::expect_verdict(through_stl(boxes), {"united", 18, 1e-12});
}

TEST(NastyStandIn, TwoConesThatShareTheirTipAreTwoShells) {
    TriMesh cones;
    cones.points = {{0, 0, 0},  {1, 0, 1},    {-1, 1, 1}, {-1, -1, 1},
                    {1, 0, -1}, {-1, -1, -1}, {-1, 1, -1}};
    cones.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3},
                       {0, 5, 4}, {0, 6, 5}, {0, 4, 6}, {4, 5, 6}};
    tests::expect_verdict(through_stl(cones), {"fixed", 4.0 / 3, 1e-12});
}

TEST(NastyStandIn, AMoebiusBandIsNotASolid) {
    tests::expect_verdict(through_stl(moebius_band()), {"repair.not_a_solid"});
}

TEST(NastyStandIn, ACornerPulledOutOfABoxLeavesAHoleThatIsFilled) {
    TriMesh box = tests::box({0, 0, 0}, {1, 1, 1});
    box.points.emplace_back(0.1, 0, 0.3);  // in the plane of its triangle
    box.triangles[5][0] = 8;
    tests::expect_verdict(through_stl(box), {"fixed", 1, 1e-6});
}

TEST(NastyStandIn, ABodyWhoseMendedHoleCrossesItIsCutThere) {
    TriMesh box = tests::box({0, 0, 0}, {1, 1, 1});
    box.points.emplace_back(0.1, 0.1, 0);
    box.triangles[5][0] = 8;
    tests::expect_verdict(through_stl(box), {"united", 1, 0.05});
}

TEST(NastyStandIn, WhatCrossesItselfInThreesIsWrappedAlikeEachTime) {
    // A torus whose tube is thicker than its ring: all meridians cross near the axis.
    TriMesh spindle = tests::torus(10, 9.5, 24, 12);
    for (auto& point : spindle.points) {
        const double r = std::hypot(point.x(), point.y());
        point.head<2>() *= (r - 0.8) / r;
    }
    const decomp::repair::RepairOptions coarse{.wrap_detail_share = 1.0 / 40};
    const auto first = decomp::repair::repair(spindle, coarse, decomp::Run{});
    const auto second = decomp::repair::repair(spindle, coarse, decomp::Run{});
    ASSERT_TRUE(first && second);
    EXPECT_EQ(name_of(first->report.status), "wrapped");
    EXPECT_GT(first->report.hausdorff_mm, 0);
    tests::expect_solid(*first);
    EXPECT_EQ(decomp::io::ply_bytes(first->mesh), decomp::io::ply_bytes(second->mesh));
}

TEST(NastyStandIn, ScatteredTrianglesAreNotASolid) {
    tests::expect_verdict(through_stl(scattered_triangles()), {"repair.not_a_solid"});
}

TEST(NastyStandIn, PolygonsWithASlitToAHoleAreClean) {
    tests::expect_verdict(decomp::io::parse_mesh(kFrameObj, "frame.obj", {}, decomp::Run{}),
                          {"clean", 48, 1e-12});
}

TEST(NastyStandIn, FilesWithoutTrianglesOrWithABrokenFaceAreErrors) {
    const auto parse = [](std::string_view text, std::string_view name) {
        return decomp::io::parse_mesh(text, name, {}, decomp::Run{});
    };
    tests::expect_verdict(parse("# a remark\n", "a.obj"), {"io.empty"});
    tests::expect_verdict(parse("solid Empty\nendsolid Empty", "a.stl"), {"io.empty"});
    tests::expect_verdict(parse("v 0 0 0\nv 1 0 0\nf 1// 2//\n", "a.obj"), {"io.syntax"});
}

}  // namespace
