// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/height_map.h"

#include "cam/tool/tool.h"
#include "decomp/base/rng.h"
#include "tests/support/shapes.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using cam::check::HeightMap;
using cam::check::kNothing;

HeightMap random_map(int columns, int rows, std::uint64_t seed) {
    decomp::Rng rng(seed);
    HeightMap map;
    map.columns = columns;
    map.rows = rows;
    map.cell_mm = 0.25;
    for (int i = 0; i < columns * rows; ++i) {
        const double z = 3 * std::sin(0.2 * (i % columns)) + rng.uniform(0, 2);
        map.z_mm.push_back(rng.uniform() < 0.2 ? kNothing : static_cast<float>(z));
    }
    return map;
}

/// max over all cells within the radius of z - profile, cell by cell.
template <class Profile>
float brute(const HeightMap& map, int column, int row, double radius, Profile profile) {
    float best = kNothing;
    for (int j = 0; j < map.rows; ++j) {
        for (int i = 0; i < map.columns; ++i) {
            const double r = std::hypot(i - column, j - row) * map.cell_mm;
            if (r <= radius) {
                best = std::max(best, map.at(i, j) - static_cast<float>(profile(r)));
            }
        }
    }
    return best;
}

TEST(HeightMaps, TheLowestTipsAreThoseOfBruteForce) {
    const HeightMap map = random_map(61, 43, 5);
    const double radius = 2.6;
    const auto ball = [&](double r) {
        return radius - std::sqrt(std::max(0.0, radius * radius - r * r));
    };
    const HeightMap tips = cam::check::lowest_tips(map, radius, ball);
    for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
            ASSERT_EQ(tips.at(column, row), brute(map, column, row, radius, ball))
                << column << ", " << row;
        }
    }
}

TEST(HeightMaps, TheHighestInADiscIsThatOfBruteForce) {
    for (const double radius : {0.1, 0.25, 1.1, 3.0}) {
        const HeightMap map = random_map(37, 29, 9);
        const HeightMap high = cam::check::highest_in_disc(map, radius);
        for (int row = 0; row < map.rows; ++row) {
            for (int column = 0; column < map.columns; ++column) {
                ASSERT_EQ(high.at(column, row),
                          brute(map, column, row, radius, [](double) { return 0.0; }))
                    << radius << ": " << column << ", " << row;
            }
        }
    }
}

TEST(HeightMaps, ARasterHasTheHeightsOfTheShape) {
    const auto mesh = tests::sphere(10, 180, 179);
    const auto map =
        cam::check::raster(mesh, mesh.points, {.cell_mm = 0.5, .border_mm = 2}).value();
    for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
            const double x = map.low_mm.x() + column * map.cell_mm;
            const double y = map.low_mm.y() + row * map.cell_mm;
            const double r = std::hypot(x, y);
            if (r > 10.01) {
                EXPECT_EQ(map.at(column, row), kNothing);
            } else if (r < 9.5) {
                EXPECT_NEAR(map.at(column, row), std::sqrt(100 - r * r), 0.02);
            }
        }
    }
}

TEST(HeightMaps, TooManyCellsAreAnError) {
    const auto mesh = tests::box({0, 0, 0}, {1000, 1000, 10});
    const auto map = cam::check::raster(mesh, mesh.points, {.cell_mm = 0.01});
    ASSERT_FALSE(map.has_value());
    EXPECT_EQ(map.error().code, "check.raster_too_large");
}

TEST(HeightMaps, ACoarserMapIsNowhereLower) {
    const HeightMap map = random_map(30, 22, 2);
    const HeightMap coarse = cam::check::coarser(map, 4);
    for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
            EXPECT_GE(coarse.at(column / 4, row / 4), map.at(column, row));
        }
    }
}

TEST(HeightMaps, FramesAreRightHandedAndEndInUp) {
    for (const Eigen::Vector3d& up :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, 0),
          Eigen::Vector3d(0.6, -0.64, 0.48)}) {
        const Eigen::Matrix3d frame = cam::check::frame_looking_down(up);
        EXPECT_NEAR(frame.determinant(), 1, 1e-12);
        EXPECT_NEAR((frame * up - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);
    }
}

}  // namespace
