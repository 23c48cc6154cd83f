// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace decomp {

/// Decimal text with at most `decimals` digits after the point (0..9): rounded half away from zero
/// on the decimal grid, no trailing zeros, no exponent, no locale, never "-0". |value| must be
/// below 1e9.
[[nodiscard]] std::string decimal(double value, int decimals);

/// As decimal(), trailing zeros kept: "1.500".
[[nodiscard]] std::string fixed(double value, int decimals);

/// The shortest text that reads back as the same double.
[[nodiscard]] std::string shortest(double value);

}  // namespace decomp
