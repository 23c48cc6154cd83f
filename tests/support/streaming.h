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

inline std::string move_line(std::size_t index) {
    return "G1X" + std::to_string(index % 200) + "." + std::to_string(index % 10) + "Y" +
           std::to_string(index * 7 % 180) + "E" + std::to_string(index % 1000) + "F3000";
}

inline std::string mill_line(std::size_t index) {
    return "G1X" + std::to_string(index % 100) + "." + std::to_string(index % 10) + "Y" +
           std::to_string(index * 7 % 90) + "F1500";
}

inline cam::protocol::JobLines job_of(std::size_t count, std::string (*line)(std::size_t)) {
    cam::protocol::JobLines job;
    for (std::size_t i = 0; i < count; ++i) {
        job.add(line(i), static_cast<long>(i + 1));
    }
    return job;
}

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
