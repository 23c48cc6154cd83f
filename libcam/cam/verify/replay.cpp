// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/replay.h"

#include "cam/verify/gcode_reader.h"
#include "cam/verify/machine.h"

namespace cam::verify {

decomp::Result<Replayed> replay(std::string_view program, const profile::FdmSetup& setup,
                                const Options& options, const decomp::Run& run) {
    Machine machine(setup, options);
    GcodeReader reader(program);
    GcodeLine line;
    while (reader.next(line)) {
        if (line.kind == GcodeLine::Kind::Unreadable) {
            return decomp::fail("proof.unreadable", "this is no G-code",
                                "line " + std::to_string(reader.number()),
                                "give the program as text, before any conversion");
        }
        if ((reader.number() & 0x3FFF) == 0 && run.cancelled()) {
            return decomp::cancelled();
        }
        machine.execute(line, reader.number());
    }
    return machine.finish(reader.number());
}

}  // namespace cam::verify
