// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/hew.h"

#include <regex>
#include <set>

namespace {

using tests::hew;

std::set<std::string> options_in(const std::string& text) {
    const std::regex option("--[a-z][a-z-]*");
    std::set<std::string> out;
    for (std::sregex_iterator it(text.begin(), text.end(), option), end; it != end; ++it) {
        out.insert(it->str());
    }
    return out;
}

const std::vector<std::string> kVerbs{"make",     "decompose", "slice", "verify", "inspect",
                                      "render",   "machines",  "demo",  "check",  "export",
                                      "polycube", "stream",    "ports", "sim",    "mill"};

TEST(Help, EveryVerbHasHelpWithExamples) {
    const std::string overview = hew({"--help"}).out;
    for (const std::string& verb : kVerbs) {
        EXPECT_NE(overview.find(verb), std::string::npos) << verb;
        const auto run = hew({verb, "--help"});
        EXPECT_EQ(run.exit_code, 0);
        EXPECT_NE(run.out.find("Examples:\n  hew " + verb), std::string::npos) << run.out;
    }
}

TEST(Help, ThePageOfTheCommandLineNamesExactlyTheOptionsThatExist) {
    std::set<std::string> existing = options_in(hew({"--help"}).out);
    for (const std::string& verb : kVerbs) {
        existing.merge(options_in(hew({verb, "--help"}).out));
    }
    EXPECT_EQ(existing, options_in(*decomp::read_file(HEW_SOURCE_DIR "/docs/cli.md")));
}

}  // namespace
