// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/decomp/cut/support.h"

#include <algorithm>

using decomp::cut::Complex;
using decomp::cut::SectionPiece;
using decomp::mesh::volume_mm3;
using decomp::part::Plane;
using tests::box;
using tests::complex_of;
using tests::expect_sound;

namespace {

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

/// A bridge lying along X with `legs` legs 10 wide and 10 apart below it: one prism in Y.
tests::TriMesh bridge(int legs) {
    std::vector<Eigen::Vector2d> outline;  // x, z; counter-clockwise seen from -Y
    for (int i = 0; i < legs; ++i) {
        outline.emplace_back(20 * i, 0);
        outline.emplace_back(20 * i + 10, 0);
        if (i + 1 < legs) {
            outline.emplace_back(20 * i + 10, 20);
            outline.emplace_back(20 * i + 20, 20);
        }
    }
    outline.emplace_back(20 * legs - 10, 30);
    outline.emplace_back(0, 30);
    tests::TriMesh mesh;
    const auto n = static_cast<std::uint32_t>(outline.size());
    for (const double y : {0.0, 10.0}) {
        for (const auto& p : outline) {
            mesh.points.emplace_back(p.x(), y, p.y());
        }
    }
    // The front by rectangles: legs and the beam, which has a corner at each of theirs.
    std::vector<decomp::mesh::Triangle> front;
    std::vector<std::uint32_t> underside;
    for (int i = 0; i < legs; ++i) {
        const auto a = static_cast<std::uint32_t>(4 * i);
        const std::uint32_t left = i == 0 ? n - 1 : a - 1;
        const std::uint32_t right = i + 1 == legs ? n - 2 : a + 2;
        if (legs > 1) {
            front.push_back({a, a + 1, right});
            front.push_back({a, right, left});
        }
    }
    // The beam above the inner corners: a fan from the last outline point.
    for (std::uint32_t i = 2; i + 1 < n - 2; i += 4) {
        underside.push_back(i);
        underside.push_back(i + 1);
    }
    for (std::size_t i = 0; i + 1 < underside.size(); ++i) {
        front.push_back({n - 1, underside[i], underside[i + 1]});
    }
    front.push_back({n - 1, underside.back(), n - 2});
    for (const auto& t : front) {
        mesh.triangles.push_back(t);
        mesh.triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        mesh.triangles.push_back({i, j + n, j});
        mesh.triangles.push_back({i, i + n, j + n});
    }
    return mesh;
}

std::int32_t piece_at(const std::vector<SectionPiece>& pieces, double x) {
    const auto found = std::find_if(pieces.begin(), pieces.end(), [&](const SectionPiece& piece) {
        return std::abs(piece.inside_mm.x() - x) < 5;
    });
    return found == pieces.end() ? -1 : static_cast<std::int32_t>(found - pieces.begin());
}

TEST(LimitedCut, TheSectionOfABridgeHasAPieceForEachLeg) {
    const auto mesh = bridge(3);
    Complex complex = complex_of(mesh);
    const auto pieces = complex.section(0, {kZ, 7});
    ASSERT_TRUE(pieces.has_value());
    ASSERT_EQ(pieces->size(), 3U);
    for (const SectionPiece& piece : *pieces) {
        EXPECT_DOUBLE_EQ(piece.area_mm2, 100);
        EXPECT_DOUBLE_EQ(piece.inside_mm.z(), 7);
        EXPECT_EQ(piece.above, 3);  // the bridge comes after the three feet
    }
    EXPECT_EQ(complex.region_count(), 1);
    EXPECT_TRUE(complex.planes().empty());
}

TEST(LimitedCut, OneLegIsTakenOffAndTheOthersKeepTheirTriangles) {
    const auto mesh = bridge(3);
    Complex complex = complex_of(mesh);
    const auto pieces = complex.section(0, {kZ, 7});
    ASSERT_TRUE(pieces.has_value());
    const auto ids = complex.split(0, {kZ, 7}, {piece_at(*pieces, 25)});
    ASSERT_TRUE(ids.has_value()) << ids.error().text();
    ASSERT_EQ(ids->size(), 2U);
    const auto assembly = expect_sound(complex, mesh);
    ASSERT_EQ(assembly.parts.size(), 2U);
    std::vector<double> volumes;
    for (const auto& part : assembly.parts) {
        volumes.push_back(volume_mm3(part.mesh));
    }
    std::sort(volumes.begin(), volumes.end());
    EXPECT_NEAR(volumes[0], 700, 1e-9);
    ASSERT_EQ(assembly.interfaces.size(), 1U);
    EXPECT_NEAR(assembly.interfaces[0].area_mm2, 100, 1e-9);
    // No point of the cut plane lies on the other two legs.
    for (const auto& part : assembly.parts) {
        for (const auto& point : part.mesh.points) {
            EXPECT_FALSE(point.z() == 7 && (point.x() < 15 || point.x() > 35));
        }
    }
}

TEST(LimitedCut, AllPiecesAreTheWholeSplit) {
    const auto mesh = bridge(2);
    Complex whole = complex_of(mesh);
    Complex limited = complex_of(mesh);
    const auto ids = whole.split(0, {kZ, 7});
    const auto same = limited.split(0, {kZ, 7}, {0, 1});
    ASSERT_TRUE(ids.has_value() && same.has_value());
    EXPECT_EQ(*ids, *same);
    for (const std::int32_t id : *ids) {
        EXPECT_EQ(whole.region(id).mesh.triangles, limited.region(id).mesh.triangles);
    }
}

TEST(LimitedCut, OneSideOfARingIsLeftWhole) {
    const auto mesh = tests::torus(50, 12, 24, 12);
    Complex complex = complex_of(mesh);
    const auto pieces = complex.section(0, {kX, 0.3});
    ASSERT_TRUE(pieces.has_value());
    ASSERT_EQ(pieces->size(), 2U);
    const auto ids = complex.split(0, {kX, 0.3}, {0});
    ASSERT_TRUE(ids.has_value());
    EXPECT_EQ(ids->size(), 1U);
    EXPECT_EQ(complex.region(0).mesh.triangles.size(), mesh.triangles.size());
}

TEST(LimitedCut, TheOtherLegIsCutLaterByTheSamePlane) {
    const auto mesh = bridge(2);
    Complex complex = complex_of(mesh);
    ASSERT_TRUE(complex.split(0, {kZ, 7}, {0}).has_value());
    std::int32_t larger = complex.volume_mm3(0) > complex.volume_mm3(1) ? 0 : 1;
    const auto ids = complex.split(larger, {kZ, 7});
    ASSERT_TRUE(ids.has_value()) << ids.error().text();
    EXPECT_EQ(ids->size(), 2U);
    EXPECT_EQ(complex.planes().size(), 1U);
    EXPECT_EQ(expect_sound(complex, mesh).parts.size(), 3U);
}

TEST(LimitedCut, CapsOfEarlierCutsAreCrossedSoundly) {
    const auto mesh = bridge(3);
    Complex complex = complex_of(mesh);
    ASSERT_TRUE(complex.split(0, {Eigen::Vector3d(0.1, 1, 0.05), 5.3}).has_value());
    for (const std::int32_t region : {0, 1}) {
        const auto pieces = complex.section(region, {Eigen::Vector3d(0.07, 0.02, 1), 9.1});
        ASSERT_TRUE(pieces.has_value());
        ASSERT_EQ(pieces->size(), 3U);
        const auto ids = complex.split(region, {Eigen::Vector3d(0.07, 0.02, 1), 9.1},
                                       {piece_at(*pieces, 5), piece_at(*pieces, 45)});
        ASSERT_TRUE(ids.has_value()) << ids.error().text();
        EXPECT_EQ(ids->size(), 3U);
    }
    EXPECT_EQ(expect_sound(complex, mesh).parts.size(), 6U);
}

TEST(LimitedCut, AShapeWithACavityKeepsIt) {
    const auto hollow = tests::joined(bridge(2), tests::flipped(box({2, 2, 22}, {28, 8, 28})));
    Complex complex = complex_of(hollow);
    const auto ids = complex.split(0, {kZ, 7}, {1});
    ASSERT_TRUE(ids.has_value()) << ids.error().text();
    EXPECT_EQ(ids->size(), 2U);
    EXPECT_EQ(expect_sound(complex, hollow).parts.size(), 2U);
}

TEST(LimitedCut, APieceThatIsNotThereIsAnError) {
    Complex complex = complex_of(bridge(2));
    EXPECT_EQ(complex.split(0, {kZ, 7}, {2}).error().code, "cut.no_such_piece");
    EXPECT_EQ(complex.split(0, {kZ, 99}, {}).value(), std::vector<std::int32_t>{0});
    EXPECT_EQ(complex.region_count(), 1);
    EXPECT_TRUE(complex.planes().empty());
}

}  // namespace
