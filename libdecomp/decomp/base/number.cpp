// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/number.h"

#include "decomp/base/assert.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace decomp {

std::string fixed(double value, int decimals) {
    DECOMP_ASSERT(decimals >= 0 && decimals <= 9 && std::isfinite(value) && std::abs(value) < 1e9);
    std::int64_t scale = 1;
    for (int i = 0; i < decimals; ++i) {
        scale *= 10;
    }
    const std::int64_t grid = std::llround(value * static_cast<double>(scale));
    const std::int64_t magnitude = grid < 0 ? -grid : grid;
    std::string out = grid < 0 ? "-" : "";
    out += std::to_string(magnitude / scale);
    if (decimals > 0) {
        std::string fraction = std::to_string(magnitude % scale);
        out += '.';
        out.append(static_cast<std::size_t>(decimals) - fraction.size(), '0');
        out += fraction;
    }
    return out;
}

std::string decimal(double value, int decimals) {
    std::string out = fixed(value, decimals);
    if (decimals > 0) {
        out.erase(out.find_last_not_of('0') + 1);
        if (out.back() == '.') {
            out.pop_back();
        }
    }
    return out;
}

std::string shortest(double value) {
    std::array<char, 32> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    DECOMP_ASSERT(error == std::errc{});
    return {buffer.data(), end};
}

}  // namespace decomp
