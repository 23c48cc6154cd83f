// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace decomp {

enum class Overwrite { Refuse, Allow };

/// The whole file. @error file.not_found, file.unreadable
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

/// Writes to a temporary neighbour, syncs and renames: under its final name the file is whole or
/// absent, whatever happens. @error file.exists (Overwrite::Refuse and something is there),
/// file.unwritable
[[nodiscard]] Status write_file(const std::filesystem::path& path, std::string_view bytes,
                                Overwrite overwrite = Overwrite::Refuse);

}  // namespace decomp
