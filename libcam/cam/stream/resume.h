// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/journal/journal.h"
#include "cam/stream/modal.h"
#include "cam/stream/prepare.h"
#include "decomp/base/result.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Where a job stood, and how it goes on.
namespace cam::stream {

/// What a journal says at the beginning of every attempt at its job.
struct JournalHead {
    std::string program;  ///< name of the file, without folder
    std::string program_sha256;
    std::string profile_sha256;  ///< empty: foreign
    std::string machine;
    std::string link;
    std::string protocol;
    long first_line = 1;                ///< of the program; later ones resume
    std::vector<std::string> preamble;  ///< that went ahead of it
    std::vector<std::string> allowed;   ///< overrides of the operator
    bool foreign = false;
    std::size_t entries = 0;  ///< of the wire job
};

[[nodiscard]] std::string begin_record(const JournalHead& head);

/// How far the last attempt was.
struct Standing {
    JournalHead head;
    std::size_t acked = 0;    ///< entries that the machine has answered for
    std::size_t sent = 0;     ///< entries that are known to have left
    std::size_t allowed = 0;  ///< entries that can have left at most
    bool ended = false;       ///< the attempt ended in an orderly way
    std::string ending;       ///< "finished", "stopped", "failed protocol.alarm"
    std::string last_event;
};

/// @error stream.no_journal (no whole beginning), stream.journal_schema
[[nodiscard]] decomp::Result<Standing> read_standing(const journal::Contents& contents);

/// The modes and the position where line `first_line` begins. O(length).
[[nodiscard]] ModalState replay(std::string_view program, Flavour flavour, long first_line);

/// Where to go on when the machine was reset.
struct ResumePlan {
    long first_line = 1;  ///< the first line that is sent again
    ModalState state;
    std::vector<std::string> preamble;  ///< brings a machine that is homed and idle into the state
    std::string text;                   ///< for people
};

/// Goes back from what was answered for by as many lines as the controller plans ahead: those may
/// not have been carried out. A line before which the position is unknown, or in the middle of
/// nothing but modes, moves it further back.
/// @param planned_lines  that the controller may have had in its planner
/// @error stream.nothing_to_resume, stream.position_unknown
[[nodiscard]] decomp::Result<ResumePlan> plan_resume(std::string_view program,
                                                     const WireOptions& options, long answered_line,
                                                     std::size_t planned_lines);

/// The first of the lines `first` to `last` whose path leads through `place` (work coordinates, at
/// a hundredth of a millimetre); arcs by their ends alone. Nothing: none does. O(length).
[[nodiscard]] std::optional<long> line_through(std::string_view program, Flavour flavour,
                                               long first, long last, const AxisValues& place);

/// The lines that bring a machine, homed and idle, into a state: units, heaters, tool, spindle,
/// coolant, then above the place, over it and down to it; modes last.
[[nodiscard]] std::vector<std::string> preamble_of(const ModalState& state,
                                                   const WireOptions& options);

}  // namespace cam::stream
