// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/plan_part.h"

#include "cam/fdm/compensation.h"
#include "cam/fdm/layer_beads.h"
#include "cam/fdm/mating.h"
#include "cam/fdm/part_layer.h"
#include "cam/fdm/seams.h"
#include "cam/fdm/slice.h"
#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"
#include "decomp/base/parallel.h"
#include "decomp/mesh/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace cam::fdm {

namespace {

using polygon::Paths;
using Process = profile::FdmMachine::Process;

constexpr double kFullDensity = 0.995;
constexpr double kOnMatingMm = 0.06;  // a wall that much further from a mating face belongs to it
// How much of the work is done after each step, as measured on parts with and without supports.
constexpr double kSliced = 0.15;
constexpr double kWalled = 0.35;
constexpr double kSkinned = 0.55;
constexpr double kSupported = 0.75;

/// Heights of the layers of a part that reaches up to `height_mm`: those whose middle is below it.
std::vector<PartLayer> empty_layers(double height_mm, const Process& process) {
    std::vector<PartLayer> out;
    double bottom = 0;
    for (std::size_t i = 0;; ++i) {
        const double h = i == 0 ? process.first_layer_height_mm : process.layer_height_mm;
        if (bottom + h / 2 >= height_mm) {
            return out;
        }
        PartLayer& layer = out.emplace_back();
        // Counted, not summed up: no drift.
        layer.top_mm =
            process.first_layer_height_mm + static_cast<double>(i) * process.layer_height_mm;
        layer.bead = {i == 0 ? process.first_layer_line_width_mm : process.line_width_mm, h};
        bottom = layer.top_mm;
    }
}

/// The slice without islands that are too narrow everywhere to get a bead: nothing may rest on them
/// or keep away from them.
Paths printable(const Paths& slice) {
    Paths out;
    for (const polygon::Island& island : polygon::islands(slice)) {
        const Paths loops = island.loops();
        double around = 0;
        for (const auto& loop : loops) {
            around += polygon::perimeter_mm(loop);
        }
        const bool narrow = polygon::area_mm2(loops) < around * kLeastStripMm;
        if (!narrow || !polygon::opened(loops, kLeastStripMm / 2).empty()) {
            out.insert(out.end(), loops.begin(), loops.end());
        }
    }
    return out;
}

Compensation compensation_of(const Process& process) {
    Compensation out;
    out.outline_inset_mm = process.outline_inset_mm;
    out.hole_growth_mm = process.hole_growth_mm;
    out.mating_inset_mm = process.mating_gap_mm / 2;
    out.foot_inset_mm = process.elephant_foot_mm;
    out.least_width_mm = 2 * process.first_layer_line_width_mm + 2 * process.elephant_foot_mm;
    return out;
}

decomp::Status fill_slices(const decomp::mesh::TriMesh& mesh, const std::vector<bool>& mating,
                           const Process& process, std::vector<PartLayer>& layers,
                           const decomp::Run& run) {
    std::vector<std::int64_t> heights;
    heights.reserve(layers.size());
    for (const PartLayer& layer : layers) {
        heights.push_back(polygon::nanometres(layer.top_mm - layer.bead.height_mm / 2));
    }
    auto slices = slice(mesh, heights, run);
    if (!slices) {
        return decomp::fail(slices.error());
    }
    auto lines = mating_lines(mesh, mating, heights);
    const Compensation by = compensation_of(process);
    decomp::for_each_index(run, layers.size(), [&](std::size_t i) {
        layers[i].mating = std::move(lines[i]);
        (*slices)[i] = compensated((*slices)[i], layers[i].mating, by);
    });
    if (!slices->empty()) {
        slices->front() =
            foot_drawn_in(slices->front(), slices->size() > 1 ? (*slices)[1] : Paths{}, by);
    }
    decomp::for_each_index(run, layers.size(),
                           [&](std::size_t i) { layers[i].slice = printable((*slices)[i]); });
    return {};
}

/// Walls, and on them the seams: those look at the layer below.
void fill_walls(std::vector<PartLayer>& layers, const Process& process, const decomp::Run& run) {
    decomp::for_each_index(run, layers.size(), [&](std::size_t i) {
        PartLayer& layer = layers[i];
        layer.walls = make_walls(layer.slice, layer.bead, process.perimeters);
        if (!layer.walls.loops.empty()) {
            layer.outer_walls = closed_lines(layer.walls.loops.front());
        }
    });
    const double reach = process.line_width_mm / 2 + process.mating_gap_mm / 2 + kOnMatingMm;
    SeamPlanner seams(seam_place(process.seam), reach);
    for (PartLayer& layer : layers) {
        seams.place_seams(layer.outer_walls, layer.mating);
    }
}

std::vector<Paths> slices_of(const std::vector<PartLayer>& layers) {
    std::vector<Paths> out;
    out.reserve(layers.size());
    std::transform(layers.begin(), layers.end(), std::back_inserter(out),
                   [](const PartLayer& layer) { return layer.slice; });
    return out;
}

void fill_interiors(const std::vector<Paths>& slices, std::vector<PartLayer>& layers,
                    const Process& process, const decomp::Run& run) {
    std::vector<Paths> insides;
    insides.reserve(layers.size());
    for (const PartLayer& layer : layers) {
        insides.push_back(layer.walls.inside);
    }
    const double spacing = BeadSize{process.line_width_mm, process.layer_height_mm}.spacing_mm();
    const double cell = process.infill_density > 0 ? 2 * spacing / process.infill_density : 0;
    const SkinOptions options{process.top_layers, process.bottom_layers, spacing,
                              process.infill_density >= kFullDensity, cell};
    auto interiors = split_interiors(slices, insides, options, run);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        layers[i].interior = std::move(interiors[i]);
    }
}

/// What bridges of a layer carry: their air and the walls at its edges.
Paths carried_by_bridges(const PartLayer& layer, const Process& process) {
    constexpr double kSlackMm = 0.3;
    const double walls = process.perimeters * layer.bead.width_mm + kSlackMm;
    Paths out;
    for (const BridgeArea& bridge : layer.interior.bridges) {
        if (bridge.rests && bridge.span_mm <= process.longest_bridge_mm) {
            out = polygon::unite(out, polygon::offset(bridge.air, walls));
        }
    }
    return out;
}

void fill_supports(const std::vector<Paths>& slices, std::vector<PartLayer>& layers,
                   const Process& process, const decomp::Run& run) {
    std::vector<Paths> carried;
    carried.reserve(layers.size());
    for (const PartLayer& layer : layers) {
        carried.push_back(carried_by_bridges(layer, process));
    }
    const SupportOptions options{process.support_angle,
                                 process.layer_height_mm,
                                 process.line_width_mm,
                                 static_cast<int>(std::lround(process.support_gap_z_layers)),
                                 process.support_gap_xy_mm,
                                 process.support_spacing_mm,
                                 process.support_interface_layers};
    auto supports = find_supports(slices, carried, options, run);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        layers[i].support = std::move(supports[i]);
    }
}

}  // namespace

decomp::Result<path::LayerStack> plan_part(const decomp::mesh::TriMesh& part_on_bed,
                                           const profile::FdmSetup& setup, const decomp::Run& run) {
    return plan_part(part_on_bed, {}, setup, run);
}

decomp::Result<path::LayerStack> plan_part(const decomp::mesh::TriMesh& part_on_bed,
                                           const std::vector<bool>& mating,
                                           const profile::FdmSetup& setup, const decomp::Run& run) {
    const Process& process = setup.machine.process;
    const auto box = decomp::mesh::bounds(part_on_bed);
    std::vector<PartLayer> layers;
    if (!box.isEmpty()) {
        layers = empty_layers(box.max().z(), process);
    }
    const auto sliced = fill_slices(part_on_bed, mating, process, layers, run);
    if (!sliced) {
        return decomp::fail(sliced.error());
    }
    run.progress("slice", kSliced);
    fill_walls(layers, process, run);
    run.progress("slice", kWalled);
    const std::vector<Paths> slices = slices_of(layers);
    fill_interiors(slices, layers, process, run);
    run.progress("slice", kSkinned);
    fill_supports(slices, layers, process, run);
    run.progress("slice", kSupported);
    path::LayerStack stack;
    stack.layers.resize(layers.size());
    decomp::for_each_index(run, layers.size(), [&](std::size_t i) {
        path::Layer& out = stack.layers[i];
        out.z_mm = layers[i].top_mm;
        out.height_mm = layers[i].bead.height_mm;
        out.beads = make_beads(layers[i], i, i > 0 ? &layers[i - 1] : nullptr, setup.machine);
    });
    run.progress("slice", 1);
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    const bool any = std::any_of(stack.layers.begin(), stack.layers.end(),
                                 [](const path::Layer& layer) { return !layer.beads.empty(); });
    if (!any) {
        return decomp::fail("fdm.empty", "no layer of the part can be printed", {},
                            "check the part's size and the layer heights");
    }
    return stack;
}

}  // namespace cam::fdm
