// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stop_token>

namespace tools {

/// From now on SIGINT, SIGTERM and SIGHUP ask the returned source to stop; a second one ends the
/// program at once with exit code 130. One thread of its own waits for them. Call once, before any
/// other thread starts.
[[nodiscard]] std::stop_source stop_on_signals();

}  // namespace tools
