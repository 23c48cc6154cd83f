// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/complex.h"
#include "decomp/cut/written.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/measure.h"
#include "tests/oracle/decomp/cut/cgal_clip.h"
#include "tests/support/shapes.h"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <map>
#include <string>
#include <utility>

namespace {

using decomp::cut::Complex;
using decomp::mesh::TriMesh;
using decomp::part::Plane;

/// Every triangle in four.
TriMesh refined(const TriMesh& mesh) {
    TriMesh out;
    out.points = mesh.points;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, is_new] =
            middles.emplace(std::minmax(a, b), static_cast<std::uint32_t>(out.points.size()));
        if (is_new) {
            out.points.push_back((mesh.points[a] + mesh.points[b]) / 2);
        }
        return entry->second;
    };
    for (const auto& t : mesh.triangles) {
        const std::uint32_t a = middle(t[0], t[1]);
        const std::uint32_t b = middle(t[1], t[2]);
        const std::uint32_t c = middle(t[2], t[0]);
        out.triangles.insert(out.triangles.end(),
                             {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    return out;
}

/// A bumpy ball of about 70k triangles, or Nefertiti when HEW_MODELS holds her; `detail` 1 refines
/// it once.
const TriMesh& model(std::int64_t detail) {
    static const TriMesh coarse = [] {
        if (const char* folder = std::getenv("HEW_MODELS")) {
            const auto mesh = decomp::io::read_mesh(
                std::string(folder) + "/real/od_nefertiti_lr.obj", {}, decomp::Run{});
            if (mesh) {
                return *mesh;
            }
        }
        TriMesh ball = tests::sphere(10, 264, 132);
        for (auto& p : ball.points) {
            p *= 1 + 0.05 * std::sin(p.x()) * std::sin(1.3 * p.y()) * std::sin(0.7 * p.z());
        }
        return ball;
    }();
    static const TriMesh fine = refined(coarse);
    return detail == 0 ? coarse : fine;
}

Plane through_centre(const TriMesh& mesh, const Eigen::Vector3d& normal) {
    return {normal, normal.dot(decomp::mesh::bounds(mesh).center())};
}

const Eigen::Vector3d kOblique(0.3, 1, 0.17);

void from_volume(benchmark::State& state) {
    const TriMesh& mesh = model(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(Complex::from_volume(mesh));
    }
    state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

/// Both sides, both caps.
void one_cut(benchmark::State& state) {
    const TriMesh& mesh = model(state.range(0));
    const auto whole = Complex::from_volume(mesh);
    const Plane plane = through_centre(mesh, kOblique);
    for (auto _ : state) {
        state.PauseTiming();
        Complex complex = *whole;
        state.ResumeTiming();
        benchmark::DoNotOptimize(complex.split(0, plane));
        state.PauseTiming();
        { const Complex gone = std::move(complex); }
        state.ResumeTiming();
    }
    state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

/// One side, by CGAL's Polygon_mesh_processing::clip with inexact constructions; the mesh is built
/// each time.
void one_clip_of_cgal(benchmark::State& state) {
    const TriMesh& mesh = model(state.range(0));
    const Plane plane = through_centre(mesh, kOblique);
    for (auto _ : state) {
        benchmark::DoNotOptimize(tests::clipped_volume(mesh, plane));
    }
    state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

/// Ten planes through one point, about 0.1 degrees apart, each through every region.
void ten_planes_nearly_equal(benchmark::State& state) {
    const TriMesh& mesh = model(state.range(0));
    const auto whole = Complex::from_volume(mesh);
    std::int32_t regions = 0;
    for (auto _ : state) {
        Complex complex = *whole;
        for (int i = 0; i < 10; ++i) {
            const Plane plane = through_centre(mesh, {0.3 + 0.001 * i, 1, 0.17 - 0.002 * i});
            const std::int32_t count = complex.region_count();
            for (std::int32_t region = 0; region < count; ++region) {
                benchmark::DoNotOptimize(complex.split(region, plane));
            }
        }
        regions = complex.region_count();
    }
    state.counters["regions"] = regions;
}

void assemble_two_parts(benchmark::State& state) {
    const TriMesh& mesh = model(state.range(0));
    auto complex = Complex::from_volume(mesh);
    const Plane plane = complex->nudged_off_vertices(0, through_centre(mesh, kOblique),
                                                     3e-5 * decomp::mesh::diagonal_mm(mesh));
    benchmark::DoNotOptimize(complex->split(0, plane));
    std::vector<std::int32_t> order;
    for (std::int32_t region = 0; region < complex->region_count(); ++region) {
        order.push_back(region);
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(complex->assemble(order, decomp::Run{}));
    }
}

void check_one_part(benchmark::State& state) {
    const TriMesh& mesh = model(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(decomp::cut::check_written(mesh));
    }
}

}  // namespace

BENCHMARK(from_volume)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(one_cut)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(one_clip_of_cgal)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(ten_planes_nearly_equal)->Arg(0)->Unit(benchmark::kMillisecond);
BENCHMARK(assemble_two_parts)->Arg(0)->Unit(benchmark::kMillisecond);
BENCHMARK(check_one_part)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
