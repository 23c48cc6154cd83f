// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace decomp::detail {

[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

}  // namespace decomp::detail

/// A broken invariant is a bug, not an error: it stops the program, in release builds too.
#define DECOMP_ASSERT(condition)        \
    ((condition) ? static_cast<void>(0) \
                 : ::decomp::detail::assertion_failed(#condition, __FILE__, __LINE__))
