// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/fdm/plan_part.h"
#include "cam/fdm/plate_layers.h"
#include "cam/post/post_fdm.h"
#include "cam/profile/read_profile.h"
#include "cam/verify/verify.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tests {

/// The program of one part in the middle of the bed, proved.
inline cam::verify::Proof proof_of(const decomp::mesh::TriMesh& part,
                                   const std::vector<std::string>& settings = {},
                                   const std::vector<bool>& mating = {}) {
    const auto setup = cam::profile::read_fdm_setup(
        HEW_SOURCE_DIR "/machine_profiles/fdm/prusa-mk3s.toml", {}, settings);
    EXPECT_TRUE(setup) << (setup ? "" : setup.error().text());
    const auto stack = cam::fdm::plan_part(part, mating, *setup, {});
    EXPECT_TRUE(stack) << (stack ? "" : stack.error().text());
    const auto& chamber = setup->machine.chamber;
    const Eigen::Vector3d middle = (chamber.min_mm + chamber.max_mm) / 2;
    const auto plate = cam::fdm::merge_layers({{&*stack, middle.head<2>()}}, *setup);
    const auto program = cam::post::post_fdm(plate, *setup, {"part"}, {});
    EXPECT_TRUE(program) << (program ? "" : program.error().text());
    decomp::mesh::TriMesh placed = part;
    for (auto& p : placed.points) {
        p.head<2>() += middle.head<2>();
    }
    const auto proof =
        cam::verify::examine(program->text, {{"part", placed, mating}}, *setup, {}, {});
    EXPECT_TRUE(proof) << (proof ? "" : proof.error().text());
    return *proof;
}

}  // namespace tests
