// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/reach.h"
#include "cam/check/samples.h"
#include "decomp/base/rng.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/measure.h"
#include "tests/support/drop_cutter.h"
#include "tests/support/part_shapes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

/// What tool_reach() says, against a drop cutter in double precision that knows no grid.
namespace {

using cam::check::ReachOptions;
using cam::check::Samples;
using cam::tool::Shape;
using cam::tool::Tool;
using tests::Outline;
using tests::TriMesh;

constexpr double kCell = 0.1;
/// How far a grid may be off: the tip stands on the nearest of its points, a place lies up to half
/// a diagonal of a cell beside it.
constexpr double kGrid = 0.75 * kCell;
/// Beside walls: they end somewhere between two grid points as well.
constexpr double kGridAtWalls = 1.75 * kCell;

constexpr int kFewRings = 6;    // enough to be sure of most points
constexpr int kManyRings = 32;  // so that hardly a place is missed

struct Case {
    Tool tool;
    Outline outline;
};

Case with(Shape shape, double diameter, double shank, double flute) {
    Case out;
    out.tool.shape = shape;
    out.tool.diameter_mm = diameter;
    out.tool.shank_diameter_mm = shank;
    out.tool.flute_mm = flute;
    out.tool.stickout_mm = 200;
    const double r = diameter / 2;
    switch (shape) {
        case Shape::Flat:
            out.outline = tests::flat_end(r);
            break;
        case Shape::BullNose:
            out.tool.corner_radius_mm = r / 3;
            out.outline = tests::bull_nose(r, r / 3);
            break;
        case Shape::V:
            out.tool.point = decomp::Angle::degrees(90);
            out.outline = tests::pointed(r, 1);
            break;
        default:
            out.outline = tests::ball_end(r);
    }
    return out;
}

/// Points of which both had to speak, and those where they contradict each other: the oracle is
/// sure of a point that is `kGrid` harder to reach, or finds no way to one that is `kGrid` easier.
struct Verdict {
    int asked = 0;
    int reached = 0;
    int missed = 0;
    int invented = 0;
};

/// Which points are asked, and how much easier a point must be that the oracle finds no way to.
struct Asking {
    std::size_t every = 1;
    double slack_mm = kGrid;
};

Verdict compare(const TriMesh& mesh, const Samples& samples, const Eigen::Vector3d& direction,
                const Case& one, const Asking& asking) {
    const ReachOptions options{.cell_mm = kCell, .tolerance_mm = 2 * kCell};
    const auto reach =
        cam::check::tool_reach(mesh, samples.pieces, direction, one.tool, options).value();
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond::FromTwoVectors(direction, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    TriMesh turned = mesh;
    for (auto& point : turned.points) {
        point = turn * point;
    }
    const double stem =
        one.tool.shank_diameter_mm / 2 + options.shank_clearance_mm + options.tolerance_mm;
    const tests::SweepOracle harder(turned, {one.outline, stem + kGrid, one.tool.flute_mm - kGrid});
    const tests::SweepOracle easier(
        turned, {one.outline, stem - asking.slack_mm, one.tool.flute_mm + asking.slack_mm});
    Verdict verdict;
    for (std::size_t i = 0; i < samples.facet.size(); i += asking.every) {
        const Eigen::Vector3d normal = turn * samples.pieces.unit[i];
        if (normal.z() < 0) {
            EXPECT_EQ(reach.tool[i], 0);
            continue;
        }
        const auto lifted = [&](double by) -> Eigen::Vector3d {
            return turn * samples.pieces.centre[i] + by * normal;
        };
        ++verdict.asked;
        verdict.reached += reach.tool[i];
        if (reach.tool[i] == 0) {
            verdict.missed +=
                harder.sweeps(lifted(options.tolerance_mm - kGrid), normal, kFewRings) ? 1 : 0;
        } else {
            verdict.invented +=
                easier.sweeps(lifted(options.tolerance_mm + asking.slack_mm), normal, kManyRings)
                    ? 0
                    : 1;
        }
    }
    return verdict;
}

void expect_agreement(const TriMesh& mesh, const std::vector<Eigen::Vector3d>& directions,
                      const std::vector<Case>& tools, const Asking& asking) {
    const auto samples =
        cam::check::sample_facets(mesh, decomp::mesh::measure_facets(mesh), {.spacing_mm = 1.5});
    for (const Case& one : tools) {
        Verdict sum;
        for (const Eigen::Vector3d& direction : directions) {
            const Verdict verdict = compare(mesh, samples, direction.normalized(), one, asking);
            sum.asked += verdict.asked;
            sum.reached += verdict.reached;
            sum.missed += verdict.missed;
            sum.invented += verdict.invented;
        }
        SCOPED_TRACE(std::string(cam::tool::name_of(one.tool.shape)) + " " +
                     std::to_string(one.tool.diameter_mm));
        EXPECT_GT(sum.asked, 40);
        EXPECT_EQ(sum.missed, 0) << "of " << sum.asked << ", reached " << sum.reached;
        EXPECT_EQ(sum.invented, 0) << "of " << sum.asked << ", reached " << sum.reached;
    }
}

std::vector<Case> long_tools() {
    return {with(Shape::Ball, 3, 3, 40), with(Shape::Ball, 6, 6, 40), with(Shape::Flat, 4, 4, 40),
            with(Shape::BullNose, 6, 6, 40), with(Shape::V, 6, 6, 40)};
}

/// Thick shanks, short flutes.
std::vector<Case> short_tools() { return {with(Shape::Ball, 3, 8, 5), with(Shape::Flat, 4, 4, 8)}; }

TEST(ToolReach, OfATorus) {
    expect_agreement(tests::torus(7, 3, 36, 18), {{0.3, -0.2, 1}, {1, 0.4, -0.3}}, long_tools(),
                     {.every = 3});
}

TEST(ToolReach, OfAWaist) {
    expect_agreement(tests::dumbbell(8, 3, 14, 2, 24), {{1, 0.1, 0}, {-0.5, -1, 0.2}}, long_tools(),
                     {.every = 23});
}

TEST(ToolReach, OfAHookWithLargeFacets) {
    expect_agreement(tests::hook(5, 20, 7), {{0, 0, 1}, {1, 0.4, -0.3}}, long_tools(),
                     {.slack_mm = kGridAtWalls});
}

TEST(ToolReach, OfACupByToolsTooShortForIt) {
    expect_agreement(tests::cup(7, 4, 14, 4, 32), {{0, 0, 1}, {0.1, -0.2, 1}}, short_tools(),
                     {.every = 9});
}

TEST(ToolReach, AToolOfTheWrongSizeIsFoundOut) {
    // A ball of 5 fits into the cup, one of 6 does not.
    const TriMesh mesh = tests::cup(7, 2.75, 14, 4, 32);
    const auto samples =
        cam::check::sample_facets(mesh, decomp::mesh::measure_facets(mesh), {.spacing_mm = 1.5});
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    Case wrong = with(Shape::Ball, 6, 5, 40);
    wrong.tool.diameter_mm = 5;
    EXPECT_GT(compare(mesh, samples, up, wrong, {.every = 9}).invented, 10);
    wrong = with(Shape::Ball, 5, 5, 40);
    wrong.tool.diameter_mm = 6;
    EXPECT_GT(compare(mesh, samples, up, wrong, {.every = 9}).missed, 10);
}

TEST(ToolReach, OfARealScan) {
    const char* models = std::getenv("HEW_MODELS");
    if (models == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    auto mesh = decomp::io::read_mesh(std::filesystem::path(models) / "paper/hfd_BU.obj", {}, {});
    ASSERT_TRUE(mesh.has_value()) << mesh.error().text();
    const double scale = 40 / decomp::mesh::bounds(*mesh).sizes().maxCoeff();
    for (auto& point : mesh->points) {
        point *= scale;
    }
    expect_agreement(*mesh, {{0, 1, 0}, {0.2, -1, 0.1}},
                     {with(Shape::Ball, 3, 3, 40), with(Shape::Flat, 4, 8, 12)}, {.every = 1499});
}

}  // namespace
