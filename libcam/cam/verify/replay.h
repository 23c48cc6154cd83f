// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/read_profile.h"
#include "cam/verify/verify.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cam::verify {

/// What a bead is for, as the program's comments declare it.
enum class Role : std::uint8_t { Part, Support, Adhesion };

/// One straight extruding move.
struct Bead {
    float x0 = 0;
    float y0 = 0;
    float x1 = 0;
    float y1 = 0;
    float z = 0;
    float volume_mm3 = 0;
    std::int32_t line = 0;
    Role role = Role::Part;
    bool outer_wall = false;  ///< of the part's surface, or a stretch of wall over air
};

/// Something wrong that the replay saw; the layer is found later from z.
struct Sighting {
    std::string code;
    long line = 0;
    double z = -1;  ///< of the nozzle; negative when it belongs to no layer
    std::string text;
};

/// A move that changed the height of the nozzle.
struct Climb {
    float z = 0;
    std::int32_t line = 0;
};

/// Everything a program does, as far as it matters for the part.
struct Replayed {
    std::vector<Bead> beads;  ///< in the order of the program
    std::vector<Climb> climbs;
    std::vector<Sighting> sightings;
    std::vector<std::string> notes;
    long lines = 0;
    double filament_mm = 0;
    double extruded_mm3 = 0;
    double max_flow_mm3_per_s = 0;
    double blob_mm3 = 0;
    double prime_mm3 = 0;
    int moves_below_printed = 0;
    int moves_outside_chamber = 0;
};

/// Replays modal state, axes, retraction ledger and heaters, and keeps a height map of what is
/// printed. Serial, O(length).
/// @error proof.unreadable, run.cancelled
[[nodiscard]] decomp::Result<Replayed> replay(std::string_view program,
                                              const profile::FdmSetup& setup,
                                              const Options& options, const decomp::Run& run);

}  // namespace cam::verify
