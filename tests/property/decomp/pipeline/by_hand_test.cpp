// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/orient/choose_build.h"
#include "decomp/cut/complex.h"
#include "decomp/mesh/measure.h"
#include "decomp/pipeline/decompose.h"
#include "decomp/plan/plan_file.h"
#include "decomp/plan/workpiece.h"
#include "tests/property/decomp/pipeline/sound.h"
#include "tests/support/pairs.h"
#include "tests/support/random_shapes.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace {

using decomp::Result;
using decomp::Run;
using decomp::mesh::TriMesh;
using decomp::mesh::volume_mm3;
using decomp::pipeline::decompose;
using decomp::pipeline::DecomposeOptions;
using decomp::pipeline::Decomposition;
using decomp::pipeline::Mode;
using decomp::pipeline::PolycubeMap;

using tests::printer;

/// A shape, how it is to be cut, and for whom.
struct Work {
    TriMesh shape;
    DecomposeOptions options;
    cam::profile::FdmSetup machine;
};

Result<Decomposition> cut(const Work& work, int jobs = 2) {
    Run run;
    run.jobs = jobs;
    return decompose(work.shape, work.options, cam::orient::fdm_judge(work.machine), run);
}

std::vector<decomp::plan::Edit> edits(const std::vector<std::string>& texts) {
    std::vector<decomp::plan::Edit> out;
    for (const std::string& text : texts) {
        out.push_back(*decomp::plan::parse_edit(text));
    }
    return out;
}

Result<Decomposition> edited(Work work, const std::vector<std::string>& texts) {
    work.options.edits = edits(texts);
    return cut(work);
}

/// As a plan that went through its file.
Result<Decomposition> replayed(Work work, const Decomposition& first) {
    const std::string text = decomp::plan::plan_toml(first.plan, first.regions);
    auto plan = decomp::plan::parse_plan(text, "plan.toml");
    if (!plan) {
        return decomp::fail(plan.error());
    }
    work.options = {};
    work.options.plan = std::make_shared<const decomp::plan::Plan>(std::move(*plan));
    return cut(work, 1);
}

void expect_same(const Decomposition& one, const Decomposition& two) {
    ASSERT_EQ(one.assembly.parts.size(), two.assembly.parts.size());
    for (std::size_t i = 0; i < one.assembly.parts.size(); ++i) {
        const decomp::part::Part& a = one.assembly.parts[i];
        const decomp::part::Part& b = two.assembly.parts[i];
        EXPECT_EQ(a.id, b.id);
        EXPECT_EQ(a.mesh.points, b.mesh.points);
        EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
        ASSERT_EQ(a.sources.size(), b.sources.size());
        for (std::size_t k = 0; k < a.sources.size(); ++k) {
            EXPECT_EQ(a.sources[k].plane, b.sources[k].plane);
            EXPECT_EQ(a.sources[k].neighbour, b.sources[k].neighbour);
        }
        EXPECT_EQ(one.poses[i].row_major(), two.poses[i].row_major());
    }
    EXPECT_EQ(one.regions, two.regions);
    EXPECT_EQ(one.tier, two.tier);
    EXPECT_EQ(one.notes, two.notes);
    EXPECT_EQ(decomp::plan::plan_toml(one.plan), decomp::plan::plan_toml(two.plan));
}

/// The volumes of what a plan gives sum to that of the shape, as rationals.
void expect_exact_sum(const Work& work, const Decomposition& found) {
    const auto piece = decomp::plan::Workpiece::carried_out(work.shape, found.plan);
    ASSERT_TRUE(piece.has_value()) << piece.error().text();
    EXPECT_TRUE(piece->complex().volumes_sum_exactly());
    EXPECT_EQ(found.assembly.parts.size(), found.regions.size());
}

Work by_sections(TriMesh shape, double x, double y, double z) {
    Work work{std::move(shape), {}, printer(x, y, z)};
    work.options.mode = Mode::Sections;
    return work;
}

/// A T of four voxels, bent and sheared, in its polycube: every voxel stays a part.
Work by_polycube(Mode mode, bool global) {
    const auto made =
        tests::voxel_pair({{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {1, 0, 0}}, 20, 3,
                          [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
                              return {p.x() + 0.005 * p.z() * p.z(), p.y() + 0.1 * p.x(), p.z()};
                          });
    Work work{made.surface, {}, printer(110, 110, 60)};
    PolycubeMap map;
    map.pair = made.pair;
    map.lattice = made.lattice;
    work.options.map = std::make_shared<const PolycubeMap>(std::move(map));
    work.options.mode = mode;
    work.options.global_sweep = global;
    work.options.keep_boxes = true;
    return work;
}

TEST(Plan, CarriedOutAgainGivesTheSamePartsBitForBitFromCrossSections) {
    for (std::uint64_t seed = 0; seed < 7; ++seed) {
        Work work = by_sections(tests::random_shape(seed), 60, 60, 50);
        work.options.proxy_triangles = 1000;
        const auto first = cut(work);
        ASSERT_TRUE(first.has_value()) << seed << first.error().text();
        const auto again = replayed(work, *first);
        ASSERT_TRUE(again.has_value()) << seed << again.error().text();
        expect_same(*first, *again);
        expect_exact_sum(work, *first);
    }
}

TEST(Plan, CarriedOutAgainGivesTheSamePartsBitForBitFromAPolycube) {
    for (const Mode mode : {Mode::Sheets, Mode::Paper}) {
        for (const bool global : {false, true}) {
            const Work work = by_polycube(mode, global);
            const auto first = cut(work);
            ASSERT_TRUE(first.has_value()) << first.error().text();
            EXPECT_EQ(first->tier, "T2");
            EXPECT_EQ(first->assembly.parts.size(), 4U);
            const auto again = replayed(work, *first);
            ASSERT_TRUE(again.has_value()) << again.error().text();
            expect_same(*first, *again);
        }
    }
}

TEST(Plan, ABoxThatTheMachineCannotMakeIsCutTheSameWayAgain) {
    Work work = by_polycube(Mode::Sheets, false);
    work.machine = printer(40, 40, 30);
    const auto first = cut(work);
    ASSERT_TRUE(first.has_value()) << first.error().text();
    EXPECT_GT(first->assembly.parts.size(), 4U);
    const auto again = replayed(work, *first);
    ASSERT_TRUE(again.has_value()) << again.error().text();
    expect_same(*first, *again);
}

TEST(Plan, AMovedPlaneCutsWhereItNowLies) {
    const Work work = by_sections(tests::box({0, 0, 0}, {40, 40, 100}), 60, 60, 70);
    const auto first = cut(work);
    ASSERT_TRUE(first.has_value());
    ASSERT_EQ(first->assembly.parts.size(), 2U);
    Decomposition changed = *first;
    ASSERT_EQ(changed.plan.steps.size(), 1U);
    changed.plan.steps[0].plane = {Eigen::Vector3d::UnitZ(), 45.25};
    const auto again = replayed(work, changed);
    ASSERT_TRUE(again.has_value()) << again.error().text();
    EXPECT_EQ(volume_mm3(again->assembly.parts[0].mesh), 40.0 * 40 * 45.25);
}

TEST(Plan, WhatTheMachineCannotMakeAnyMoreIsRefused) {
    const Work work = by_sections(tests::box({0, 0, 0}, {40, 40, 100}), 60, 60, 60);
    auto first = cut(work);
    ASSERT_TRUE(first.has_value());
    first->plan.steps.clear();
    const auto again = replayed(work, *first);
    ASSERT_FALSE(again.has_value());
    EXPECT_EQ(again.error().code, "plan.does_not_fit");
    EXPECT_FALSE(again.error().hint.empty());
}

TEST(Plan, OfAnotherShapeIsRefused) {
    const auto first = cut(by_sections(tests::box({0, 0, 0}, {40, 40, 100}), 60, 60, 60));
    ASSERT_TRUE(first.has_value());
    const auto other =
        replayed(by_sections(tests::box({0, 0, 0}, {40, 40, 101}), 60, 60, 60), *first);
    ASSERT_FALSE(other.has_value());
    EXPECT_EQ(other.error().code, "plan.other_shape");
}

TEST(Numbering, IsTheSameForASlightlyLargerChamber) {
    // What a part is called does not depend on which region of the complex it was.
    const auto numbered = [](double chamber) {
        Work work = by_sections(tests::dumbbell(30, 8, 100, 5, 24), chamber, chamber, chamber);
        work.options.proxy_triangles = 800;
        work.options.lookahead = 2;
        return cut(work);
    };
    const auto first = numbered(80);
    const auto second = numbered(80.8);
    ASSERT_TRUE(first.has_value());
    ASSERT_TRUE(second.has_value());
    ASSERT_EQ(first->assembly.parts.size(), second->assembly.parts.size());
    const auto centre = [](const Decomposition& found, std::size_t i) {
        return decomp::mesh::bounds(found.assembly.parts[i].mesh).center().eval();
    };
    for (std::size_t i = 0; i < first->assembly.parts.size(); ++i) {
        for (std::size_t k = 0; k < second->assembly.parts.size(); ++k) {
            EXPECT_LE((centre(*first, i) - centre(*second, i)).norm(),
                      (centre(*first, i) - centre(*second, k)).norm());
        }
    }
}

TEST(ByHand, ASplitGivesOnePartMoreAtItsShareOfTheExtent) {
    const Work work = by_sections(tests::box({0, 0, 0}, {40, 40, 100}), 60, 60, 60);
    const auto plain = cut(work);
    ASSERT_TRUE(plain.has_value());
    const auto split = edited(work, {"split P02:x=0.25"});
    ASSERT_TRUE(split.has_value()) << split.error().text();
    ASSERT_EQ(split->assembly.parts.size(), plain->assembly.parts.size() + 1);
    expect_exact_sum(work, *split);
    const double whole = volume_mm3(plain->assembly.parts[1].mesh);
    EXPECT_NEAR(volume_mm3(split->assembly.parts[1].mesh) / whole, 0.25, 1e-3);
    EXPECT_EQ(split->notes.back(), "by hand: split P02:x=0.25");
    // Interfaces of 10 x 40, 30 x 40 and 40 x 50.
    ASSERT_EQ(split->necks_mm.size(), split->assembly.interfaces.size());
    for (std::size_t i = 0; i < split->necks_mm.size(); ++i) {
        EXPECT_GT(split->necks_mm[i], 0.98 * 10);
        EXPECT_LT(split->necks_mm[i], 1.02 * 40);
    }
    const auto again = replayed(work, *split);
    ASSERT_TRUE(again.has_value()) << again.error().text();
    expect_same(*split, *again);
}

TEST(ByHand, InAPolycubeASplitFollowsTheBendOfTheBox) {
    // The map bends x with z: planes across x lean as it does.
    for (const Mode mode : {Mode::Sheets, Mode::Paper}) {
        const Work work = by_polycube(mode, false);
        const auto plain = cut(work);
        ASSERT_TRUE(plain.has_value());
        const auto split = edited(work, {"split P01:x=0.5"});
        ASSERT_TRUE(split.has_value()) << split.error().text();
        ASSERT_EQ(split->assembly.parts.size(), plain->assembly.parts.size() + 1);
        expect_exact_sum(work, *split);
        // P01 is the stem, z from 0 to 20: x grows by 0.005 * 20^2 on the way.
        const decomp::part::Plane& plane = split->plan.steps.back().plane;
        EXPECT_NEAR(plane.normal.z() / plane.normal.x(), -0.005 * 20, 0.01);
        const double whole = volume_mm3(plain->assembly.parts[0].mesh);
        for (const decomp::part::Part& part : split->assembly.parts) {
            const double share = volume_mm3(part.mesh) / whole;
            EXPECT_TRUE(std::abs(share - 0.5) < 0.02 || share > 0.9) << part.id << share;
        }
    }
}

TEST(ByHand, AMergeGivesOnePartFewer) {
    for (const Work& work : {by_sections(tests::box({0, 0, 0}, {40, 40, 100}), 60, 60, 120),
                             by_polycube(Mode::Sheets, false)}) {
        Work apart = work;
        const auto plain = edited(apart, {"plane 0 0 1 15", "plane 0 0 1 30"});
        ASSERT_TRUE(plain.has_value()) << plain.error().text();
        apart.options = {};
        apart.options.plan = std::make_shared<const decomp::plan::Plan>(plain->plan);
        const auto merged = edited(apart, {"merge P01+P02"});
        ASSERT_TRUE(merged.has_value()) << merged.error().text();
        EXPECT_EQ(merged->assembly.parts.size() + 1, plain->assembly.parts.size());
        expect_exact_sum(work, *merged);
        const auto again = replayed(work, *merged);
        ASSERT_TRUE(again.has_value()) << again.error().text();
        expect_same(*merged, *again);
    }
}

TEST(ByHand, APlaneCutsExactlyWhereItSaysEveryPartThatItMeets) {
    const Work work = by_sections(tests::box({0, 0, 0}, {40, 40, 100}), 60, 60, 60);
    const auto cut_up = edited(work, {"plane 2 0 0 13"});
    ASSERT_TRUE(cut_up.has_value()) << cut_up.error().text();
    ASSERT_EQ(cut_up->assembly.parts.size(), 4U);
    double left = 0;
    for (const decomp::part::Part& part : cut_up->assembly.parts) {
        const Eigen::AlignedBox3d box = decomp::mesh::bounds(part.mesh);
        EXPECT_TRUE(box.max().x() == 13 || box.min().x() == 13) << part.id;
        left += box.max().x() == 13 ? volume_mm3(part.mesh) : 0;
    }
    EXPECT_NEAR(left, 13.0 * 40 * 100, 1e-6);
}

TEST(ByHand, EditsFollowEachOtherAndPiecesAreNamedAfterTheirPart) {
    const Work work = by_sections(tests::box({0, 0, 0}, {40, 40, 50}), 60, 60, 60);
    const auto done = edited(work, {"split P01:z=0.5", "split P01.2:x=0.5", "merge P01.1+P01.2.2"});
    ASSERT_TRUE(done.has_value()) << done.error().text();
    EXPECT_EQ(done->assembly.parts.size(), 2U);
    expect_exact_sum(work, *done);
    const auto late = edited(work, {"split P01:z=0.5", "split P01:x=0.5"});
    ASSERT_FALSE(late.has_value());
    EXPECT_EQ(late.error().code, "plan.no_such_part");
    EXPECT_EQ(late.error().hint, "it was cut into P01.1, P01.2");
}

TEST(ByHand, WhatCannotBeDoneSaysWhy) {
    const Work work = by_sections(tests::box({0, 0, 0}, {40, 40, 160}), 60, 60, 60);

    struct Case {
        const char* text;
        const char* code;
    };

    for (const Case& one :
         {Case{"split P9:z=0.5", "plan.no_such_part"}, Case{"merge P01+P03", "plan.not_neighbours"},
          Case{"merge P01+P02", "plan.does_not_fit"}, Case{"plane 0 0 1 500", "plan.cut_misses"}}) {
        const auto done = edited(work, {one.text});
        ASSERT_FALSE(done.has_value()) << one.text;
        EXPECT_EQ(done.error().code, one.code) << done.error().text();
        EXPECT_FALSE(done.error().message.empty());
    }
}

TEST(ByHand, ARefusedMergeSaysWhatThePartTouches) {
    const Work work = by_sections(tests::box({0, 0, 0}, {40, 40, 160}), 60, 60, 60);
    const auto done = edited(work, {"merge P01+P03"});
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().hint, "P01 touches P02");
}

TEST(ByHand, APlaneThatMissesSaysWhereTheShapeIs) {
    const Work work = by_sections(tests::box({0, 0, -5}, {40, 40, 45}), 60, 60, 60);
    const auto done = edited(work, {"plane 0 0 -1 6"});
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().hint, "along this normal the shape reaches from -45 to 5 mm");
}

TEST(ByHand, ASplitInThePolycubeOfAPlanNeedsThePolycube) {
    Work work = by_polycube(Mode::Sheets, false);
    const auto first = cut(work);
    ASSERT_TRUE(first.has_value());
    auto map = work.options.map;
    work.options = {};
    work.options.plan = std::make_shared<const decomp::plan::Plan>(first->plan);
    const auto without = edited(work, {"split P01:x=0.5"});
    ASSERT_FALSE(without.has_value());
    EXPECT_EQ(without.error().code, "plan.no_polycube");
    work.options.map = map;
    const auto with = edited(work, {"split P01:x=0.5"});
    ASSERT_TRUE(with.has_value()) << with.error().text();
    expect_same(*with, *edited(by_polycube(Mode::Sheets, false), {"split P01:x=0.5"}));
}

}  // namespace
