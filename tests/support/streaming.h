// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/grbl.h"
#include "cam/protocol/marlin.h"
#include "cam/sim/grbl_board.h"
#include "cam/sim/log_replay.h"
#include "cam/sim/marlin_board.h"
#include "cam/sim/virtual_machine.h"
#include "cam/stream/session.h"
#include "decomp/base/file.h"
#include "tests/support/jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace tests {

/// What a board carried out, compared on the fly with what it should, so that a million lines need
/// no memory.
struct Executed {
    std::function<std::string(std::size_t)> wanted;
    std::atomic<std::size_t> count{0};    ///< in place
    std::atomic<std::size_t> changed{0};  ///< of these, other than sent
    std::atomic<std::size_t> added{0};    ///< that nobody sent
    std::string first_difference;
    bool last_differs = false;

    void take(std::string_view text) {
        const std::size_t index = count;
        if (!wanted || text == wanted(index)) {
            ++count;
            last_differs = false;
        } else if (last_differs && text == wanted(index - 1)) {
            // What came before belongs to no place.
            ++added;
            --changed;
            last_differs = false;
        } else {
            if (first_difference.empty()) {
                first_difference = std::to_string(index) + ": '" + std::string(text) +
                                   "' instead of '" + wanted(index) + "'";
            }
            ++count;
            ++changed;
            last_differs = true;
        }
    }
};

/// Links for virtual machines: no banner, and little patience.
inline cam::protocol::LinkOptions quick_link() {
    cam::protocol::LinkOptions options;
    options.expects_banner = false;
    options.silence = std::chrono::milliseconds(200);
    options.patience = std::chrono::seconds(20);
    options.poll = std::chrono::milliseconds(50);
    options.precheck = false;
    return options;
}

/// A session that opens the port of a virtual machine.
inline cam::stream::Session::Open opener(const cam::sim::VirtualMachine& machine) {
    return [&machine] { return cam::transport::open_channel(machine.port(), {}); };
}

}  // namespace tests
