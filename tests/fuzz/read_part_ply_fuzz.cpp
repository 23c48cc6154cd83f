// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/part_ply.h"

#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto part =
        decomp::io::parse_part_ply({reinterpret_cast<const char*>(data), size}, "a.ply");
    if (part && part->sources.size() != part->mesh.triangles.size()) {
        std::abort();
    }
    return 0;
}
