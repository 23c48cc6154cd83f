// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/plan/edit.h"

#include <gtest/gtest.h>

namespace {

using decomp::plan::Edit;
using decomp::plan::parse_edit;

TEST(Edit, ASplitNamesAPartAnAxisAndAShare) {
    const auto edit = parse_edit("split P03:z=0.25");
    ASSERT_TRUE(edit.has_value());
    EXPECT_EQ(edit->kind, Edit::Kind::Split);
    EXPECT_EQ(edit->parts, std::vector<std::string>{"P03"});
    EXPECT_EQ(edit->axis, 2);
    EXPECT_EQ(edit->share, 0.25);
    EXPECT_EQ(edit->text, "split P03:z=0.25");
}

TEST(Edit, AMergeNamesTwoPartsOrMore) {
    const auto edit = parse_edit("merge P02+P05+P03.1");
    ASSERT_TRUE(edit.has_value());
    EXPECT_EQ(edit->kind, Edit::Kind::Merge);
    EXPECT_EQ(edit->parts, (std::vector<std::string>{"P02", "P05", "P03.1"}));
}

TEST(Edit, TheNormalOfAPlaneMayHaveAnyLengthAndItsDistanceStaysMillimetres) {
    const auto edit = parse_edit("plane 0 3  4 -12.5");
    ASSERT_TRUE(edit.has_value());
    EXPECT_EQ(edit->kind, Edit::Kind::Plane);
    EXPECT_NEAR((edit->plane.normal - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 0, 1e-15);
    EXPECT_EQ(edit->plane.offset_mm, -12.5);
}

TEST(Edit, WhatCannotBeMeantIsRefusedWithAnExample) {
    for (const char* text : {"split",
                             "split P03",
                             "split P03:z",
                             "split P03:w=0.5",
                             "split P03:z=0",
                             "split P03:z=1",
                             "split P03:z=nan",
                             "split P03:z=half",
                             "split :z=0.5",
                             "split P03:zz=0.5",
                             "split P03:z=0.5mm",
                             "merge P02",
                             "merge P02+",
                             "merge P02+P02",
                             "merge +P02",
                             "plane 0 0 1",
                             "plane 0 0 0 5",
                             "plane 0 0 1 5 6",
                             "plane 0 0 up 5",
                             "plane 0 0 1 inf",
                             "cut P03",
                             ""}) {
        const auto edit = parse_edit(text);
        ASSERT_FALSE(edit.has_value()) << text;
        EXPECT_EQ(edit.error().code, "plan.edit") << text;
        EXPECT_FALSE(edit.error().hint.empty()) << text;
    }
}

}  // namespace
