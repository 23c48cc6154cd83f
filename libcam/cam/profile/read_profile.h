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
    std::string
        hash;  ///< SHA-256 of all values; changes when any value does, not when a comment does
};

/// Where profiles are looked for, in order: ./machine_profiles,
/// $XDG_CONFIG_HOME/hew/machine_profiles (~/.config when unset), ../share/hew/machine_profiles seen
/// from the program, the installed share folder, the source tree.
[[nodiscard]] std::vector<std::filesystem::path> search_path();

/// Reads a machine, its dialect and its material (or `material`, when not empty), then applies
/// `settings`
/// ("process.layer_height_mm=0.15", "material.fan_fraction=0.5"). A machine or material with a
/// slash or ".toml" in it is a path. Cost: a few file reads.
/// @error profile.not_found (with the nearest name), profile.syntax, profile.unknown_key
/// (file:line:column, nearest key), profile.out_of_range, profile.missing_key,
/// profile.inconsistent. All faults of a file come in one error's notes.
[[nodiscard]] decomp::Result<FdmSetup> read_fdm_setup(
    std::string_view machine, std::string_view material = {},
    const std::vector<std::string>& settings = {});

/// One line of `hew machines show` and of docs/profiles.md: a field, its value and what is known of
/// it.
struct FieldRow {
    std::string section;  ///< table of the file, e.g. "process"
    std::string key;      ///< ends in its unit, e.g. "layer_height_mm"
    std::string value;    ///< as TOML writes it
    std::string unit;     ///< empty: a pure number or a text
    std::string range;    ///< "0.05 .. 1"; empty: anything
    bool required = false;
    std::string doc;
};

/// Every field of a set-up in the order of the files: machine, then material, then dialect.
[[nodiscard]] std::vector<FieldRow> describe(const FdmSetup& setup);

/// describe() as text for people: sections, values, units, and what each field means.
[[nodiscard]] std::string explain(const FdmSetup& setup);

/// The whole of docs/profiles.md, from the same table that reads the files.
[[nodiscard]] std::string profile_reference_markdown();

/// Names of all machines on the search path, sorted.
[[nodiscard]] std::vector<std::string> list_machines();

}  // namespace cam::profile
