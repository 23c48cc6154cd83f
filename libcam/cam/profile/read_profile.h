// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"
#include "decomp/base/result.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace cam::profile {

/// Everything that one FDM job needs of its machine, read and cross-checked.
struct FdmSetup {
    FdmMachine machine;
    Material material;
    Dialect dialect;
    std::string hash;  ///< SHA-256 of the three canonical texts; changes when any value does
};

/// Where profiles are looked for, in order: ./machine_profiles, $XDG_CONFIG_HOME/hew/machine_profiles, the installed
/// share folder, the source tree. A NAME with a slash or ".toml" is a path.
[[nodiscard]] std::vector<std::filesystem::path> search_path();

/// Reads a machine, its dialect and its material (or `material`, when not empty), then applies `settings`
/// ("process.layer_height_mm=0.15"). Cost: a few file reads.
/// @error profile.not_found (with the nearest name), profile.syntax, profile.unknown_key (file:line:column, nearest
/// key), profile.out_of_range, profile.missing_key, profile.inconsistent. All faults of a file come in one error's notes.
[[nodiscard]] decomp::Result<FdmSetup> read_fdm_setup(std::string_view machine, std::string_view material = {},
                                                      const std::vector<std::string>& settings = {});

/// Names of all machines on the search path, sorted.
[[nodiscard]] std::vector<std::string> list_machines();

}  // namespace cam::profile
