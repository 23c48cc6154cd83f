// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/orient/choose_build.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/pipeline/decompose.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

namespace tests {

inline cam::profile::FdmSetup printer(double x, double y, double z) {
    cam::profile::FdmSetup setup;
    setup.machine.chamber.min_mm = {-x / 2, -y / 2, 0};
    setup.machine.chamber.max_mm = {x / 2, y / 2, z};
    setup.machine.process.brim_width_mm = 3;
    return setup;
}

/// Decomposes and asserts what must hold for every result.
inline decomp::pipeline::Decomposition sound(const TriMesh& volume,
                                             const cam::profile::FdmSetup& setup, int jobs = 2) {
    decomp::Run run;
    run.jobs = jobs;
    const auto result = decomp::pipeline::decompose(volume, {}, cam::orient::fdm_judge(setup), run);
    EXPECT_TRUE(result.has_value()) << result.error().text();
    if (!result) {
        return {};
    }
    double sum = 0;
    const Eigen::Vector3d usable = cam::orient::usable_mm(setup.machine);
    EXPECT_EQ(result->poses.size(), result->assembly.parts.size());
    for (std::size_t i = 0; i < result->assembly.parts.size(); ++i) {
        const auto& part = result->assembly.parts[i];
        sum += decomp::mesh::volume_mm3(part.mesh);
        EXPECT_TRUE(decomp::mesh::check_topology(part.mesh).manifold()) << part.id;
        EXPECT_TRUE(result->verdicts[i].ok()) << part.id;
        const Eigen::Vector3d size =
            decomp::mesh::bounds(cam::orient::placed(part, result->poses[i])).sizes();
        EXPECT_TRUE((size.array() <= usable.array() + 1e-9).all())
            << part.id << ": " << size.transpose();
    }
    const double volume_mm3 = decomp::mesh::volume_mm3(volume);
    EXPECT_NEAR(sum, volume_mm3, 1e-9 * volume_mm3);
    return *result;
}

}  // namespace tests
