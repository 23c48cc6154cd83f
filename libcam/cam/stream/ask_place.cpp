// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/stream/ask_place.h"

#include "cam/protocol/grbl.h"

#include <cmath>

namespace cam::stream {

decomp::Result<std::optional<protocol::AxisValues>> ask_place(Session::Open open,
                                                              protocol::LinkOptions link) {
    protocol::JobLines job;
    job.add("G4P0.01", 0, protocol::LineKind::Drain);
    link.precheck = link.offers_homing = false;
    protocol::Grbl conversation(job, link);
    Session::Options options;
    options.reconnects = false;
    bool busy = false;
    bool homed = true;
    options.admit = [&](const protocol::Identity& identity) -> decomp::Status {
        busy = identity.busy;
        homed = identity.homed;
        return busy || !homed ? decomp::fail("stream.machine_busy", "it is not at rest")
                              : decomp::Status{};
    };
    Session session(conversation, std::move(open), options);
    const auto outcome = session.run();
    if (!outcome) {
        return decomp::fail(outcome.error());
    }
    if (busy) {
        return decomp::fail("stream.machine_busy",
                            "the machine moves or is held (" + conversation.status().state +
                                "), and where it comes to rest tells where "
                                "the job goes on",
                            {}, "wait until it stands, or reset and home it: --after-reset");
    }
    const protocol::Status& status = conversation.status();
    if (outcome->phase != protocol::Phase::Finished || status.axes < 3) {
        return std::optional<protocol::AxisValues>{};
    }
    protocol::AxisValues place = status.position_mm;
    for (auto axis = static_cast<std::size_t>(status.axes); axis < place.size(); ++axis) {
        place.at(axis) = std::nan("");
    }
    return std::optional(place);
}

}  // namespace cam::stream
