// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace decomp {

void for_each_index(const Run& run, std::size_t count,
                    const std::function<void(std::size_t)>& body) {
    // TBB prints a warning when asked for more threads than there are.
    const int threads = std::min(run.jobs, tbb::info::default_concurrency());
    if (threads <= 1 || count <= 1) {
        for (std::size_t i = 0; i < count && !run.cancelled(); ++i) {
            body(i);
        }
        return;
    }
    tbb::task_arena arena(threads);
    arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
            if (!run.cancelled()) {
                body(i);
            }
        });
    });
}

}  // namespace decomp
