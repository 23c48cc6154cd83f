// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary bytes as a program, proved against a small box, in the Marlin and in the Sailfish
// reading; and as the sidecar of a proof, of printing and of milling.
#include "cam/millproof/record.h"
#include "cam/verify/proof_json.h"
#include "tests/support/shapes.h"

#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view program(reinterpret_cast<const char*>(data), size);
    cam::profile::FdmSetup setup;
    setup.machine.chamber.min_mm = {-30, -30, 0};
    setup.machine.chamber.max_mm = {30, 30, 30};
    setup.material.name = "pla";
    const cam::verify::PlacedPart part{"P01", tests::box({-5, -5, 0}, {5, 5, 1})};
    for (const char* dialect : {"marlin", "sailfish"}) {
        setup.dialect.name = dialect;
        const auto proof = cam::verify::examine(program, {part}, setup, {}, {});
        if (proof) {
            const auto record = cam::verify::proof_record(program, {part}, setup, *proof);
            if (!cam::verify::read_proof_json(cam::verify::proof_json(record))) {
                __builtin_trap();
            }
        }
    }
    (void)cam::verify::read_proof_json(program);
    const auto milled = cam::millproof::read_proof_json(program);
    if (milled && !cam::millproof::is_mill_record(program)) {
        __builtin_trap();
    }
    return 0;
}
