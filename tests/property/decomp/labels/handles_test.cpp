// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes with handles get labels that a polycube can have.
#include "tests/support/handles.h"

#include "decomp/labels/label.h"
#include "decomp/labels/report.h"
#include "decomp/mesh/check.h"
#include "decomp/proxy/proxy.h"

#include <gtest/gtest.h>

namespace {

using decomp::labels::LabelReport;

TEST(Handles, EveryShapeHasTheGenusItClaims) {
    for (const auto& shape : tests::handle_shapes()) {
        const auto is = decomp::mesh::check_topology(shape.mesh);
        EXPECT_TRUE(is.manifold()) << shape.name;
        EXPECT_EQ(is.components, 1U) << shape.name;
        EXPECT_EQ(is.euler_characteristic, 2 - 2 * shape.genus) << shape.name;
    }
}

TEST(Handles, AllAreLabelledValidlyWithFewTurningPointsAndKeepTheirGenus) {
    decomp::Run run;
    int turning_points = 0;
    for (const auto& shape : tests::handle_shapes()) {
        const auto proxy = decomp::proxy::make_proxy(shape.mesh, {}, run);
        ASSERT_TRUE(proxy) << shape.name << ": " << proxy.error().text();
        EXPECT_FALSE(proxy->wrapped) << shape.name;
        EXPECT_EQ(decomp::mesh::check_topology(proxy->surface).euler_characteristic,
                  2 - 2 * shape.genus)
            << shape.name;
        const auto labels = decomp::labels::label(proxy->surface, {}, {}, run);
        ASSERT_TRUE(labels) << shape.name;
        const LabelReport is = decomp::labels::report(proxy->surface, *labels);
        EXPECT_TRUE(is.valid()) << shape.name;
        EXPECT_GT(is.fidelity, 0.65) << shape.name;
        turning_points += is.turning_points;
    }
    EXPECT_LE(turning_points, 6);
}

TEST(Handles, AHandLosesChartsAsCompactnessRises) {
    decomp::Run run;
    const auto proxy = decomp::proxy::make_proxy(tests::hand().mesh, {}, run);
    ASSERT_TRUE(proxy);
    std::vector<int> charts;
    for (const double compactness : {1.0, 3.0, 6.0, 10.0}) {
        const auto labels = decomp::labels::label(
            proxy->surface, {},
            {.compactness = compactness, .repair = decomp::labels::RepairMode::None}, run);
        ASSERT_TRUE(labels);
        charts.push_back(decomp::labels::report(proxy->surface, *labels).charts);
    }
    EXPECT_TRUE(std::is_sorted(charts.rbegin(), charts.rend()));
    EXPECT_GT(charts.front(), charts.back());
}

}  // namespace
