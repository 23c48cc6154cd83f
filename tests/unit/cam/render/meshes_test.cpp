// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/render.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include "decoded.h"
#include <gtest/gtest.h>

#include <numbers>

namespace {

using namespace cam::render;
using tests::box;
using tests::decoded;
using tests::pixels_unlike;

constexpr Rgb kWhite{255, 255, 255};

Item item_of(const decomp::mesh::TriMesh& mesh) {
    Item item;
    item.mesh = &mesh;
    return item;
}

ViewOptions small(View view) {
    ViewOptions options;
    options.view = view;
    options.width_px = 200;
    options.height_px = 150;
    options.margin = 0.1;
    return options;
}

Image picture(const std::vector<Item>& items, const ViewOptions& options) {
    decomp::Run run;
    const auto bytes = render_meshes_png(items, options, run);
    EXPECT_TRUE(bytes.has_value()) << (bytes ? "" : bytes.error().text());
    return bytes ? decoded(*bytes) : Image();
}

TEST(Meshes, ABoxFromTheFrontFillsItsRectangle) {
    const auto mesh = box({0, 0, 0}, {40, 7, 20});
    const auto options = small(View::Front);
    const double scale = fitted_scale_px_per_mm({item_of(mesh)}, options);
    EXPECT_DOUBLE_EQ(scale, (200 - 2 * 0.1 * 150) / 40);
    const auto image = picture({item_of(mesh)}, options);
    ASSERT_EQ(image.width_px, 200);
    ASSERT_EQ(image.height_px, 150);
    const double width = 40 * scale;
    const double height = 20 * scale;
    EXPECT_NEAR(static_cast<double>(pixels_unlike(image, kWhite)), width * height,
                2 * (width + height));
}

TEST(Meshes, EachViewShowsItsOwnSideOfABox) {
    const auto mesh = box({0, 0, 0}, {30, 20, 10});
    const auto area = [&](View view) {
        const auto options = small(view);
        const double scale = fitted_scale_px_per_mm({item_of(mesh)}, options);
        return static_cast<double>(pixels_unlike(picture({item_of(mesh)}, options), kWhite)) /
               (scale * scale);
    };
    EXPECT_NEAR(area(View::Front), 300, 15);
    EXPECT_NEAR(area(View::Back), 300, 15);
    EXPECT_NEAR(area(View::Left), 200, 15);
    EXPECT_NEAR(area(View::Right), 200, 15);
    EXPECT_NEAR(area(View::Top), 600, 20);
    EXPECT_NEAR(area(View::Bottom), 600, 20);
}

TEST(Meshes, ASphereCoversTheAreaOfItsCircle) {
    const auto mesh = tests::sphere(10, 96, 64);
    const auto options = small(View::Iso);
    const double radius = 10 * fitted_scale_px_per_mm({item_of(mesh)}, options);
    const auto image = picture({item_of(mesh)}, options);
    EXPECT_NEAR(static_cast<double>(pixels_unlike(image, kWhite)),
                std::numbers::pi * radius * radius, 2 * std::numbers::pi * radius);
}

TEST(Meshes, FarFromTheOriginTheSilhouetteStaysTheSame) {
    const auto near = tests::sphere(10, 48, 32);
    auto far = near;
    for (auto& point : far.points) {
        point += Eigen::Vector3d(5000, -3000, 8000);
    }
    const auto options = small(View::Front);
    EXPECT_NEAR(static_cast<double>(pixels_unlike(picture({item_of(near)}, options), kWhite)),
                static_cast<double>(pixels_unlike(picture({item_of(far)}, options), kWhite)), 4);
}

TEST(Meshes, TopShowsXToTheRightAndYUpward) {
    const auto base = box({0, 0, 0}, {20, 20, 1});
    const auto knob = box({15, 15, 1}, {20, 20, 2});
    Item red = item_of(knob);
    red.colour = {255, 0, 0};
    Item grey = item_of(base);
    grey.colour = {128, 128, 128};
    auto options = small(View::Top);
    options.edges = false;
    const auto image = picture({grey, red}, options);
    double x = 0;
    double y = 0;
    int count = 0;
    for (int row = 0; row < image.height_px; ++row) {
        for (int column = 0; column < image.width_px; ++column) {
            const Rgb c = image.at(column, row);
            if (c.red > 60 && c.green == 0) {
                x += column;
                y += row;
                ++count;
            }
        }
    }
    ASSERT_GT(count, 100);
    EXPECT_GT(x / count, image.width_px / 2.0 + 20);
    EXPECT_LT(y / count, image.height_px / 2.0 - 20);
}

TEST(Meshes, TheNearerOfTwoItemsIsSeen) {
    const auto mesh = box({0, 0, 0}, {10, 10, 10});
    Item behind = item_of(mesh);
    behind.colour = {0, 0, 255};
    behind.offset = {0, 30, 0};
    Item before = item_of(mesh);
    before.colour = {255, 0, 0};
    const auto image = picture({behind, before}, small(View::Front));
    for (const auto& pixel : image.pixels) {
        ASSERT_EQ(pixel.blue > pixel.red, false) << "the hidden item shows";
    }
}

TEST(Meshes, HighlightedTrianglesAreTinted) {
    const auto mesh = box({0, 0, 0}, {10, 10, 10});
    Item plain = item_of(mesh);
    plain.colour = {40, 60, 120};
    Item marked = plain;
    marked.highlighted_triangles.assign(mesh.triangles.size(), true);
    const auto options = small(View::Front);
    const auto middle = [](const Image& image) { return image.at(100, 75); };
    const Rgb without = middle(picture({plain}, options));
    const Rgb with = middle(picture({marked}, options));
    EXPECT_GT(with.red, without.red + 40);
}

TEST(Meshes, TheBytesDoNotDependOnTheNumberOfThreads) {
    const auto mesh = tests::torus(20, 7, 40, 24);
    decomp::Run one;
    decomp::Run many;
    many.jobs = 4;
    const auto first = render_meshes_png({item_of(mesh)}, small(View::Iso), one);
    const auto second = render_meshes_png({item_of(mesh)}, small(View::Iso), many);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
}

TEST(Meshes, NothingToDrawIsAnError) {
    decomp::Run run;
    const auto bytes = render_meshes_png({}, {}, run);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, "render.empty");
}

TEST(Meshes, APictureOfNoSizeIsAnError) {
    const auto mesh = box({0, 0, 0}, {1, 1, 1});
    decomp::Run run;
    ViewOptions options;
    options.width_px = 0;
    const auto bytes = render_meshes_png({item_of(mesh)}, options, run);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, "render.size");
}

TEST(Meshes, ACancelledRunGivesNoPicture) {
    const auto mesh = box({0, 0, 0}, {1, 1, 1});
    std::stop_source stop;
    stop.request_stop();
    decomp::Run run;
    run.stop = stop.get_token();
    const auto bytes = render_meshes_png({item_of(mesh)}, {}, run);
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, "run.cancelled");
}

TEST(Views, HaveNamesAndAnUnknownOneIsAnError) {
    EXPECT_EQ(view_named("bottom").value(), View::Bottom);
    ASSERT_FALSE(view_named("behind"));
    EXPECT_EQ(view_named("behind").error().code, "render.view");
}

decomp::part::Assembly two_halves() {
    decomp::part::Assembly assembly;
    for (int i = 0; i < 2; ++i) {
        decomp::part::Part part;
        part.id = i == 0 ? "P01" : "P02";
        part.mesh = box({i * 10.0, 0, 0}, {i * 10.0 + 10, 10, 10});
        part.sources.resize(12);
        part.sources[0].plane = 0;
        assembly.parts.push_back(part);
    }
    return assembly;
}

TEST(Explode, MovesEachPartAwayFromTheCentreByTheFraction) {
    const auto assembly = two_halves();
    const auto items = explode(assembly, 0.5);
    ASSERT_EQ(items.size(), 2U);
    EXPECT_EQ(items[0].offset, Eigen::Vector3d(-2.5, 0, 0));
    EXPECT_EQ(items[1].offset, Eigen::Vector3d(2.5, 0, 0));
    EXPECT_NE(items[0].colour, items[1].colour);
    EXPECT_TRUE(items[0].highlighted_triangles[0]);
    EXPECT_FALSE(items[0].highlighted_triangles[1]);
}

TEST(Explode, OpensAGapThatTheBackgroundShowsThrough) {
    const auto assembly = two_halves();
    const auto image = picture(explode(assembly, 1.0), small(View::Front));
    EXPECT_EQ(image.at(100, 75), kWhite);
    EXPECT_NE(picture(explode(assembly, 0.0), small(View::Front)).at(100, 75), kWhite);
}

TEST(Meshes, EachTriangleHasItsOwnColour) {
    const auto mesh = box({0, 0, 0}, {40, 7, 20});
    Item item = item_of(mesh);
    item.triangle_colours.assign(mesh.triangles.size(), Rgb{0, 200, 0});
    const Image image = picture({item}, small(View::Front));
    const Rgb middle = image.at(100, 75);
    EXPECT_GT(middle.green, 100);
    EXPECT_LT(middle.red, 30);
    EXPECT_LT(middle.blue, 30);
}

TEST(Meshes, AStrokeIsDottedWhereItIsHidden) {
    const auto mesh = box({-20, -20, -20}, {20, 20, 20});
    ViewOptions options = small(View::Front);
    options.strokes = {{.from = {-35, 0, 0}, .to = {35, 0, 0}, .colour = {255, 0, 0}}};
    const Image image = picture({item_of(mesh)}, options);
    const auto red_in = [&](int from, int to) {
        int count = 0;
        for (int x = from; x < to; ++x) {
            count += image.at(x, 75) == Rgb{255, 0, 0} ? 1 : 0;
        }
        return count;
    };
    // 70 mm are 170 pixels: the box is 97 pixels wide in the middle.
    EXPECT_EQ(red_in(20, 48), 28);
    EXPECT_EQ(red_in(152, 180), 28);
    EXPECT_NEAR(red_in(60, 140), 40, 12);
}

TEST(Meshes, TheLegendStandsInTheLowerLeftCorner) {
    const auto mesh = box({0, 0, 0}, {1, 1, 1});
    ViewOptions options = small(View::Front);
    options.legend = {{{1, 2, 3}, "PLATE"}};
    const Image image = picture({item_of(mesh)}, options);
    EXPECT_EQ(image.at(19, 131), (Rgb{1, 2, 3}));
}

}  // namespace
