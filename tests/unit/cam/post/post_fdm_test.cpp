// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/post_fdm.h"

#include "tests/support/stacks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>

namespace {

using cam::post::post_fdm;

cam::profile::FdmSetup creator() {
    return cam::profile::read_fdm_setup("flashforge-creator-pro").value();
}

std::string text_of(const cam::path::LayerStack& stack, const cam::profile::FdmSetup& setup) {
    const auto program = post_fdm(stack, setup, {"P01"}, {});
    EXPECT_TRUE(program) << program.error().text();
    return program ? program->text : "";
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        out.push_back(line);
    }
    return out;
}

std::size_t line_of(const std::vector<std::string>& lines, const std::string& wanted) {
    return static_cast<std::size_t>(std::find(lines.begin(), lines.end(), wanted) - lines.begin());
}

TEST(PostFdm, HeatsAndWaitsBeforeTheFirstBead) {
    const auto lines = lines_of(text_of(tests::tower(3), creator()));
    const std::size_t first_bead = line_of(lines, ";LAYER:0");
    ASSERT_LT(first_bead, lines.size());
    EXPECT_LT(line_of(lines, "M134 T0 (wait for the bed)"), first_bead);
    EXPECT_LT(line_of(lines, "M133 T0 (wait for the nozzle)"), first_bead);
    EXPECT_LT(line_of(lines, "M104 S215 T0"), line_of(lines, "M133 T0 (wait for the nozzle)"));
}

TEST(PostFdm, TemperatureAndFanChangeAtTheirLayers) {
    cam::profile::FdmSetup setup = creator();
    setup.material.fan_from_layer = 2;
    const auto lines = lines_of(text_of(tests::tower(4), setup));
    EXPECT_GT(line_of(lines, "M104 S210 T0"), line_of(lines, ";LAYER:1"));
    EXPECT_LT(line_of(lines, "M104 S210 T0"), line_of(lines, ";LAYER:2"));
    EXPECT_GT(line_of(lines, "M126 T0"), line_of(lines, ";LAYER:2"));
    EXPECT_LT(line_of(lines, "M126 T0"), line_of(lines, ";LAYER:3"));
}

TEST(PostFdm, AFanWithSpeedsGetsItsSpeed) {
    const auto setup = cam::profile::read_fdm_setup("prusa-mk3s", "petg").value();
    auto stack = tests::tower(5);
    for (auto& layer : stack.layers) {
        for (auto& bead : layer.beads) {
            for (auto& point : bead.points) {
                point += Eigen::Vector2d(100, 100);
            }
        }
    }
    EXPECT_NE(text_of(stack, setup).find("\nM106 S128\n"), std::string::npos);
}

TEST(PostFdm, SaysWhatEachBeadIs) {
    const std::string text = text_of(tests::tower(2), creator());
    for (const char* comment :
         {";LAYER:1\n", ";Z:0.4\n", ";HEIGHT:0.2\n", ";TYPE:outer-wall\n", ";TYPE:inner-wall\n",
          ";TYPE:sparse-infill\n", ";WIDTH:0.45\n", "; estimated printing time = "}) {
        EXPECT_NE(text.find(comment), std::string::npos) << comment;
    }
}

TEST(PostFdm, ProgressRisesAndLeavesBeginningAndEndToTheTemplates) {
    const std::string text = text_of(tests::tower(30), creator());
    const std::regex progress("\nM73 P([0-9]+)");
    std::vector<int> seen;
    for (auto it = std::sregex_iterator(text.begin(), text.end(), progress);
         it != std::sregex_iterator(); ++it) {
        seen.push_back(std::stoi((*it)[1]));
    }
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.front(), 0);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 100), 1);
    EXPECT_GE(seen.size(), 30U);
}

TEST(PostFdm, ProgressIsToldWithinALayerToo) {
    auto stack = tests::tower(2);
    for (auto& layer : stack.layers) {
        const auto once = layer.beads;
        for (int i = 0; i < 30; ++i) {
            layer.beads.insert(layer.beads.end(), once.begin(), once.end());
        }
    }
    const std::string text = text_of(stack, creator());
    const std::size_t second = text.find(";LAYER:1\n");
    const auto told = [&](const std::string& part) {
        const std::regex progress("\nM73 P");
        return std::distance(std::sregex_iterator(part.begin(), part.end(), progress),
                             std::sregex_iterator());
    };
    EXPECT_GT(told(text.substr(0, second)), 20);
    EXPECT_GT(told(text.substr(second)), 20);
}

TEST(PostFdm, WritesTheSameBytesEachTime) {
    EXPECT_EQ(text_of(tests::tower(3), creator()), text_of(tests::tower(3), creator()));
}

TEST(PostFdm, NothingLeavesTheChamber) {
    const auto code = [](const cam::path::LayerStack& stack) {
        const auto program = post_fdm(stack, creator(), {}, {});
        return program ? std::string() : program.error().code;
    };
    EXPECT_EQ(code({{{0.2, 0.2, {tests::square_bead(93.5, 0, 20)}}}}), "");
    EXPECT_EQ(code({{{0.2, 0.2, {tests::square_bead(93.6, 0, 20)}}}}), "post.outside_chamber");
    EXPECT_EQ(code({{{150.1, 0.2, {tests::square_bead(0, 0, 20)}}}}), "post.outside_chamber");
}

TEST(PostFdm, RefusesStacksThatMakeNoSense) {
    const auto code = [](const cam::path::LayerStack& stack) {
        const auto program = post_fdm(stack, creator(), {}, {});
        return program ? std::string() : program.error().code;
    };
    auto falling = tests::tower(2);
    falling.layers[1].z_mm = 0.2;
    EXPECT_EQ(code(falling), "post.bad_layer");
    auto nowhere = tests::tower(1);
    nowhere.layers[0].beads[0].points[0].x() = std::nan("");
    EXPECT_EQ(code(nowhere), "post.bad_layer");
    auto flat = tests::tower(1);
    flat.layers[0].beads[0].height_mm = 0;
    EXPECT_EQ(code(flat), "post.bad_layer");
    EXPECT_EQ(code({}), "post.empty");
}

TEST(PostFdm, AForbiddenWordIsAnErrorWithItsLine) {
    cam::profile::FdmSetup setup = creator();
    setup.machine.templates.end += "M109 S0\n";
    const auto program = post_fdm(tests::tower(1), setup, {}, {});
    ASSERT_FALSE(program);
    EXPECT_EQ(program.error().code, "post.forbidden_word");
    EXPECT_NE(program.error().where, "line 0");
}

TEST(PostFdm, ATitleCannotSmuggleInCommands) {
    const auto program = post_fdm(tests::tower(1), creator(), {"P01\nM109 S60"}, {});
    ASSERT_TRUE(program);
    EXPECT_EQ(program->text.find("\nM109"), std::string::npos);
}

TEST(PostFdm, AbsoluteFilamentStartsFromZeroInEachLayer) {
    cam::profile::FdmSetup setup = creator();
    setup.dialect.relative_e = false;
    const std::string text = text_of(tests::tower(3), setup);
    EXPECT_NE(text.find("\nM82\n"), std::string::npos);
    std::size_t resets = 0;
    for (std::size_t at = text.find("A0 B0\nG"); at != std::string::npos;
         at = text.find("A0 B0\nG", at + 1)) {
        ++resets;
    }
    EXPECT_GE(resets, 1U);
    EXPECT_EQ(text.find("G92 X0 Y0 Z0"), std::string::npos);
}

TEST(PostFdm, ACancelledRunIsToldSo) {
    std::stop_source source;
    source.request_stop();
    decomp::Run run;
    run.stop = source.get_token();
    const auto program = post_fdm(tests::tower(1), creator(), {}, run);
    ASSERT_FALSE(program);
    EXPECT_EQ(program.error().code, "run.cancelled");
}

}  // namespace
