// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary bytes as a journal, and as a program whose lines are prepared and replayed.
#include "cam/stream/gate.h"
#include "cam/stream/resume.h"

#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const cam::journal::Contents contents = cam::journal::read_records(bytes);
    if (contents.whole_bytes + contents.torn_bytes != size) {
        __builtin_trap();
    }
    (void)cam::stream::read_standing(contents);
    cam::journal::Contents records;
    records.records.emplace_back(bytes);
    (void)cam::stream::read_standing(records);
    for (const auto flavour : {cam::stream::Flavour::Print, cam::stream::Flavour::Mill}) {
        cam::stream::WireOptions options;
        options.flavour = flavour;
        (void)cam::stream::prepare(bytes, options);
        (void)cam::stream::plan_resume(bytes, options, 5, 2);
        cam::stream::Limits limits;
        limits.flavour = flavour;
        (void)cam::stream::examine_bounds(bytes, limits, {});
    }
    return 0;
}
