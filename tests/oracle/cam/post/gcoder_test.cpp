// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/post_fdm.h"
#include "decomp/base/file.h"
#include "tests/support/stacks.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

namespace {

constexpr const char* kPython = "/usr/bin/python3";

constexpr const char* kScript = R"(
import sys
from printrun import gcoder
code = gcoder.GCode(open(sys.argv[1]))
beads = [line for line in code if line.extruding and line.is_move]
print(code.filament_length, min(b.current_x for b in beads), max(b.current_x for b in beads),
      min(b.current_y for b in beads), max(b.current_y for b in beads), max(b.current_z for b in beads))
)";

struct Opinion {
    double filament_mm = 0;
    double low_x = 0;
    double high_x = 0;
    double low_y = 0;
    double high_y = 0;
    double high_z = 0;
};

class Gcoder : public testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        if (std::system((std::string(kPython) + " -c 'from printrun import gcoder' 2> /dev/null")
                            .c_str()) != 0) {
            GTEST_SKIP() << "printrun (package printcore) is not installed";
        }
    }

    [[nodiscard]] Opinion ask(const std::string& program) const {
        EXPECT_TRUE(decomp::write_file(folder_ / "p.gcode", program));
        EXPECT_TRUE(decomp::write_file(folder_ / "ask.py", kScript));
        const std::string folder = folder_.path().string();
        const std::string command = std::string(kPython) + " " + folder + "/ask.py " + folder +
                                    "/p.gcode > " + folder + "/said";
        EXPECT_EQ(std::system(command.c_str()), 0);
        std::istringstream said(decomp::read_file(folder_ / "said").value());
        Opinion out;
        said >> out.filament_mm >> out.low_x >> out.high_x >> out.low_y >> out.high_y >> out.high_z;
        return out;
    }

    tests::TempDir folder_;
};

TEST_P(Gcoder, AgreesOnFilamentAndBounds) {
    cam::profile::FdmSetup setup = cam::profile::read_fdm_setup(GetParam()).value();
    // Without the start and end templates, whose priming would hide the bounds of the beads.
    setup.machine.templates.start = "G28\nG92 X0 Y0 Z0 E0";
    setup.machine.templates.end = "M84";
    const Eigen::Vector2d centre =
        ((setup.machine.chamber.min_mm + setup.machine.chamber.max_mm) / 2).head<2>();
    for (const bool relative : {true, false}) {
        setup.dialect.relative_e = relative;
        setup.dialect.reset_e = "G92 E0";
        cam::path::LayerStack stack = tests::tower(40);
        for (auto& layer : stack.layers) {
            for (auto& bead : layer.beads) {
                for (auto& point : bead.points) {
                    point += centre;
                }
            }
        }
        const auto program = cam::post::post_fdm(stack, setup, {"P01"}, {});
        ASSERT_TRUE(program) << program.error().text();
        std::filesystem::remove(folder_ / "p.gcode");
        std::filesystem::remove(folder_ / "ask.py");
        const Opinion opinion = ask(program->text);
        EXPECT_NEAR(opinion.filament_mm, program->estimate.filament_mm, 0.01);
        EXPECT_NEAR(opinion.low_x, centre.x() - 20, 1e-3);
        EXPECT_NEAR(opinion.high_x, centre.x() + 20, 1e-3);
        EXPECT_NEAR(opinion.low_y, centre.y() - 20, 1e-3);
        EXPECT_NEAR(opinion.high_y, centre.y() + 20, 1e-3);
        EXPECT_NEAR(opinion.high_z, 8, 1e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(Machines, Gcoder, testing::Values("flashforge-creator-pro", "prusa-mk3s"));

}  // namespace
