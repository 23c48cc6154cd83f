// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstring>
#include <string>

namespace decomp::io {

static_assert(std::endian::native == std::endian::little,
              "the binary writers copy native little-endian numbers");

/// Appends the bytes of a number, little-endian.
template <class T>
void append_raw(std::string& out, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    out.append(raw, sizeof(T));
}

}  // namespace decomp::io
