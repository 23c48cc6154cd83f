// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/render.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"

#include "decoded.h"
#include <gtest/gtest.h>

#include <numbers>

namespace {

using namespace cam::render;
using cam::path::Bead;
using cam::path::Feature;
using cam::path::Layer;
using cam::path::LayerStack;
using tests::decoded;

constexpr Rgb kWhite{255, 255, 255};

Layer straight_bead(double z_mm) {
    Layer layer;
    layer.z_mm = z_mm;
    layer.height_mm = 0.2;
    Bead bead;
    bead.feature = Feature::OuterWall;
    bead.points = {{0, 0}, {10, 0}};
    bead.width_mm = 4;
    bead.height_mm = 0.2;
    layer.beads.push_back(bead);
    return layer;
}

LayerViewOptions small() {
    LayerViewOptions options;
    options.width_px = 300;
    options.height_px = 200;
    options.legend = false;
    return options;
}

Image picture(const Layer& layer) {
    decomp::Run run;
    const auto bytes = render_layer_png(layer, small(), run);
    EXPECT_TRUE(bytes.has_value());
    return bytes ? decoded(*bytes) : Image();
}

TEST(Layers, AStraightBeadIsAStadium) {
    const auto image = picture(straight_bead(0.2));
    const double scale = (300.0 - 16) / 14;  // 10 mm and two ends of 2 mm
    const double area = (10 * 4 + std::numbers::pi * 4) * scale * scale;
    EXPECT_NEAR(static_cast<double>(tests::pixels_unlike(image, kWhite)), area, 500);
    EXPECT_EQ(image.at(150, 100), feature_colour(Feature::OuterWall));
}

TEST(Layers, WhatIsPrintedLaterLiesOnTop) {
    auto layer = straight_bead(0.2);
    layer.beads.push_back(layer.beads.front());
    layer.beads.back().feature = Feature::Support;
    EXPECT_EQ(picture(layer).at(150, 100), feature_colour(Feature::Support));
}

TEST(Layers, ThePictureDoesNotDependOnTheNumberOfThreads) {
    LayerStack stack;
    for (int i = 1; i <= 5; ++i) {
        stack.layers.push_back(straight_bead(0.2 * i));
    }
    LayerViewOptions options;
    options.width_px = 900;
    options.height_px = 300;
    decomp::Run one;
    decomp::Run many;
    many.jobs = 3;
    const auto first = render_layers_png(stack, {0, 2, 4}, options, one);
    const auto second = render_layers_png(stack, {0, 2, 4}, options, many);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
    EXPECT_GT(tests::pixels_like(decoded(*first), feature_colour(Feature::OuterWall)), 1000);
}

TEST(Layers, ASheetOfFourShowsEachLayerOnce) {
    LayerStack stack;
    for (int i = 0; i < 4; ++i) {
        stack.layers.push_back(straight_bead(0.2 * i));
        stack.layers.back().beads[0].feature = static_cast<Feature>(i);
    }
    decomp::Run run;
    const auto bytes = render_layers_png(stack, {0, 1, 2, 3}, small(), run);
    ASSERT_TRUE(bytes);
    const auto image = decoded(*bytes);
    for (int i = 0; i < 4; ++i) {
        EXPECT_GT(tests::pixels_like(image, feature_colour(static_cast<Feature>(i))), 500) << i;
    }
}

TEST(Layers, AMissingLayerIsAnError) {
    decomp::Run run;
    const auto bytes = render_layers_png({}, {3}, {}, run);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, "render.layer");
}

TEST(Layers, ALayerWithoutBeadsIsAnError) {
    decomp::Run run;
    const auto bytes = render_layer_png({}, {}, run);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, "render.empty");
}

TEST(Layers, SpreadReachesFromTheFirstToTheLast) {
    LayerStack stack;
    stack.layers.resize(101);
    EXPECT_EQ(spread_layers(stack, 3), (std::vector<std::size_t>{0, 50, 100}));
    stack.layers.resize(2);
    EXPECT_EQ(spread_layers(stack, 9), (std::vector<std::size_t>{0, 1}));
}

TEST(BeadMeshes, AreClosedAndAsHighAsTheirLayer) {
    LayerStack stack;
    stack.layers = {straight_bead(0.2), straight_bead(0.4)};
    const auto meshes = bead_meshes(stack, 0, 2);
    ASSERT_EQ(meshes.size(), 1U);
    EXPECT_EQ(meshes[0].feature, Feature::OuterWall);
    EXPECT_TRUE(decomp::mesh::check_topology(meshes[0].mesh).manifold());
    EXPECT_NEAR(decomp::mesh::volume_mm3(meshes[0].mesh), 2 * 14 * 4 * 0.2, 1e-9);
}

}  // namespace
