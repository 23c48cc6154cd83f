// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fields.h"
#include "cam/profile/mill_machine.h"

#include <string>
#include <vector>

namespace cam::profile {

/// A tool as its file writes it.
struct ToolFile {
    tool::Tool tool;
    std::string shape;
    std::vector<double> lower_diameters_mm;  ///< of the holder's sections
    std::vector<double> upper_diameters_mm;
    std::vector<double> lengths_mm;
};

[[nodiscard]] std::vector<Field> fields_of(MillMachine& machine);
[[nodiscard]] std::vector<Field> fields_of(ToolFile& file);

[[nodiscard]] ToolFile file_of(const tool::Tool& tool);

/// The tool of a file whose values are in range. @error profile.inconsistent
[[nodiscard]] decomp::Result<tool::Tool> tool_of(const ToolFile& file, const std::string& where);

/// As inconsistencies() of a printer's set-up.
[[nodiscard]] std::vector<std::string> inconsistencies(const MillMachine& machine);

}  // namespace cam::profile
