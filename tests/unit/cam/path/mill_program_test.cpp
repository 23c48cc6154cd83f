// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/path/mill_program.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace {

using cam::path::MillOperation;
using cam::path::operation_name;

TEST(MillProgram, EveryOperationHasAWordOfItsOwn) {
    std::set<std::string_view> words;
    const int last = static_cast<int>(MillOperation::Contour);
    for (int operation = 0; operation <= last; ++operation) {
        const std::string_view word = operation_name(static_cast<MillOperation>(operation));
        EXPECT_NE(word, "unknown") << operation;
        words.insert(word);
    }
    EXPECT_EQ(words.size(), static_cast<std::size_t>(last + 1));
}

}  // namespace
