// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/frame.h"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using decomp::BedFrame;
using decomp::ModelFrame;
using decomp::PartBedFrame;
using decomp::Pose;

Eigen::Isometry3d quarter_turn_about_z() {
    Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
    map.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
    return map;
}

TEST(Frame, ComposedPosesReadRightToLeft) {
    const Pose<PartBedFrame, ModelFrame> part_from_model(quarter_turn_about_z());
    Eigen::Isometry3d shift = Eigen::Isometry3d::Identity();
    shift.translation() = Eigen::Vector3d(10, 0, 0);
    const Pose<BedFrame, PartBedFrame> bed_from_part(shift);
    const Eigen::Vector3d p = (bed_from_part * part_from_model) * Eigen::Vector3d(1, 0, 0);
    EXPECT_TRUE(p.isApprox(Eigen::Vector3d(10, 1, 0)));
}

TEST(Frame, RowMajorNumbersReadBackAsTheSamePose) {
    const Pose<PartBedFrame, ModelFrame> pose(quarter_turn_about_z());
    const auto back = Pose<PartBedFrame, ModelFrame>::from_row_major(pose.row_major());
    EXPECT_TRUE(back.map().isApprox(pose.map()));
    EXPECT_EQ(pose.row_major()[4], pose.map().matrix()(1, 0));
}

}  // namespace
