// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fields.h"
#include "decomp/base/result.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Where the files of a set-up are found, and how they and `--set` fill its fields.
namespace cam::profile {

struct Found {
    std::filesystem::path path;
    std::string name;  ///< stem
};

/// A name with a slash or ".toml" in it.
[[nodiscard]] bool is_path(std::string_view name);

/// Stems of all profiles in one folder of the roots, sorted, each once.
[[nodiscard]] std::vector<std::string> names_in(const std::vector<std::filesystem::path>& roots,
                                                const char* folder);

/// The first file of that name in the roots. @error profile.not_found
[[nodiscard]] decomp::Result<Found> find_profile(const std::vector<std::filesystem::path>& roots,
                                                 const char* folder, std::string_view name);

/// Applies "section.key=value" to the fields.
/// @error profile.bad_setting, profile.wrong_type, profile.out_of_range, profile.unknown_key
[[nodiscard]] decomp::Status apply_settings(std::vector<Field>& fields,
                                            const std::vector<std::string>& settings);

/// read_toml() of a file. @error those of read_toml() and file.*
[[nodiscard]] decomp::Status read_into(std::vector<Field>& fields, File file,
                                       const std::filesystem::path& path);

}  // namespace cam::profile
