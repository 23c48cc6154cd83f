// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

namespace decomp::part {

/// The name of the part that stands at an index of an assembly: "P01" for 0, "P100" for 99.
[[nodiscard]] inline std::string part_id(std::size_t index) {
    const std::string number = std::to_string(index + 1);
    return (number.size() < 2 ? "P0" : "P") + number;
}

}  // namespace decomp::part
