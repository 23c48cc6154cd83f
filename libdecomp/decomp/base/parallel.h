// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"

#include <cstddef>
#include <functional>

namespace decomp {

/// Calls body(0) … body(count - 1) on at most run.jobs threads. Each call writes to its own slot,
/// so the result does not depend on the number of threads. Stops early, without an error, when the
/// run is cancelled.
void for_each_index(const Run& run, std::size_t count,
                    const std::function<void(std::size_t)>& body);

}  // namespace decomp
