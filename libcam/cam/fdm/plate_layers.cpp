// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/plate_layers.h"

#include "cam/fdm/bead_size.h"
#include "cam/polygon/boolean.h"
#include "cam/polygon/offset.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

namespace cam::fdm {

namespace {

using Eigen::Vector2d;
using path::Bead;
using path::Layer;

/// A part's share of one layer of the plate.
struct Share {
    std::size_t part = 0;
    const Layer* layer = nullptr;
};

Bead moved(Bead bead, const Vector2d& offset) {
    for (Vector2d& p : bead.points) {
        p += offset;
    }
    for (Vector2d& p : bead.approach.by) {
        p += offset;
    }
    return bead;
}

/// Shares by nearest neighbour from where the nozzle is.
void append_shares(const std::vector<PlacedStack>& parts, std::vector<Share> shares, Vector2d& at,
                   Layer& out) {
    while (!shares.empty()) {
        const auto distance = [&](const Share& share) {
            return (share.layer->beads.front().points.front() + parts[share.part].offset_mm - at)
                .squaredNorm();
        };
        const auto nearest = std::min_element(
            shares.begin(), shares.end(),
            [&](const Share& a, const Share& b) { return distance(a) < distance(b); });
        out.height_mm = std::max(out.height_mm, nearest->layer->height_mm);
        for (const Bead& bead : nearest->layer->beads) {
            out.beads.push_back(moved(bead, parts[nearest->part].offset_mm));
        }
        at = out.beads.back().points.back();
        shares.erase(nearest);
    }
}

/// Loops round everything on the first layer, outermost first.
std::vector<Bead> skirt(const Layer& first, const profile::FdmMachine::Process& process) {
    polygon::Paths lines;
    for (const Bead& bead : first.beads) {
        polygon::Path& line = lines.emplace_back();
        for (const Vector2d& p : bead.points) {
            line.push_back(polygon::from_mm(p));
        }
    }
    const polygon::Path hull = polygon::convex_hull(lines);
    std::vector<Bead> out;
    const BeadSize size{process.first_layer_line_width_mm, first.height_mm};
    for (int i = process.skirt_loops - 1; i >= 0; --i) {
        // The hull runs along bead centres: half a width to their edge, another half to the skirt's
        // own centre.
        const double distance = process.skirt_distance_mm + size.width_mm + i * size.spacing_mm();
        for (const polygon::Path& loop : polygon::offset({hull}, distance, polygon::Join::Round)) {
            Bead bead;
            bead.feature = path::Feature::Skirt;
            bead.width_mm = size.width_mm;
            bead.height_mm = size.height_mm;
            bead.speed = process.first_layer_speed;
            for (const polygon::Point& p : loop) {
                bead.points.push_back(polygon::to_mm(p));
            }
            bead.points.push_back(bead.points.front());
            out.push_back(std::move(bead));
        }
    }
    return out;
}

}  // namespace

path::LayerStack merge_layers(const std::vector<PlacedStack>& parts,
                              const profile::FdmSetup& setup) {
    const auto& process = setup.machine.process;
    std::map<std::int64_t, std::vector<Share>> by_height;  // nm, so that equal heights meet
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (const Layer& layer : parts[i].stack->layers) {
            if (!layer.beads.empty()) {
                by_height[polygon::nanometres(layer.z_mm)].push_back({i, &layer});
            }
        }
    }
    path::LayerStack out;
    Vector2d at(0, 0);
    for (auto& [height, shares] : by_height) {
        Layer& layer = out.layers.emplace_back();
        layer.z_mm = shares.front().layer->z_mm;
        append_shares(parts, std::move(shares), at, layer);
    }
    if (!out.layers.empty() && process.brim_width_mm <= 0 && process.skirt_loops > 0) {
        Layer& first = out.layers.front();
        auto beads = skirt(first, process);
        std::move(first.beads.begin(), first.beads.end(), std::back_inserter(beads));
        first.beads = std::move(beads);
    }
    return out;
}

}  // namespace cam::fdm
