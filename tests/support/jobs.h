// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/job_lines.h"

#include <string>

namespace tests {

inline std::string move_line(std::size_t index) {
    return "G1X" + std::to_string(index % 200) + "." + std::to_string(index % 10) + "Y" +
           std::to_string(index * 7 % 180) + "E" + std::to_string(index % 1000) + "F3000";
}

inline std::string mill_line(std::size_t index) {
    return "G1X" + std::to_string(index % 100) + "." + std::to_string(index % 10) + "Y" +
           std::to_string(index * 7 % 90) + "F1500";
}

inline cam::protocol::JobLines job_of(std::size_t count, std::string (*line)(std::size_t)) {
    cam::protocol::JobLines job;
    for (std::size_t i = 0; i < count; ++i) {
        job.add(line(i), static_cast<long>(i + 1));
    }
    return job;
}

}  // namespace tests
