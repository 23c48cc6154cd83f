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
[[nodiscard]] std::vector<Field> fields_of(MillDialect& dialect);
[[nodiscard]] std::vector<Field> fields_of(MillMaterial& material);

[[nodiscard]] ToolFile file_of(const tool::Tool& tool);

/// The tool of a file whose values are in range. @error profile.inconsistent
[[nodiscard]] decomp::Result<tool::Tool> tool_of(const ToolFile& file, const std::string& where);

/// As inconsistencies() of a printer's set-up.
[[nodiscard]] std::vector<std::string> inconsistencies(const MillMachine& machine);

/// The same of a dialect: its templates can be written and hold no word that it forbids.
[[nodiscard]] std::vector<std::string> inconsistencies(const MillDialect& dialect);

/// The same of a machine and the dialect of its controller.
[[nodiscard]] std::vector<std::string> inconsistencies(const MillMachine& machine,
                                                       const MillDialect& dialect);

/// The same of a material.
[[nodiscard]] std::vector<std::string> inconsistencies(const MillMaterial& material);

}  // namespace cam::profile
