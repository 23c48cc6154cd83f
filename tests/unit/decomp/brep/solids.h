// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

/// Files that the kernel itself writes, of shapes whose measures are known.
namespace tests {

/// 100 x 60 x 20 mm with a hole of radius 8 through its middle, as STEP in this unit ("MM",
/// "INCH", "M") and schema ("AP203", "AP214IS", "AP242DIS").
std::string holed_block_step(const std::string& unit, const std::string& schema);

/// The same as CASCADE .brep.
std::string holed_block_brep();

/// 80 x 50 x 20 mm, all edges rounded by 4, four holes: cylinders, spheres, planes.
std::string rounded_plate_step();

/// A red block "base" of 10 x 10 x 10 and two instances of a blue "pin" (radius 2, length 8) at
/// (20, 0, 0) and (40, 0, 0), the second turned by 90 degrees about X.
std::string assembly_step();

std::string sheet_step();

std::string wire_step();

/// A block beside a sheet.
std::string mixed_step();

}  // namespace tests
