// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/plan_part.h"

#include "cam/fdm/bead_size.h"
#include "cam/fdm/infill.h"
#include "cam/fdm/order.h"
#include "cam/fdm/skins.h"
#include "cam/fdm/slice.h"
#include "cam/fdm/walls.h"
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

using decomp::Angle;
using decomp::Speed;
using path::Bead;
using path::Feature;
using polygon::Paths;
using Process = profile::FdmMachine::Process;

constexpr double kFullDensity = 0.995;
constexpr double kSolidLinkSpacings = 3;   // solid lines are linked over at most so many spacings
constexpr double kSparseLinkSpacings = 4;  // sparse lines likewise, of their own spacing
constexpr double kOutputToleranceMm = 0.004;

/// One layer on its way from slice to beads.
struct PartLayer {
    double top_mm = 0;
    BeadSize bead;
    Paths slice;
    Walls walls;
    Interior interior;
};

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

Speed speed_of(Feature feature, const Process& process) {
    switch (feature) {
        case Feature::OuterWall:
            return process.outer_wall_speed;
        case Feature::InnerWall:
            return process.inner_wall_speed;
        case Feature::SparseInfill:
            return process.infill_speed;
        case Feature::Bridge:
            return process.bridge_speed;
        case Feature::Support:
        case Feature::SupportInterface:
            return process.support_speed;
        default:
            return process.solid_speed;
    }
}

/// Makes the beads of one layer out of its areas.
class LayerBeads {
  public:
    LayerBeads(const PartLayer& layer, std::size_t index, const Process& process)
        : layer_(layer), index_(index), process_(process) {}

    std::vector<Bead> beads() {
        islands_ = polygon::islands(layer_.slice);
        for (const auto& island : islands_) {
            island_boxes_.push_back(polygon::bounds(island.outer));
        }
        by_island_.resize(islands_.size());
        add_walls();
        add_solid();
        add_bridges();
        add_sparse();
        return ordered(std::move(by_island_), Eigen::Vector2d(0, 0));
    }

  private:
    std::size_t island_of(const Eigen::Vector2d& p) const {
        const polygon::Point at = polygon::from_mm(p);
        for (std::size_t i = 0; i + 1 < islands_.size(); ++i) {
            if (polygon::touches(island_boxes_[i], {at, at}) &&
                polygon::contains(islands_[i].loops(), at)) {
                return i;
            }
        }
        return islands_.size() - 1;
    }

    Bead bead(Feature feature, Line points, const BeadSize& size) const {
        Bead out;
        out.feature = feature;
        out.points = std::move(points);
        out.width_mm = size.width_mm;
        out.height_mm = size.height_mm;
        out.speed = index_ == 0 ? process_.first_layer_speed : speed_of(feature, process_);
        return out;
    }

    void add_walls() {
        for (std::size_t depth = 0; depth < layer_.walls.loops.size(); ++depth) {
            const Feature feature = depth == 0 ? Feature::OuterWall : Feature::InnerWall;
            for (const auto& loop :
                 polygon::simplified(layer_.walls.loops[depth], kOutputToleranceMm)) {
                Line points;
                points.reserve(loop.size() + 1);
                for (const auto& p : loop) {
                    points.push_back(polygon::to_mm(p));
                }
                points.push_back(points.front());
                IslandBeads& island = by_island_[island_of(points.front())];
                (depth == 0 ? island.outer_walls : island.inner_walls)
                    .push_back(bead(feature, std::move(points), layer_.bead));
            }
        }
    }

    void add_fill(Feature feature, const Paths& area, const FillPattern& pattern) {
        // Line centres keep half a spacing from the area's edge. Walls leave a gap at the surface
        // by their round flanks; the fill makes up for it by going that much further.
        const double inset = (layer_.bead.spacing_mm() - layer_.bead.rounding_mm()) / 2;
        for (Line& line : fill_with_lines(polygon::offset(area, -inset), pattern)) {
            IslandBeads& island = by_island_[island_of(line.front())];
            island.fill.push_back(bead(feature, std::move(line), layer_.bead));
        }
    }

    Feature solid_feature(const Paths& area) const {
        const double half = polygon::area_mm2(area) / 2;
        const auto share = [&](const Paths& open) {
            return open.empty() ? 0 : polygon::area_mm2(polygon::intersect(area, open));
        };
        if (share(layer_.interior.open_to_top) > half) {
            return Feature::TopSkin;
        }
        return index_ == 0 || share(layer_.interior.open_to_bottom) > half ? Feature::BottomSkin
                                                                           : Feature::SolidInfill;
    }

    Angle turned(bool odd) const {
        return odd ? Angle::radians(process_.infill_angle.radians() + std::acos(0.0))
                   : process_.infill_angle;
    }

    void add_solid() {
        const double spacing = layer_.bead.spacing_mm();
        for (const auto& island : polygon::islands(layer_.interior.solid)) {
            const Paths area = island.loops();
            add_fill(solid_feature(area), area,
                     {spacing, turned(index_ % 2 != 0), kSolidLinkSpacings * spacing});
        }
    }

    void add_bridges() {
        const double spacing = layer_.bead.spacing_mm();
        for (const BridgeArea& bridge : layer_.interior.bridges) {
            add_fill(Feature::Bridge, bridge.area,
                     {spacing, bridge.direction, kSolidLinkSpacings * spacing});
        }
    }

    void add_sparse() {
        if (process_.infill_density <= 0 || layer_.interior.sparse.empty()) {
            return;
        }
        const double spacing = layer_.bead.spacing_mm() / process_.infill_density;
        add_fill(Feature::SparseInfill, layer_.interior.sparse,
                 {spacing, turned(index_ % 2 != 0), kSparseLinkSpacings * spacing});
    }

    const PartLayer& layer_;
    std::size_t index_;
    const Process& process_;
    std::vector<polygon::Island> islands_;
    std::vector<polygon::Box> island_boxes_;
    std::vector<IslandBeads> by_island_;
};

decomp::Status fill_slices(const decomp::mesh::TriMesh& mesh, std::vector<PartLayer>& layers,
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
    for (std::size_t i = 0; i < layers.size(); ++i) {
        layers[i].slice = std::move((*slices)[i]);
    }
    return {};
}

void fill_interiors(std::vector<PartLayer>& layers, const Process& process,
                    const decomp::Run& run) {
    std::vector<Paths> slices;
    std::vector<Paths> insides;
    for (const PartLayer& layer : layers) {
        slices.push_back(layer.slice);
        insides.push_back(layer.walls.inside);
    }
    const SkinOptions options{process.top_layers, process.bottom_layers,
                              BeadSize{process.line_width_mm, process.layer_height_mm}.spacing_mm(),
                              process.infill_density >= kFullDensity};
    auto interiors = split_interiors(slices, insides, options, run);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        layers[i].interior = std::move(interiors[i]);
    }
}

}  // namespace

decomp::Result<path::LayerStack> plan_part(const decomp::mesh::TriMesh& part_on_bed,
                                           const profile::FdmSetup& setup, const decomp::Run& run) {
    const Process& process = setup.machine.process;
    const auto box = decomp::mesh::bounds(part_on_bed);
    std::vector<PartLayer> layers;
    if (!box.isEmpty()) {
        layers = empty_layers(box.max().z(), process);
    }
    const auto sliced = fill_slices(part_on_bed, layers, run);
    if (!sliced) {
        return decomp::fail(sliced.error());
    }
    decomp::for_each_index(run, layers.size(), [&](std::size_t i) {
        layers[i].walls = make_walls(layers[i].slice, layers[i].bead, process.perimeters);
    });
    fill_interiors(layers, process, run);
    path::LayerStack stack;
    stack.layers.resize(layers.size());
    decomp::for_each_index(run, layers.size(), [&](std::size_t i) {
        path::Layer& out = stack.layers[i];
        out.z_mm = layers[i].top_mm;
        out.height_mm = layers[i].bead.height_mm;
        if (!layers[i].slice.empty()) {
            out.beads = LayerBeads(layers[i], i, process).beads();
        }
    });
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
