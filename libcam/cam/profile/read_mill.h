// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/mill_machine.h"
#include "cam/profile/read_profile.h"
#include "cam/tool/tool.h"
#include "decomp/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace cam::profile {

/// A mill and the tools at hand, read and cross-checked.
struct MillSetup {
    MillMachine machine;
    std::vector<tool::Tool> tools;
    MillDialect dialect;
    std::string hash;  ///< SHA-256 of all values
};

/// Reads a mill and its tools (or `tools`, when not empty), then applies `settings`
/// ("reach.cell_mm=0.2"). A name with a slash or ".toml" in it is a path.
/// @error as read_fdm_setup()
[[nodiscard]] decomp::Result<MillSetup> read_mill_setup(
    std::string_view machine, const std::vector<std::string>& tools = {},
    const std::vector<std::string>& settings = {});

/// Reads one tool of the library. @error as read_fdm_setup()
[[nodiscard]] decomp::Result<tool::Tool> read_tool(std::string_view name);

/// Reads what is milled; a name with a slash or ".toml" in it is a path; `settings` as
/// "milling.chip_load=0.01". @error as read_fdm_setup()
[[nodiscard]] decomp::Result<MillMaterial> read_mill_material(
    std::string_view name, const std::vector<std::string>& settings = {});

/// Reads what a controller reads. @error as read_fdm_setup()
[[nodiscard]] decomp::Result<MillDialect> read_mill_dialect(std::string_view name);

/// Every field of a mill, then those of its dialect and of its first tool.
[[nodiscard]] std::vector<FieldRow> describe(const MillSetup& setup);

/// describe() as text for people, all tools with it.
[[nodiscard]] std::string explain(const MillSetup& setup);

/// Names of all mills on the search path, sorted.
[[nodiscard]] std::vector<std::string> list_mills();

/// Names of all materials that can be milled and of all dialects of mills, sorted.
[[nodiscard]] std::vector<std::string> list_mill_materials();
[[nodiscard]] std::vector<std::string> list_mill_dialects();

/// Names of all tools on the search path, sorted.
[[nodiscard]] std::vector<std::string> list_tools();

}  // namespace cam::profile
