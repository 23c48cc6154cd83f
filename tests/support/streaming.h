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
    std::atomic<std::size_t> lost{0};     ///< of these, left out
    std::string first_difference;
    std::size_t strangers = 0;  ///< in a row, the last ones

    static constexpr std::size_t kFarthest = 8;  ///< lines to look ahead for what was left out

    void take(std::string_view text) {
        const std::size_t index = count;
        if (!wanted || text == wanted(index)) {
            ++count;
            strangers = 0;
            return;
        }
        if (first_difference.empty()) {
            first_difference = std::to_string(index) + ": '" + std::string(text) +
                               "' instead of '" + wanted(index) + "'";
        }
        for (std::size_t back = 1; back <= strangers; ++back) {
            if (text == wanted(index - back)) {
                // As many of those before belong to no place.
                added += back;
                changed -= back;
                count = index - back + 1;
                strangers = 0;
                return;
            }
        }
        for (std::size_t ahead = 1; ahead <= kFarthest; ++ahead) {
            if (text == wanted(index + ahead)) {
                lost += ahead;
                count = index + ahead + 1;
                strangers = 0;
                return;
            }
        }
        ++count;
        ++changed;
        ++strangers;
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
