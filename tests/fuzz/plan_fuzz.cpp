// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary bytes as a plan of cuts and as an edit; what is read is written, read again, and
// carried out on a box.
#include "decomp/plan/edit.h"
#include "decomp/plan/plan_file.h"
#include "decomp/plan/workpiece.h"
#include "tests/support/shapes.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace decomp::plan;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    (void)parse_edit(text);
    const auto plan = parse_plan(text, "fuzz.toml");
    if (!plan) {
        return 0;
    }
    const std::string written = plan_toml(*plan);
    const auto again = parse_plan(written, "again.toml");
    if (!again || plan_toml(*again) != written) {
        std::abort();
    }
    auto piece = Workpiece::of(tests::box({0, 0, 0}, {10, 10, 10}));
    constexpr std::size_t kMostSteps = 6;
    for (std::size_t i = 0; i < std::min(plan->steps.size(), kMostSteps); ++i) {
        if (!piece->carry_out(plan->steps[i])) {
            break;
        }
    }
    if (!piece->complex().volumes_sum_exactly()) {
        std::abort();
    }
    return 0;
}
