// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/nearest.h"

#include <gtest/gtest.h>

namespace {

TEST(Nearest, CountsEditsAndSwaps) {
    EXPECT_EQ(decomp::edit_distance("", "abc"), 3);
    EXPECT_EQ(decomp::edit_distance("kitten", "sitting"), 3);
    EXPECT_EQ(decomp::edit_distance("slcie", "slice"), 1);
    EXPECT_EQ(decomp::edit_distance("same", "same"), 0);
}

TEST(Nearest, FindsTheMisspeltWord) {
    const std::vector<std::string> verbs = {"make",      "machines", "inspect",
                                            "decompose", "slice",    "verify"};
    EXPECT_EQ(decomp::nearest_word("mkae", verbs), "make");
    EXPECT_EQ(decomp::nearest_word("machine", verbs), "machines");
    EXPECT_EQ(decomp::nearest_word("xyzzy", verbs), "");
    EXPECT_EQ(decomp::did_you_mean("decomposse", verbs), "did you mean 'decompose'?");
}

TEST(Nearest, TakesTheOnlyNameThatContainsTheWord) {
    EXPECT_EQ(decomp::nearest_word("creator", {"flashforge-creator-pro", "prusa-mk3s"}),
              "flashforge-creator-pro");
    EXPECT_EQ(decomp::nearest_word("a", {"pla", "abs"}), "");
}

TEST(Nearest, NeverReplacesAWordAsAWhole) { EXPECT_EQ(decomp::nearest_word("ab", {"xy"}), ""); }

}  // namespace
