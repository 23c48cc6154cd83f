// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/axis_search.h"
#include "cam/check/mill4.h"
#include "cam/check/reach.h"
#include "cam/profile/read_mill.h"
#include "cam/visibility/sight.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/measure.h"
#include "tests/support/part_shapes.h"
#include "tests/support/subdivide.h"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace {

using decomp::part::Part;

/// A model of HEW_MODELS, its longest side scaled to `longest_mm`; a torus of as many triangles
/// without.
Part model(const char* file, int subdivisions, std::optional<double> longest_mm) {
    const char* models = std::getenv("HEW_MODELS");
    decomp::mesh::TriMesh mesh;
    if (models == nullptr) {
        mesh = tests::torus(30, 12, 340, 206);
    } else {
        mesh = decomp::io::read_mesh(std::filesystem::path(models) / file, {}, {}).value();
    }
    for (int i = 0; i < subdivisions; ++i) {
        mesh = tests::midpoint_subdivided(mesh);
    }
    if (longest_mm) {
        const double scale = *longest_mm / decomp::mesh::bounds(mesh).sizes().maxCoeff();
        for (auto& point : mesh.points) {
            point *= scale;
        }
    }
    return tests::whole(mesh);
}

/// The 40 angles of the paper on Nefertiti with four times the triangles: facets, tree and rays.
void RotaryAxisGiven(benchmark::State& state) {
    const Part part = model("real/od_nefertiti_lr.obj", 1, std::nullopt);
    cam::check::Mill4Options options;
    options.axis = Eigen::Vector3d::UnitY();
    options.find_indices = false;
    double percent = 0;
    for (auto _ : state) {
        percent = cam::check::check_mill4(part, options, {}, {})->unseen.by_facets_percent;
    }
    state.counters["triangles"] = static_cast<double>(part.mesh.triangles.size());
    state.counters["unseen_percent"] = percent;
}

void RotaryAxisSearched(benchmark::State& state) {
    const Part part = model("real/od_nefertiti_lr.obj", 1, std::nullopt);
    cam::check::Mill4Options options;
    options.find_indices = false;
    double percent = 0;
    for (auto _ : state) {
        percent = cam::check::check_mill4(part, options, {}, {})->unseen.by_facets_percent;
    }
    state.counters["triangles"] = static_cast<double>(part.mesh.triangles.size());
    state.counters["unseen_percent"] = percent;
}

void RotaryIndices(benchmark::State& state) {
    const Part part = model("real/od_nefertiti_lr.obj", 1, std::nullopt);
    cam::check::Mill4Options options;
    options.axis = Eigen::Vector3d::UnitY();
    std::size_t count = 0;
    for (auto _ : state) {
        count = cam::check::check_mill4(part, options, {}, {})->indices.a_degrees.size();
    }
    state.counters["indices"] = static_cast<double>(count);
}

/// What one tool reaches from one direction, part of 60 mm, cells of 0.1 mm.
void ToolReach(benchmark::State& state, const char* file, const char* tool_name) {
    const Part part = model(file, 0, 60.0);
    const auto tool = cam::profile::read_tool(tool_name).value();
    const auto facets = decomp::mesh::measure_facets(part.mesh);
    const auto directions = cam::check::tool_directions(Eigen::Vector3d::UnitX(), 8, 1);
    std::size_t next = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(cam::check::tool_reach(
            part.mesh, facets, directions[next++ % directions.size()], tool, {}));
    }
    state.counters["triangles"] = static_cast<double>(part.mesh.triangles.size());
}

BENCHMARK(RotaryAxisGiven)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(RotaryAxisSearched)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(RotaryIndices)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ToolReach, bu_ball_3, "paper/hfd_BU.obj", "ball-3")
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ToolReach, bu_ball_6, "paper/hfd_BU.obj", "ball-6")
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ToolReach, bu_flat_6, "paper/hfd_BU.obj", "flat-6")
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ToolReach, max_planck_ball_6, "paper/hfd_maxplank.obj", "ball-6")
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
