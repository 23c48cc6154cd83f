// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/number.h"
#include "decomp/repair/repair.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace decomp::repair {

/// A mesh on its way through the chain, and what was done to it.
struct Work {
    mesh::TriMesh mesh;
    RepairReport report;
    bool senses_trusted = true;  ///< no single triangle had to be turned
    bool surface_moved = false;  ///< the surface may lie off the input's
    std::string
        wrap_reason;  ///< why nothing milder than a wrap will do; empty as long as something may
    const RepairOptions& options;
    const Run& run;

    void change(Status at_least, std::string words) {
        report.status = std::max(report.status, at_least);
        if (at_least == Status::Wrapped) {
            run.warn("repair: " + words);
        } else {
            run.info("repair: " + words);
        }
        report.changes.push_back(std::move(words));
    }

    /// For a step that gives up: `return work.needs_wrap("...")`.
    bool needs_wrap(std::string reason) {
        wrap_reason = std::move(reason);
        return false;
    }
};

/// "3 points", "1 point".
inline std::string counted(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Four digits that count, without exponent where that is readable.
inline std::string figure(double value) {
    constexpr double kSmall = 0.001;
    constexpr double kLarge = 1'000'000;
    const double magnitude = std::abs(value);
    if (magnitude >= kLarge || (magnitude > 0 && magnitude < kSmall)) {
        const double power = std::floor(std::log10(magnitude));
        return decimal(value / std::pow(10.0, power), 3) + "e" + decimal(power, 0);
    }
    return decimal(value, magnitude >= 100 ? 1 : 4);
}

inline std::string percent(double part, double whole) {
    return (whole != 0 && std::abs(100 * part / whole) < 1e6 ? decimal(100 * part / whole, 3)
                                                             : "?") +
           " %";
}

/// Makes a closed oriented manifold by index work, near merges, small holes and removal of loose
/// sheets. False when work.wrap_reason says why not.
[[nodiscard]] bool close_surface(Work& work);

/// Removes crossings: few within a shell are mended locally, shells that cross each other are
/// united. False when work.wrap_reason says why not. @error run.cancelled
[[nodiscard]] Result<bool> remove_crossings(Work& work);

/// Replaces the mesh by a wrap of `soup`. @error repair.not_a_solid, repair.wrap_needed,
/// repair.failed
[[nodiscard]] decomp::Status wrap_surface(Work& work, const mesh::TriMesh& soup);

}  // namespace decomp::repair
