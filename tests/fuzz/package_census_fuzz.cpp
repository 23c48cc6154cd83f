// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/package_census.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

/// Any bytes as a 3MF package: the zip directory, its entries, and the XML within.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    static_cast<void>(decomp::io::count_package(bytes, "input.3mf"));
    return 0;
}
