// SPDX-License-Identifier: GPL-3.0-or-later
// LinuxCNC's interpreter as a second opinion on the emitted text: it takes every block, and the tip
// goes where the proof's own parser says.
#include "cam/millproof/program_path.h"
#include "decomp/base/file.h"
#include "tests/support/mill_proofs.h"
#include "tests/support/run_program.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace {

constexpr const char* kInterpreter = "/usr/bin/rs274";
constexpr double kSameMm = 1e-4;

/// Where each canonical motion of rs274 ends.
std::vector<Eigen::Vector3d> canonical_ends(const std::string& text) {
    std::vector<Eigen::Vector3d> out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const bool straight = line.find("STRAIGHT_") != std::string::npos;
        const std::size_t open = line.find('(');
        if (open == std::string::npos ||
            (!straight && line.find("ARC_FEED") == std::string::npos)) {
            continue;
        }
        std::vector<double> v;
        std::istringstream words(line.substr(open + 1));
        for (std::string word; std::getline(words, word, ',');) {
            v.push_back(std::strtod(word.c_str(), nullptr));
        }
        out.emplace_back(v.at(0), v.at(1), straight ? v.at(2) : v.at(5));
    }
    return out;
}

/// Where each of our blocks ends.
std::vector<Eigen::Vector3d> own_ends(const std::string& text, const std::string& dialect) {
    const auto part = tests::pocket_part();
    const auto path = cam::millproof::read_program(text, tests::pocket_job(part, dialect));
    std::vector<Eigen::Vector3d> out;
    for (std::size_t i = 0; i < path.steps.size(); ++i) {
        if (i + 1 == path.steps.size() || path.steps[i + 1].line != path.steps[i].line) {
            out.push_back(path.steps[i].to);
        }
    }
    return out;
}

TEST(Rs274, TakesEveryBlockAndGoesWhereTheProofsParserGoes) {
    if (!std::filesystem::exists(kInterpreter)) {
        GTEST_SKIP() << "rs274 is not installed: apt install linuxcnc-uspace";
    }
    tests::ByHand hand(tests::plate_stock());
    hand.take(1).rapid(11, 11, 5).cut(11, 11, -1.2345, 200).cut(29, 11.1111, -2);
    hand.arc({29, 18.8889, -2.5}, {29, 15}, false).arc({29, 18.8889, -3}, {25, 15}, true);
    hand.rapid(20, 15, 5);
    for (const std::string dialect :
         {"linuxcnc", "grblhal", "fluidnc", "grbl", "mach", "carvera", "roland-nc"}) {
        for (const auto& program : {hand.done(), tests::pocket_program()}) {
            const std::string text = tests::text_of(program, dialect);
            const tests::TempDir folder;
            const std::string file = folder / "program.ngc";
            const std::string table = folder / "tool.tbl";
            ASSERT_TRUE(decomp::write_file(file, text));
            // The interpreter alone reads its table in inches.
            ASSERT_TRUE(decomp::write_file(table, "T1 P1 Z0 D0.23622047 ;6 mm flat\n"));
            const auto run = tests::run_program({kInterpreter, "-g", "-t", table, file});
            ASSERT_EQ(run.exit_code, 0) << dialect << run.out << run.err;
            const auto theirs = canonical_ends(run.out);
            const auto ours = own_ends(text, dialect);
            ASSERT_GT(ours.size(), 5U);
            ASSERT_GE(theirs.size(), ours.size()) << dialect;
            // What comes before the place is known is theirs alone.
            const std::size_t more = theirs.size() - ours.size();
            EXPECT_LE(more, 2U);
            for (std::size_t i = 0; i < ours.size(); ++i) {
                EXPECT_LE((ours[i] - theirs[i + more]).cwiseAbs().maxCoeff(), kSameMm)
                    << dialect << " motion " << i << "\n"
                    << text;
            }
        }
    }
}

}  // namespace
