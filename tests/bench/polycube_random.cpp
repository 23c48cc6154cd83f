// SPDX-License-Identifier: GPL-3.0-or-later
// Polycubes of random shapes: polycube_random [COUNT [FIRST_SEED]]. One line a shape, then a
// histogram of tiers.
#include "decomp/polycube/check.h"
#include "decomp/polycube/generate.h"
#include "decomp/repair/repair.h"
#include "tests/support/random_shapes.h"

#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace {

double cpu_seconds() {
    double sum = 0;
    for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(who, &usage);
        sum += static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
               1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    }
    return sum;
}

}  // namespace

int main(int argc, char** argv) {
    const std::uint64_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 200;
    const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 0;
    std::map<std::string, int> tiers;
    double slowest = 0;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        decomp::Run run;
        run.jobs = 2;
        const auto solid = decomp::repair::repair(tests::random_shape(seed), {}, run);
        if (!solid) {
            std::printf("%4lu no solid: %s\n", seed, solid.error().text().c_str());
            ++tiers["no solid"];
            continue;
        }
        const double before = cpu_seconds();
        const auto cube = decomp::polycube::generate(solid->mesh, {}, {}, run);
        const double spent = cpu_seconds() - before;
        slowest = std::max(slowest, spent);
        if (!cube) {
            std::printf("%4lu FAILED: %s\n", seed, cube.error().text().c_str());
            ++tiers["failed"];
            continue;
        }
        const auto report = decomp::polycube::check_pair(cube->pair, cube->labels);
        ++tiers[report.tier];
        std::printf("%4lu family %lu  %s  charts %2d  turning %d  flips %3zu  cells %2d  %.1f s\n",
                    seed, seed % 7, report.tier.c_str(), report.charts,
                    cube->figures.turning_points, report.flips, cube->figures.cells, spent);
        std::fflush(stdout);
    }
    for (const auto& [tier, number] : tiers) {
        std::printf("%s: %d\n", tier.c_str(), number);
    }
    std::printf("slowest: %.1f CPU-seconds\n", slowest);
    return tiers.count("failed") == 0 ? 0 : 1;
}
