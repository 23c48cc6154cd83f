// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace {

TEST(Parallel, EveryIndexIsVisitedOnceAtAnyNumberOfThreads) {
    for (const int jobs : {1, 2, 8}) {
        decomp::Run run;
        run.jobs = jobs;
        std::vector<int> visits(1000, 0);
        decomp::for_each_index(run, visits.size(), [&](std::size_t i) { ++visits[i]; });
        EXPECT_EQ(visits, std::vector<int>(1000, 1));
    }
}

TEST(Parallel, ACancelledRunVisitsNothing) {
    std::stop_source source;
    source.request_stop();
    decomp::Run run;
    run.stop = source.get_token();
    std::atomic<int> visits = 0;
    decomp::for_each_index(run, 100, [&](std::size_t) { ++visits; });
    EXPECT_EQ(visits, 0);
}

}  // namespace
