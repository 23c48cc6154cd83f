// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/protocol.h"

namespace cam::protocol {

std::string_view phase_name(Phase phase) {
    switch (phase) {
        case Phase::Closed:
            return "closed";
        case Phase::Meeting:
            return "meeting";
        case Phase::Ready:
            return "ready";
        case Phase::Checking:
            return "checking";
        case Phase::Running:
            return "running";
        case Phase::Paused:
            return "paused";
        case Phase::Asking:
            return "asking";
        case Phase::Stopping:
            return "stopping";
        case Phase::Stopped:
            return "stopped";
        case Phase::Finished:
            return "finished";
        case Phase::Failed:
            return "failed";
    }
    return "";
}

bool is_over(Phase phase) {
    return phase == Phase::Finished || phase == Phase::Stopped || phase == Phase::Failed;
}

}  // namespace cam::protocol
