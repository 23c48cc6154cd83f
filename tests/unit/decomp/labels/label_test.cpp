// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/label.h"

#include "decomp/labels/report.h"
#include "decomp/proxy/proxy.h"
#include "tests/support/handles.h"
#include "tests/support/lattice_shapes.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using decomp::labels::AxisLabel;
using decomp::labels::label;
using decomp::labels::RepairMode;
using decomp::labels::report;

tests::TriMesh evenly(const tests::TriMesh& mesh, int triangles) {
    decomp::Run run;
    auto proxy = decomp::proxy::make_proxy(mesh, {.triangles = triangles}, run);
    EXPECT_TRUE(proxy) << (proxy ? "" : proxy.error().text());
    return proxy ? proxy->surface : tests::TriMesh{};
}

TEST(Label, APolycubeGetsItsOwnLabels) {
    decomp::Run run;
    for (const auto& solid :
         {tests::lattice_solid({{0, 0, 0}}, 6),
          tests::lattice_solid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 5), tests::lattice_ring(5)}) {
        const auto labels = label(solid.surface, {}, {.compactness = 3}, run);
        ASSERT_TRUE(labels);
        EXPECT_EQ(*labels, solid.labels);
    }
}

TEST(Label, ASphereHasTheSixChartsOfACube) {
    decomp::Run run;
    const auto sphere = evenly(tests::sphere(10, 96, 47), 3000);
    const auto labels = label(sphere, {}, {.compactness = 5}, run);
    ASSERT_TRUE(labels);
    const auto is = report(sphere, *labels);
    EXPECT_TRUE(is.valid());
    EXPECT_EQ(is.charts, 6);
    EXPECT_EQ(is.turning_points, 0);
}

TEST(Label, ChartsDoNotDependOnTheNumberOfTriangles) {
    decomp::Run run;
    const auto fine = tests::dumbbell(30, 12, 80, 5, 48);
    int first = 0;
    for (const int triangles : {1500, 4500}) {
        const auto surface = evenly(fine, triangles);
        const auto labels = label(surface, {}, {.compactness = 5}, run);
        ASSERT_TRUE(labels);
        const int charts = report(surface, *labels).charts;
        first = first == 0 ? charts : first;
        EXPECT_NEAR(charts, first, 2) << triangles;
    }
}

TEST(Label, NormalsFromOutsideAreFollowed) {
    decomp::Run run;
    const auto box = tests::lattice_solid({{0, 0, 0}}, 6);
    std::vector<Eigen::Vector3d> normals;
    for (const AxisLabel side : box.labels) {  // every side faces as if turned once about Z
        Eigen::Vector3d n = Eigen::Vector3d::Zero();
        n[axis_of(side)] = sign_of(side);
        normals.emplace_back(-n.y(), n.x(), n.z());
    }
    const auto labels = label(box.surface, normals, {}, run);
    ASSERT_TRUE(labels);
    for (std::size_t f = 0; f < labels->size(); ++f) {
        EXPECT_EQ(box.labels[f] == AxisLabel::PlusX, (*labels)[f] == AxisLabel::PlusY);
    }
}

TEST(Label, RepairMakesTwoGrownLinksValidAndKeepsTheirFidelity) {
    decomp::Run run;
    const auto links = evenly(tests::chain(2).mesh, 3500);
    const auto raw = label(links, {}, {.repair = RepairMode::None}, run);
    const auto mended = label(links, {}, {}, run);
    ASSERT_TRUE(raw && mended);
    const auto before = report(links, *raw);
    const auto after = report(links, *mended);
    EXPECT_FALSE(before.valid());
    EXPECT_TRUE(after.valid());
    EXPECT_GT(after.fidelity, before.fidelity - 0.15);
}

TEST(Label, ConstructionKeepsMoreThanDeletion) {
    decomp::Run run;
    const auto surface = evenly(tests::dumbbell(30, 12, 80, 5, 48), 3000);
    const auto built = label(surface, {}, {.compactness = 2}, run);
    const auto deleted =
        label(surface, {}, {.compactness = 2, .repair = RepairMode::Deletion}, run);
    ASSERT_TRUE(built && deleted);
    const auto is = report(surface, *built);
    EXPECT_TRUE(is.valid());
    EXPECT_GE(is.fidelity, report(surface, *deleted).fidelity);
}

TEST(Label, ACancelledRunSaysSo) {
    std::stop_source source;
    source.request_stop();
    decomp::Run run;
    run.stop = source.get_token();
    EXPECT_EQ(label(tests::box({0, 0, 0}, {1, 1, 1}), {}, {}, run).error().code, "run.cancelled");
}

TEST(Label, BadInputIsRefused) {
    decomp::Run run;
    const auto box = tests::box({0, 0, 0}, {1, 1, 1});
    EXPECT_EQ(label({}, {}, {}, run).error().code, "labels.surface");
    auto open = box;
    open.triangles.pop_back();
    EXPECT_EQ(label(open, {}, {}, run).error().code, "labels.surface");
    EXPECT_EQ(label(box, std::vector<Eigen::Vector3d>(3), {}, run).error().code, "labels.normals");
    EXPECT_EQ(label(box, {}, {.compactness = 0}, run).error().code, "labels.options");
    EXPECT_EQ(label(box, {}, {.smoothing = -1}, run).error().code, "labels.options");
}

}  // namespace
