// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/bitmap.h"
#include "cam/verify/islands.h"
#include "cam/verify/slicer.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using namespace cam::verify;

constexpr double kPixel = 0.1;

double area_of(const Bitmap& bitmap) {
    return static_cast<double>(bitmap.count()) * kPixel * kPixel;
}

TEST(Raster, ACapsuleHasTheAreaOfARectangleAndADisc) {
    for (const double turn : {0.0, 0.3, std::numbers::pi / 2, 2.2, 4.0}) {
        Bitmap bitmap(Window::around(-200, -200, 200, 200));
        const double x = 8 * std::cos(turn);
        const double y = 8 * std::sin(turn);
        for_capsule_rows({-x, -y, x, y, 1.5}, GridRows(bitmap.window(), kPixel),
                         [&](int j, int i0, int i1) { bitmap.fill(j, i0, i1); });
        EXPECT_NEAR(area_of(bitmap), 16 * 3 + std::numbers::pi * 1.5 * 1.5, 0.15) << turn;
    }
}

TEST(Raster, RowsAreFilledAcrossWordsAndClippedAtTheWindow) {
    Bitmap bitmap(Window::around(-64, 0, 127, 3));
    bitmap.fill(1, -1000, 1000);
    EXPECT_EQ(bitmap.count(), 192U);
    EXPECT_EQ(bitmap.count(1, -3, 66), 70);
    bitmap.fill(9, 0, 10);
    bitmap.fill(2, 500, 600);
    EXPECT_EQ(bitmap.count(), 192U);
    EXPECT_TRUE(bitmap.get(-64, 1));
    EXPECT_FALSE(bitmap.get(-65, 1));
}

TEST(Raster, GrowingByTwoPixelsIsADisc) {
    Bitmap bitmap(Window::around(0, 0, 191, 20));
    bitmap.fill(10, 63, 63);
    const Bitmap grown = dilated(bitmap, 2);
    EXPECT_EQ(grown.count(), 13U);
    EXPECT_TRUE(grown.get(65, 10));
    EXPECT_TRUE(grown.get(64, 11));
    EXPECT_FALSE(grown.get(65, 11));
}

TEST(Raster, UnitingBitmapsOfDifferentWindowsKeepsPlaces) {
    Bitmap wide(Window::around(-200, -10, 300, 30));
    Bitmap small(Window::around(70, 5, 90, 8));
    small.fill(6, 71, 80);
    wide.unite(small);
    EXPECT_EQ(wide.count(), 10U);
    EXPECT_TRUE(wide.get(75, 6));
}

TEST(Slices, OfATorusAreRingsOfTheRightArea) {
    const auto mesh = tests::torus(10, 3, 200, 100);
    const Slicer slicer(mesh);
    for (const double z : {-2.0, 0.0, 1.7}) {
        Bitmap bitmap(Window::around(-140, -140, 140, 140));
        fill_section(slicer.at(z), kPixel, bitmap);
        const double half = std::sqrt(9 - z * z);
        const double ring =
            std::numbers::pi * ((10 + half) * (10 + half) - (10 - half) * (10 - half));
        EXPECT_NEAR(area_of(bitmap), ring, 0.005 * ring) << z;
    }
}

TEST(Slices, OfOverlappingShellsAreTheirUnion) {
    const auto mesh =
        tests::joined(tests::box({0, 0, 0}, {4, 4, 4}), tests::box({2, 0, 0}, {6, 4, 4}));
    Bitmap bitmap(Window::around(0, 0, 80, 80));
    fill_section(Slicer(mesh).at(2), kPixel, bitmap);
    EXPECT_NEAR(area_of(bitmap), 24, 1e-9);
}

TEST(Slices, ThroughVerticesAreClosed) {
    const auto mesh = tests::sphere(10, 24, 11);
    const Slicer slicer(mesh);
    for (const auto& point : mesh.points) {
        const Section section = slicer.at(point.z());
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        for (const auto& [x0, y0, x1, y1] : section.edges) {
            sum += Eigen::Vector2d(x1 - x0, y1 - y0);
        }
        EXPECT_NEAR(sum.norm(), 0, 1e-9);
    }
}

TEST(Islands, TouchByEdgesAndCornersAndRestOnAnyPixel) {
    Bitmap deposit(Window::around(0, 0, 63, 10));
    deposit.fill(1, 3, 5);
    deposit.fill(2, 6, 8);  // touches the first at a corner
    deposit.fill(1, 20, 25);
    deposit.fill(7, 40, 50);
    Bitmap carried(deposit.window());
    carried.fill(2, 8, 8);
    Bitmap floating(deposit.window());
    const auto islands = find_islands(deposit, deposit, carried, floating);
    ASSERT_EQ(islands.size(), 2U);
    EXPECT_EQ(islands[0].pixels, 6U);
    EXPECT_EQ(islands[1].pixels, 11U);
    EXPECT_EQ(floating.count(), 17U);
}

}  // namespace
