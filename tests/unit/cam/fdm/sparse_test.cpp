// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/sparse.h"

#include "cam/polygon/offset.h"
#include "tests/support/regions.h"

#include <gtest/gtest.h>

#include <map>

namespace {

using cam::fdm::fill_sparsely;
using cam::fdm::Line;
using cam::fdm::sparse_pattern;
using cam::fdm::SparseFill;
using cam::polygon::Paths;

constexpr double kSpacing = 0.4;

double length(const std::vector<Line>& lines) {
    double sum = 0;
    for (const Line& line : lines) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            sum += (line[i + 1] - line[i]).norm();
        }
    }
    return sum;
}

SparseFill fill_of(const std::string& name, double density) {
    SparseFill fill;
    fill.pattern = sparse_pattern(name);
    fill.density = density;
    fill.bead_spacing_mm = kSpacing;
    fill.angle = decomp::Angle::degrees(30);
    fill.max_link_mm = -1;
    return fill;
}

/// Share of the area that the lines of many layers cover.
double density_of(const Paths& region, SparseFill fill) {
    constexpr int kLayers = 60;
    double sum = 0;
    for (int i = 0; i < kLayers; ++i) {
        fill.z_mm = 0.37 * (i + 1);
        fill.odd_layer = i % 2 != 0;
        sum += length(fill_sparsely(region, fill));
    }
    return sum / kLayers * kSpacing / cam::polygon::area_mm2(region);
}

TEST(Sparse, EveryPatternCoversTheShareAskedFor) {
    const Paths region = {tests::disc(30, 90), tests::hole(tests::disc(6, 40))};
    for (const char* pattern : {"grid", "rectilinear", "gyroid", "cubic", "concentric"}) {
        for (const double density : {0.1, 0.25, 0.5}) {
            // Concentric loops come in whole numbers.
            const double tolerance = pattern == std::string("concentric") ? 0.12 : 0.04;
            EXPECT_NEAR(density_of(region, fill_of(pattern, density)) / density, 1, tolerance)
                << pattern << " " << density;
        }
    }
}

TEST(Sparse, LinesKeepInsideTheRegionAndEndOnItsBoundary) {
    const Paths region = {tests::disc(20, 64), tests::hole(tests::disc(5, 31))};
    const Paths room = cam::polygon::offset(region, 0.001);
    const Paths core = cam::polygon::offset(region, -0.001);
    for (const char* pattern : {"grid", "rectilinear", "gyroid", "cubic"}) {
        SparseFill fill = fill_of(pattern, 0.2);
        fill.z_mm = 3.1;
        for (const Line& line : fill_sparsely(region, fill)) {
            for (const auto& p : line) {
                EXPECT_TRUE(cam::polygon::contains(room, cam::polygon::from_mm(p))) << pattern;
            }
            for (const auto& p : {line.front(), line.back()}) {
                EXPECT_FALSE(cam::polygon::contains(core, cam::polygon::from_mm(p))) << pattern;
            }
        }
    }
}

TEST(Sparse, LinkingUsesNoStretchOfTheBoundaryTwice) {
    const Paths region = {tests::rectangle({0, 0}, {40, 40})};
    SparseFill fill = fill_of("grid", 0.15);
    const double bare = length(fill_sparsely(region, fill));
    const std::size_t apart = fill_sparsely(region, fill).size();
    fill.max_link_mm = 20;
    const auto lines = fill_sparsely(region, fill);
    EXPECT_LT(length(lines) - bare, 160);
    EXPECT_GT(length(lines) - bare, 20);
    EXPECT_LT(lines.size(), apart / 4);
}

TEST(Sparse, NoLinkIsLongerThanAllowed) {
    const Paths region = {tests::rectangle({0, 0}, {40, 40})};
    SparseFill fill = fill_of("rectilinear", 0.05);
    fill.angle = decomp::Angle();
    fill.max_link_mm = 7;  // the lines are 8 mm apart
    EXPECT_EQ(fill_sparsely(region, fill).size(), 5U);
    for (const Line& line : fill_sparsely(region, fill)) {
        EXPECT_NEAR(length({line}), 45, 1e-6) << "a hook at either end";
    }
    fill.max_link_mm = 9;
    EXPECT_EQ(fill_sparsely(region, fill).size(), 1U);
}

TEST(Sparse, AGyroidMovesLittleFromLayerToLayer) {
    const Paths region = {tests::rectangle({0, 0}, {30, 30})};
    SparseFill fill = fill_of("gyroid", 0.2);
    fill.z_mm = 1.0;
    const auto below = fill_sparsely(region, fill);
    Paths lines;
    for (const Line& line : below) {
        auto& path = lines.emplace_back();
        for (const auto& p : line) {
            path.push_back(cam::polygon::from_mm(p));
        }
    }
    const Paths carried = cam::polygon::thickened(lines, 0.6);
    fill.z_mm = 1.2;
    std::map<bool, int> points;
    for (const Line& line : fill_sparsely(region, fill)) {
        for (const auto& p : line) {
            ++points[cam::polygon::contains(carried, cam::polygon::from_mm(p))];
        }
    }
    EXPECT_GT(points[true], 19 * points[false]) << "sections turn over where tunnels meet";
}

TEST(Sparse, CubesStandOnACorner) {
    // Planes whose traces shift by z / sqrt 2 have a slope of 54.7 degrees: those of a cube on its
    // corner.
    const Paths region = {tests::rectangle({-20, -20}, {20, 20})};
    SparseFill fill = fill_of("cubic", 0.1);
    fill.angle = decomp::Angle();
    const auto height_at = [&](double z) {
        fill.z_mm = z;
        double least = 100;
        for (const Line& line : fill_sparsely(region, fill)) {
            if (line.front().y() == line.back().y() && line.front().y() >= 0) {
                least = std::min(least, line.front().y());
            }
        }
        return least;
    };
    EXPECT_NEAR(height_at(1) - height_at(0), std::sqrt(0.5), 1e-6);
}

}  // namespace
