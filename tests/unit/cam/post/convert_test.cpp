// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/convert.h"

#include "cam/post/post_fdm.h"
#include "decomp/base/file.h"
#include "tests/support/stacks.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace {

using cam::post::convert;
using Converter = cam::profile::FdmMachine::Converter;

class Convert : public testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(decomp::write_file(in_, "G28\n")); }

    tests::TempDir folder_;
    std::filesystem::path in_ = folder_ / "a plate $(x).gcode";
    std::filesystem::path out_ = folder_ / "a plate $(x).x3g";
};

TEST_F(Convert, RunsWithoutAShell) {
    ASSERT_TRUE(convert(in_, out_, {"cp", "{in} {out}", "x3g"}));
    EXPECT_EQ(decomp::read_file(out_).value(), "G28\n");
}

TEST_F(Convert, AMissingProgramSaysWhatToInstall) {
    const auto status = convert(in_, out_, {"no-such-converter", "{in} {out}", "x3g"});
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, "post.converter_missing");
    EXPECT_EQ(status.error().hint, "apt install no-such-converter");
}

TEST_F(Convert, AFailureLeavesNothingBehindAndTellsWhatTheProgramSaid) {
    const auto status = convert(in_, out_, {"cp", "--no-such-option {in} {out}", "x3g"});
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, "post.converter_failed");
    ASSERT_FALSE(status.error().notes.empty());
    EXPECT_NE(status.error().notes.front().find("no-such-option"), std::string::npos);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1)
        << "only the program";
    const auto silent = convert(in_, out_, {"true", "{in} {out}", "x3g"});
    ASSERT_FALSE(silent);
    EXPECT_EQ(silent.error().code, "post.converter_failed");
}

TEST_F(Convert, StopsWhenTheRunIsCancelled) {
    std::stop_source source;
    source.request_stop();
    decomp::Run run;
    run.stop = source.get_token();
    const auto status = convert(in_, out_, {"sleep", "60", "x3g"}, run);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, "run.cancelled");
}

TEST_F(Convert, NoConverterIsAnError) {
    EXPECT_EQ(convert(in_, out_, Converter{}).error().code, "post.no_converter");
}

TEST_F(Convert, GpxTakesAPostedProgramWithoutAWarning) {
    if (std::system("command -v gpx > /dev/null") != 0) {
        GTEST_SKIP() << "gpx is not installed";
    }
    const auto setup = cam::profile::read_fdm_setup("flashforge-creator-pro").value();
    const auto program = cam::post::post_fdm(tests::tower(20), setup, {"P01"}, {});
    ASSERT_TRUE(program);
    ASSERT_TRUE(decomp::write_file(in_, program->text, decomp::Overwrite::Allow));
    ASSERT_TRUE(convert(in_, out_, setup.machine.converter));
    EXPECT_GT(std::filesystem::file_size(out_), 1000U);
    // gpx writes the name of the file into it, so only files of one name can be equal.
    std::filesystem::create_directory(folder_ / "elsewhere");
    ASSERT_TRUE(decomp::write_file(folder_ / "b.gcode", program->text));
    const std::filesystem::path again = folder_ / "elsewhere" / out_.filename();
    ASSERT_TRUE(convert(folder_ / "b.gcode", again, setup.machine.converter));
    EXPECT_TRUE(decomp::read_file(out_).value() == decomp::read_file(again).value());
    const std::string loud = "cd '" + folder_.path().string() +
                             "' && gpx -v -I -g -p -m fcp b.gcode check.x3g > said 2>&1";
    ASSERT_EQ(std::system(loud.c_str()), 0);
    const std::string said = decomp::read_file(folder_ / "said").value();
    EXPECT_EQ(said.find("arning"), std::string::npos) << said;
    EXPECT_EQ(said.find("rror"), std::string::npos) << said;
    const std::string length = "Extrusion length: ";
    ASSERT_NE(said.find(length), std::string::npos) << said;
    const double metres = std::stod(said.substr(said.find(length) + length.size()));
    constexpr double kPrimeMm = 5;
    EXPECT_NEAR(metres * 1000, program->estimate.filament_mm + kPrimeMm, 2);
}

}  // namespace
