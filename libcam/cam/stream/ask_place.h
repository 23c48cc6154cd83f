// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/protocol.h"
#include "cam/stream/session.h"
#include "decomp/base/result.h"

#include <optional>

namespace cam::stream {

/// Asks a Grbl machine where it stands, in work coordinates: meets it, waits for 10 ms by its own
/// clock, reads its position and goes. Nothing moves. Nothing: it is locked or does not tell.
/// @error stream.machine_busy (it moves or is held: its place says nothing yet), transport.*
[[nodiscard]] decomp::Result<std::optional<protocol::AxisValues>> ask_place(
    Session::Open open, protocol::LinkOptions link);

}  // namespace cam::stream
