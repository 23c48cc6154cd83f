// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/bead_size.h"
#include "cam/fdm/plan_part.h"
#include "cam/fdm/slice.h"
#include "cam/fdm/walls.h"
#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"
#include "decomp/base/rng.h"
#include "decomp/mesh/measure.h"
#include "tests/support/regions.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using cam::path::Feature;
using cam::path::LayerStack;
using cam::polygon::Path;
using cam::polygon::Paths;
using tests::TriMesh;

constexpr int kCases = 4;

/// A ball whose points are moved in and out at random: bumps, dents and overhangs, no
/// self-intersection.
TriMesh potato(decomp::Rng& rng) {
    TriMesh mesh = tests::sphere(10, 24, 15);
    for (auto& p : mesh.points) {
        p *= rng.uniform(0.75, 1.15);
    }
    const double low = decomp::mesh::bounds(mesh).min().z();
    for (auto& p : mesh.points) {
        p.z() -= low;
    }
    return mesh;
}

/// A star with random rays and a random hole.
Paths star(decomp::Rng& rng) {
    Path outer;
    const auto corners = static_cast<int>(6 + rng.below(20));
    for (int i = 0; i < corners; ++i) {
        const double turn = 2 * std::numbers::pi * i / corners;
        const double radius = rng.uniform(4, 12);
        outer.push_back(cam::polygon::from_mm({radius * std::cos(turn), radius * std::sin(turn)}));
    }
    return cam::polygon::region_of({outer, tests::hole(tests::disc(rng.uniform(0.5, 3), 24))});
}

double volume_mm3(const LayerStack& stack) {
    double sum = 0;
    for (const auto& layer : stack.layers) {
        for (const auto& bead : layer.beads) {
            if (bead.feature == Feature::Support || bead.feature == Feature::SupportInterface) {
                continue;
            }
            double length = 0;
            for (std::size_t i = 0; i + 1 < bead.points.size(); ++i) {
                length += (bead.points[i + 1] - bead.points[i]).norm();
            }
            sum += length * cam::path::bead_area_mm2(bead.width_mm, bead.height_mm);
        }
    }
    return sum;
}

TEST(RandomParts, BeadsOfThePartLieInsideItsSlices) {
    decomp::Rng rng(7);
    const cam::profile::FdmSetup setup;
    for (int k = 0; k < kCases; ++k) {
        const TriMesh part = potato(rng);
        const auto stack = cam::fdm::plan_part(part, setup, {});
        ASSERT_TRUE(stack);
        std::vector<std::int64_t> heights;
        for (const auto& layer : stack->layers) {
            heights.push_back(cam::polygon::nanometres(layer.z_mm - layer.height_mm / 2));
        }
        const auto slices = cam::fdm::slice(part, heights, {});
        ASSERT_TRUE(slices);
        for (std::size_t i = 0; i < slices->size(); ++i) {
            // Centre lines keep inside; a little room for the simplification of what is written.
            const Paths room = cam::polygon::offset((*slices)[i], 0.01);
            for (const auto& bead : stack->layers[i].beads) {
                const bool support =
                    bead.feature == Feature::Support || bead.feature == Feature::SupportInterface;
                for (const auto& p : bead.points) {
                    EXPECT_TRUE(support || cam::polygon::contains(room, cam::polygon::from_mm(p)))
                        << "case " << k << " layer " << i;
                }
            }
        }
    }
}

TEST(RandomParts, FullInfillHasTheVolumeOfTheMesh) {
    decomp::Rng rng(11);
    cam::profile::FdmSetup setup;
    setup.machine.process.infill_density = 1;
    for (int k = 0; k < kCases; ++k) {
        const TriMesh part = potato(rng);
        const auto stack = cam::fdm::plan_part(part, setup, {});
        ASSERT_TRUE(stack);
        EXPECT_NEAR(volume_mm3(*stack) / decomp::mesh::volume_mm3(part), 1, 0.01) << "case " << k;
    }
}

TEST(RandomParts, WallsAndWhatTheyLeaveCoverTheRegion) {
    decomp::Rng rng(3);
    const cam::fdm::BeadSize bead{0.45, 0.2};
    for (int k = 0; k < 40 * kCases; ++k) {
        const Paths region = star(rng);
        const auto walls = cam::fdm::make_walls(region, bead, 3);
        Paths covered = cam::polygon::unite(walls.inside, walls.thin);
        covered = cam::polygon::unite(covered, walls.gaps);
        for (std::size_t d = 0; d < walls.loops.size(); ++d) {
            const double out = d == 0 ? bead.width_mm / 2 : bead.spacing_mm() / 2;
            const Paths band = cam::polygon::subtract(
                cam::polygon::offset(walls.loops[d], out),
                cam::polygon::offset(walls.loops[d], -bead.spacing_mm() / 2));
            covered = cam::polygon::unite(covered, band);
        }
        const double area = cam::polygon::area_mm2(region);
        const double missed = cam::polygon::area_mm2(cam::polygon::subtract(region, covered));
        EXPECT_LE(missed, 0.002 * area) << "case " << k;
    }
}

TEST(RandomParts, OneThreadAndTwoMakeTheSameBeads) {
    decomp::Rng rng(5);
    const cam::profile::FdmSetup setup;
    decomp::Run two;
    two.jobs = 2;
    for (int k = 0; k < kCases / 2; ++k) {
        const TriMesh part = potato(rng);
        const auto a = cam::fdm::plan_part(part, setup, {});
        const auto b = cam::fdm::plan_part(part, setup, two);
        ASSERT_TRUE(a && b);
        ASSERT_EQ(a->layers.size(), b->layers.size());
        for (std::size_t i = 0; i < a->layers.size(); ++i) {
            ASSERT_EQ(a->layers[i].beads.size(), b->layers[i].beads.size());
            for (std::size_t j = 0; j < a->layers[i].beads.size(); ++j) {
                ASSERT_EQ(a->layers[i].beads[j].points, b->layers[i].beads[j].points);
                ASSERT_EQ(a->layers[i].beads[j].width_mm, b->layers[i].beads[j].width_mm);
            }
        }
    }
}

}  // namespace
