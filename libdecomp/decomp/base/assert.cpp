// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/assert.h"

#include <cstdio>
#include <cstdlib>

namespace decomp::detail {

void assertion_failed(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "hew: internal error: %s does not hold at %s:%d. Please report it.\n",
                 condition, file, line);
    std::abort();
}

}  // namespace decomp::detail
