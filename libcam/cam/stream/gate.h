// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/protocol.h"
#include "cam/stream/modal.h"
#include "decomp/base/result.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

/// May this program run on this machine?
namespace cam::stream {

/// What the machine can take.
struct Limits {
    Flavour flavour = Flavour::Print;
    AxisValues low_mm = ModalState::unknown();  ///< machine coordinates; NaN: no limit known
    AxisValues high_mm = ModalState::unknown();
    int axes = 3;                    ///< that the machine has, of X Y Z A B C
    double max_feed_mm_per_min = 0;  ///< 0: not looked at
    double max_spindle_rpm = 0;
    double max_nozzle_celsius = 0;
    double max_bed_celsius = 0;
};

/// One thing that speaks against running the program.
struct Objection {
    std::string code;  ///< stable dotted word
    long line = 0;     ///< 1-based
    std::string text;
    long times = 1;  ///< lines with the same code; `line` is the first
};

/// Looks at bounds alone: where the program goes (arcs included, G53, work offsets), feeds,
/// spindle, temperatures, codes that the firmware of this kind may not know. One objection per
/// code, in the order of their first lines. O(length).
/// @param offsets_mm  of the work coordinate systems, "G54" …; those of a machine that is not yet
///                    connected are unknown: axes with an unknown offset are not compared
[[nodiscard]] std::vector<Objection> examine_bounds(
    std::string_view program, const Limits& limits,
    const std::map<std::string, AxisValues>& offsets_mm);

/// What the profile says of the machine that must be at the port.
struct WantedMachine {
    std::string firmware;  ///< its name must contain this; empty: anything
    std::string machine;
    int axes = 3;
    bool mill = false;
};

/// What speaks against this machine: another firmware or model, fewer axes, moving, not homed,
/// reports in inches. Empty: nothing.
[[nodiscard]] std::vector<Objection> examine_machine(const protocol::Identity& identity,
                                                     const WantedMachine& wanted);

/// What the operator has allowed, by the last words of codes: "identity", "not_homed", "bounds".
using Allowances = std::vector<std::string>;

/// Every word that can be allowed.
[[nodiscard]] const std::vector<std::string>& known_allowances();

/// Nothing, or the first objection that was not allowed, the others as its notes.
/// @error the codes of the objections
[[nodiscard]] decomp::Status judge(const std::vector<Objection>& objections,
                                   const Allowances& allowed);

}  // namespace cam::stream
