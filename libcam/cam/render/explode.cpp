// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/render.h"
#include "decomp/mesh/measure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cam::render {

namespace {

/// One channel of a colour of this hue (turns), saturation and value; `shift` is 5 for red, 3 for
/// green, 1 for blue.
struct HueColour {
    double hue = 0;
    double saturation = 0;
    double value = 1;

    [[nodiscard]] std::uint8_t channel(double shift) const {
        const double k = std::fmod(shift + hue * 6, 6.0);
        const double dip = std::max(0.0, std::min({k, 4 - k, 1.0}));
        return static_cast<std::uint8_t>(std::lround(255 * value * (1 - saturation * dip)));
    }
};

}  // namespace

Rgb part_colour(std::size_t index) {
    // Steps of the golden ratio never come close to an earlier hue soon; two shades tell near hues
    // apart.
    const double hue = std::fmod(0.58 + static_cast<double>(index) * (std::numbers::phi - 1), 1.0);
    const HueColour colour{hue, index % 2 == 0 ? 0.42 : 0.55, index % 3 == 0 ? 0.98 : 0.88};
    return {colour.channel(5), colour.channel(3), colour.channel(1)};
}

std::vector<Item> explode(const decomp::part::Assembly& assembly, double fraction) {
    Eigen::AlignedBox3d whole;
    for (const auto& part : assembly.parts) {
        whole.extend(decomp::mesh::bounds(part.mesh));
    }
    std::vector<Item> items;
    for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
        const auto& part = assembly.parts[i];
        Item item{&part.mesh, part_colour(i), Eigen::Vector3d::Zero(), {}};
        if (const auto box = decomp::mesh::bounds(part.mesh); !box.isEmpty()) {
            item.offset = fraction * (box.center() - whole.center());
        }
        item.highlighted_triangles.reserve(part.sources.size());
        for (const auto& source : part.sources) {
            item.highlighted_triangles.push_back(source.is_cut());
        }
        items.push_back(std::move(item));
    }
    return items;
}

}  // namespace cam::render
