// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/brep/read_brep.h"
#include "decomp/solid/solid.h"

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace decomp::brep {

/// Application protocols of ISO 10303. AP203 has no colours.
enum class StepSchema { Ap203, Ap214, Ap242 };

/// "ap203", "ap214" or "ap242". @error brep.schema
[[nodiscard]] Result<StepSchema> parse_schema(std::string_view text);

/// One product of a STEP file.
struct StepBody {
    std::string name;  ///< unique in the file
    solid::Solid solid;
    std::optional<std::array<double, 3>> colour{};  ///< sRGB, 0 to 1
    Eigen::Isometry3d placed_from_solid = Eigen::Isometry3d::Identity();
    bool measured = true;  ///< fill in StepFile::figures
};

struct StepFile {
    std::string text;
    std::vector<BodyFigures> figures;  ///< what the kernel finds of each body, as it is written
};

/// One body as a product, several as an assembly of products under the name `title`; millimetres.
/// The header bears a fixed date and entities stand in an order of their own, so that equal bodies
/// give equal bytes. Loads the geometry kernel on first use.
/// @error brep.kernel, brep.not_written, run.cancelled
/// Cost about 0.3 ms a face.
[[nodiscard]] Result<StepFile> write_step(const std::vector<StepBody>& bodies,
                                          const std::string& title, StepSchema schema,
                                          const Run& run);

}  // namespace decomp::brep
