// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/mill_program.h"
#include "cam/profile/read_mill.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "tools/verb.h"

#include <cstddef>
#include <string>

namespace tools {

/// A written program as its checker saw it.
struct ProvedMilling {
    std::string sidecar;  ///< text of PROGRAM.proof.json
    std::string stock;    ///< PLY of what remains, coloured by its deviation
    std::string picture;  ///< PNG of the same
    Json figures = Json::object();
    std::string text;  ///< for people
    bool passed = false;
};

/// Proves the program of one set-up of a plan against its own text.
/// @error those of millproof and render
[[nodiscard]] decomp::Result<ProvedMilling> prove_milling(
    const std::string& program, const cam::path::MillPlan& plan, std::size_t set_up,
    const decomp::mesh::TriMesh& part, const cam::profile::MillSetup& setup, decomp::Run& run);

}  // namespace tools
