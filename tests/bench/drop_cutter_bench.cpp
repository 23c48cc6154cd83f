// SPDX-License-Identifier: GPL-3.0-or-later
// Drop-cutter on 204 160 triangles: items_per_second is points per CPU-second of one thread.
#include "cam/cutter/drop_cutter.h"
#include "decomp/base/rng.h"
#include "tests/support/cutters.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace {

void drop(benchmark::State& state, const cam::tool::Tool& tool) {
    static const cam::cutter::Surface surface(tests::bumpy_ball());
    const cam::cutter::DropCutter cutter(surface, cam::tool::outline_of(tool));
    decomp::Rng rng(1);
    std::vector<Eigen::Vector2d> points(100000);
    for (Eigen::Vector2d& p : points) {
        p = {std::round(-560 + 1120 * rng.uniform()) / 20,
             std::round(-560 + 1120 * rng.uniform()) / 20};
    }
    for ([[maybe_unused]] auto _ : state) {
        double sum = 0;
        for (const Eigen::Vector2d& p : points) {
            sum += cutter.lowest_tip(p, -40);
        }
        benchmark::DoNotOptimize(sum);
        state.counters["mean_mm"] = sum / static_cast<double>(points.size());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

using cam::tool::Shape;

BENCHMARK_CAPTURE(drop, ball_6, tests::cutter(Shape::Ball, 6))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drop, ball_3, tests::cutter(Shape::Ball, 3))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drop, flat_6, tests::cutter(Shape::Flat, 6))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drop, flat_12, tests::cutter(Shape::Flat, 12))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drop, bull_6_r1, tests::one_of_each()[2])->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drop, tapered_ball_1, tests::one_of_each()[3])->Unit(benchmark::kMillisecond);

}  // namespace
