// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/proxy/proxy.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace {

using decomp::proxy::make_proxy;

decomp::proxy::Proxy proxy_of(const tests::TriMesh& mesh, int triangles) {
    decomp::Run run;
    auto proxy = make_proxy(mesh, {.triangles = triangles}, run);
    EXPECT_TRUE(proxy) << (proxy ? "" : proxy.error().text());
    return proxy ? *proxy : decomp::proxy::Proxy{};
}

TEST(Proxy, AFineSphereBecomesACoarseOneOfTheSameVolume) {
    const auto fine = tests::sphere(20, 160, 80);
    const auto proxy = proxy_of(fine, 2000);
    EXPECT_NEAR(static_cast<double>(proxy.surface.triangles.size()), 2000, 500);
    EXPECT_TRUE(decomp::mesh::check_topology(proxy.surface).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(proxy.surface) / decomp::mesh::volume_mm3(fine), 1, 0.02);
    EXPECT_LT(proxy.distance_mm, proxy.edge_mm);
    EXPECT_FALSE(proxy.wrapped);
}

TEST(Proxy, TwelveTrianglesOfABoxBecomeManyAndItsEdgesStaySharp) {
    const auto box = tests::box({0, 0, 0}, {30, 20, 10});
    const auto proxy = proxy_of(box, 1500);
    EXPECT_GT(proxy.surface.triangles.size(), 1000U);
    EXPECT_NEAR(decomp::mesh::volume_mm3(proxy.surface), 6000, 1e-6);
    EXPECT_NEAR(decomp::mesh::area_mm2(proxy.surface), 2200, 1e-6);
}

TEST(Proxy, ATorusKeepsItsHole) {
    const auto proxy = proxy_of(tests::torus(30, 6, 120, 40), 1500);
    EXPECT_EQ(decomp::mesh::check_topology(proxy.surface).euler_characteristic, 0);
}

TEST(Proxy, ACavityStaysAndACrumbIsLeftOut) {
    const auto hollow =
        tests::joined(tests::sphere(20, 64, 31), tests::flipped(tests::sphere(10, 48, 23)));
    const auto proxy = proxy_of(hollow, 2000);
    EXPECT_EQ(decomp::mesh::check_topology(proxy.surface).components, 2U);
    EXPECT_NEAR(proxy.volume_share, 1, 0.03);

    const auto crumb =
        tests::joined(tests::sphere(20, 64, 31), tests::box({30, 0, 0}, {30.1, 0.1, 0.1}));
    const auto without = proxy_of(crumb, 2000);
    EXPECT_EQ(decomp::mesh::check_topology(without.surface).components, 1U);
    EXPECT_EQ(without.shells_dropped, 1U);
}

TEST(Proxy, AThinPlateGetsMoreTrianglesThanABallWhenTheThicknessChooses) {
    const auto plate = proxy_of(tests::box({0, 0, 0}, {60, 60, 3}), 0);
    const auto ball = proxy_of(tests::sphere(20, 64, 31), 0);
    EXPECT_GT(plate.surface.triangles.size(), 2 * ball.surface.triangles.size());
    EXPECT_LT(plate.surface.triangles.size(), 13000U);
    EXPECT_GT(ball.surface.triangles.size(), 1000U);
}

TEST(Proxy, TheSameInputGivesTheSamePoints) {
    const auto torus = tests::torus(30, 9, 60, 30);
    const auto once = proxy_of(torus, 1000);
    const auto twice = proxy_of(torus, 1000);
    EXPECT_EQ(once.surface.triangles, twice.surface.triangles);
    EXPECT_EQ(once.surface.points, twice.surface.points);
}

TEST(Proxy, NothingAndInsideOutAndAbsurdOptionsAreRefused) {
    decomp::Run run;
    EXPECT_EQ(make_proxy({}, {}, run).error().code, "proxy.empty");
    const auto box = tests::box({0, 0, 0}, {1, 1, 1});
    EXPECT_EQ(make_proxy(tests::flipped(box), {}, run).error().code, "proxy.empty");
    EXPECT_EQ(make_proxy(box, {.triangles = 12}, run).error().code, "proxy.options");
}

TEST(Proxy, ACancelledRunSaysSo) {
    std::stop_source source;
    source.request_stop();
    decomp::Run run;
    run.stop = source.get_token();
    EXPECT_EQ(make_proxy(tests::sphere(5, 24, 11), {}, run).error().code, "run.cancelled");
}

}  // namespace
