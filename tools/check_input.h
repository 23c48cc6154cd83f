// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/lone_part.h"
#include "decomp/part/part.h"
#include "tools/verb.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tools {

/// What `hew check` was asked.
struct CheckRequest {
    cam::job::MeshRequest mesh;  ///< a mesh, or a job directory
    std::string process;         ///< fdm, mill3, mill4
    std::string machine;
    std::vector<std::string> tools;
    std::vector<std::string> settings;
    std::string part;            ///< of a job; empty: all
    int setups = 1;              ///< mill3
    std::optional<int> angles;   ///< mill4
    std::string axis = "auto";   ///< mill4: as parse_direction()
    std::filesystem::path out;   ///< directory of pictures and coloured meshes; empty: none
    std::filesystem::path drop;  ///< mill4: directory of the parts without what is never seen
    std::string view;            ///< empty: the process' own
    bool force = false;
};

/// The parts to be checked, and the shape that they make up.
struct CheckInput {
    std::vector<decomp::part::Part> parts;
    std::optional<decomp::mesh::TriMesh> whole;  ///< none for one part of a job
    bool cut = false;                            ///< parts of a job, not a lone mesh
};

/// @error those of job, io and repair
[[nodiscard]] decomp::Result<CheckInput> read_check_input(const CheckRequest& request,
                                                          decomp::Run& run);

}  // namespace tools
