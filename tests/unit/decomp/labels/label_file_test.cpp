// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/label_file.h"

#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

namespace {

using decomp::labels::AxisLabel;
using decomp::labels::Labeling;
using decomp::labels::parse_labels;

const Labeling kAll{AxisLabel::PlusX,  AxisLabel::MinusX, AxisLabel::PlusY,
                    AxisLabel::MinusY, AxisLabel::PlusZ,  AxisLabel::MinusZ};

TEST(LabelFile, IsOneNumberALine) {
    EXPECT_EQ(decomp::labels::label_text(kAll), "0\n1\n2\n3\n4\n5\n");
    EXPECT_EQ(*parse_labels("0\n1\n2\n3\n4\n5\n", "a.txt", 6), kAll);
}

TEST(LabelFile, ForeignLineEndsBlanksAndALastLineWithoutEndAreRead) {
    EXPECT_EQ(*parse_labels("0\r\n 1 \r\n\r\n2\n3\n4\n5", "a.txt", 6), kAll);
}

TEST(LabelFile, AWrongWordIsNamedByItsLine) {
    for (const char* text : {"0\n6\n", "0\n-1\n", "0\nx\n", "0\n12\n"}) {
        const auto read = parse_labels(text, "a.txt", 2);
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().code, "labels.syntax");
        EXPECT_EQ(read.error().where, "a.txt:2");
    }
}

TEST(LabelFile, AWrongNumberOfLabelsIsRefused) {
    EXPECT_EQ(parse_labels("0\n1\n", "a.txt", 3).error().code, "labels.count");
    EXPECT_EQ(parse_labels("", "a.txt", 3).error().code, "labels.count");
}

TEST(LabelFile, WhatIsWrittenIsReadBackAndNotOverwritten) {
    const tests::TempDir dir;
    const auto path = dir.path() / "labels.txt";
    ASSERT_TRUE(decomp::labels::write_labels(path, kAll));
    EXPECT_EQ(*decomp::labels::read_labels(path, 6), kAll);
    EXPECT_EQ(decomp::labels::write_labels(path, kAll).error().code, "file.exists");
    EXPECT_EQ(decomp::labels::read_labels(dir.path() / "none.txt", 6).error().code,
              "file.not_found");
}

}  // namespace
