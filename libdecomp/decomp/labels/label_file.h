// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/file.h"
#include "decomp/base/result.h"
#include "decomp/labels/labeling.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace decomp::labels {

/// Labels as polycube programs exchange them: one number 0 to 5 a line, for +X, -X, +Y, -Y, +Z, -Z,
/// in the order of the triangles.
[[nodiscard]] std::string label_text(const Labeling& labels);

/// Reads such a text; blank lines are passed over. `name` stands for the file in errors.
/// @error labels.syntax  a line is no number from 0 to 5; `where` names it
/// @error labels.count   there are not `triangles` labels
[[nodiscard]] Result<Labeling> parse_labels(std::string_view text, std::string_view name,
                                            std::size_t triangles);

/// @error file.not_found, file.unreadable, labels.syntax, labels.count
[[nodiscard]] Result<Labeling> read_labels(const std::filesystem::path& path,
                                           std::size_t triangles);

/// @error file.exists, file.unwritable
[[nodiscard]] Status write_labels(const std::filesystem::path& path, const Labeling& labels,
                                  Overwrite overwrite = Overwrite::Refuse);

}  // namespace decomp::labels
