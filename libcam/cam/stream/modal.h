// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/job_lines.h"
#include "cam/stream/words.h"

#include <array>
#include <limits>
#include <string>

namespace cam::stream {

using protocol::AxisValues;
using protocol::kMaxAxes;

/// Which meanings codes have.
enum class Flavour { Print, Mill };

inline constexpr std::size_t kExtruder = 3;  ///< place of E in a printer's positions
inline constexpr std::string_view kAxisLetters = "XYZABC";

/// Everything that earlier lines have set and later ones rely on.
struct ModalState {
    AxisValues position_mm = unknown();  ///< where the next move begins, work coordinates;
                                         ///< NaN: nothing has said so yet
    bool inches = false;
    bool absolute = true;
    int motion = -1;  ///< 0 1 2 3; 80: none; -1: nothing has said so yet
    double feed_mm_per_min = 0;

    // Printers
    bool absolute_e = true;
    double e_mm = 0;
    std::array<double, 4> nozzle_celsius{};
    double bed_celsius = 0;
    double chamber_celsius = 0;
    double fan_0_255 = 0;
    double speed_percent = 100;  ///< M220
    double flow_percent = 100;   ///< M221
    double acceleration = 0;     ///< M204 S or P; 0: the firmware's own
    int tool = 0;

    // Mills
    int plane = 17;
    double coordinate_system = 54;
    int feed_mode = 94;
    double path_mode = 0;  ///< 61, 61.1, 64; 0: the controller's own
    int spindle = 5;       ///< 3, 4 or 5
    double spindle_rpm = 0;
    bool mist = false;
    bool flood = false;
    double highest_rapid_mm = std::numeric_limits<double>::lowest();  ///< Z of all G0 so far
    bool ended = false;                                               ///< M2, M30

    [[nodiscard]] static AxisValues unknown();
};

/// One motion of a line, for bounds and times. Positions as in ModalState.
struct Motion {
    AxisValues from{};
    AxisValues to{};
    AxisValues low{};  ///< of the whole path, arcs included
    AxisValues high{};
    double length_mm = 0;
    bool rapid = false;
    bool machine_coordinates = false;  ///< G53
    bool happens = false;
};

/// Carries the state over one line. O(words).
/// @return its motion, if it has one
Motion apply(ModalState& state, const Words& words, Flavour flavour);

}  // namespace cam::stream
