// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/io/read_mesh.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/intersect.h"
#include "decomp/repair/repair.h"

#include <gtest/gtest.h>

#include <string>

namespace tests {

/// What must become of a file: a status and a volume, or the code of an error.
struct Expected {
    std::string verdict;  ///< "clean", "fixed", "united", "wrapped", or an error's code
    double volume_mm3 = 0;
    double tolerance = 0;  ///< relative
};

/// What a result must be, whatever the input was.
inline void expect_solid(const decomp::repair::Repaired& repaired) {
    EXPECT_TRUE(decomp::mesh::check_topology(repaired.mesh).manifold());
    EXPECT_TRUE(decomp::repair::self_intersections(repaired.mesh, 1).empty());
    EXPECT_GT(repaired.report.volume_after_mm3, 0);
    const bool silent = repaired.report.changes.empty();
    EXPECT_TRUE(!silent || repaired.report.status == decomp::repair::Status::Clean);
}

inline void expect_verdict(const decomp::Result<decomp::mesh::TriMesh>& read,
                           const Expected& expected) {
    if (!read) {
        EXPECT_EQ(read.error().code, expected.verdict) << read.error().text();
        return;
    }
    const auto repaired = decomp::repair::repair(*read, {}, decomp::Run{});
    if (!repaired) {
        EXPECT_EQ(repaired.error().code, expected.verdict) << repaired.error().text();
        return;
    }
    EXPECT_EQ(name_of(repaired->report.status), expected.verdict);
    EXPECT_NEAR(repaired->report.volume_after_mm3, expected.volume_mm3,
                expected.tolerance * expected.volume_mm3);
    expect_solid(*repaired);
}

}  // namespace tests
