// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary bytes as lines of a controller, read alone: many more of them than whole conversations.
#include "cam/protocol/grbl_reply.h"
#include "cam/protocol/marlin_reply.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view bytes(reinterpret_cast<const char*>(data), size);
    while (!bytes.empty()) {
        const std::size_t end = std::min(bytes.find('\n'), bytes.size());
        const std::string_view line = bytes.substr(0, end);
        const auto marlin = cam::protocol::read_marlin_reply(line);
        const auto grbl = cam::protocol::read_grbl_reply(line);
        for (const auto& heater : marlin.heaters) {
            if (!(std::abs(heater.celsius) < 1e8) || !(std::abs(heater.target_celsius) < 1e8)) {
                __builtin_trap();
            }
        }
        if (marlin.heaters.size() > line.size() || grbl.axes > 6 || grbl.count > 6) {
            __builtin_trap();
        }
        (void)cam::protocol::firmware_field(line, "FIRMWARE_NAME");
        bytes.remove_prefix(std::min(end + 1, bytes.size()));
    }
    return 0;
}
