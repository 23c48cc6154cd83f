// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/plan/plan.h"

#include <string>
#include <string_view>
#include <vector>

namespace decomp::plan {

/// The text of plan.toml (docs/formats.md): fixed order of keys, numbers that read back as the same
/// doubles. Comments at its end say which region became which part.
/// @param parts  names of the regions that became P01, P02 …; may be empty
[[nodiscard]] std::string plan_toml(const Plan& plan, const std::vector<std::string>& parts = {});

/// Reads such a text. All faults are found in one pass: the first is the error, the others its
/// notes.
/// @param name  stands in error messages: NAME:LINE:COLUMN
/// @error plan.syntax, plan.schema, plan.unknown_key, plan.wrong_type, plan.out_of_range,
/// plan.missing_key
[[nodiscard]] Result<Plan> parse_plan(std::string_view text, const std::string& name);

}  // namespace decomp::plan
