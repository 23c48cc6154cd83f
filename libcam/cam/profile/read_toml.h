// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fields.h"
#include "decomp/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace cam::profile {

/// Stores numbers in a field when there are as many as it holds and each lies in its range.
/// @return an empty text, or what is wrong
[[nodiscard]] std::string store_checked(Field& field, const std::vector<double>& values);

/// Reads the text of one profile into those fields that belong to such a file. `name` stands in
/// error messages. All faults are found in one pass: the first is the error, the others its notes.
/// @error profile.syntax, profile.schema, profile.unknown_key, profile.wrong_type,
/// profile.out_of_range, profile.missing_key
[[nodiscard]] decomp::Status read_toml(std::vector<Field>& fields, File file, std::string_view text,
                                       const std::string& name);

}  // namespace cam::profile
