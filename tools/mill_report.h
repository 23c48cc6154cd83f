// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/mill_program.h"
#include "cam/profile/read_mill.h"
#include "tools/verb.h"

#include <string>
#include <vector>

namespace tools {

/// One program of a plan as it is written.
struct MillFile {
    std::string name;  ///< of the file, beside the others
    std::string text;
};

/// What is told of a plan besides its programs.
struct MillSheet {
    const cam::path::MillPlan* plan = nullptr;
    const cam::profile::MillSetup* setup = nullptr;
    std::string part_file;
    std::string material;
    std::vector<MillFile> programs;
    std::vector<std::string> pictures;  ///< files: what remains after each program
    std::vector<std::string> notes;     ///< of the feeds
};

/// Seconds of cutting and of rapids at full speed, accelerations and changes of tool left out.
[[nodiscard]] double moving_seconds(const cam::path::MillProgram& program,
                                    const cam::profile::MillMachine& machine);

/// setup.json, version 1, of docs/formats.md.
[[nodiscard]] Json setup_json(const MillSheet& sheet);

/// The sheet for the person at the machine: a page to be printed.
[[nodiscard]] std::string sheet_html(const MillSheet& sheet);

}  // namespace tools
