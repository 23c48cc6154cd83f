// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/check_pictures.h"

#include "cam/check/height_map.h"
#include "decomp/base/file.h"
#include "decomp/base/number.h"
#include "decomp/io/write_mesh.h"
#include "decomp/mesh/measure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <numbers>

namespace tools {

namespace render = cam::render;
using cam::check::Hanging;
using decomp::Status;
using render::Rgb;

namespace {

constexpr Rgb kFree{196, 200, 206};
constexpr Rgb kBase{92, 134, 196};
constexpr Rgb kBad{214, 64, 52};
constexpr Rgb kBridge{240, 176, 64};
constexpr Rgb kIsland{176, 66, 178};
constexpr Rgb kReached{196, 200, 206};
constexpr Rgb kEnd{150, 160, 178};
constexpr Rgb kThin{240, 176, 64};
constexpr Rgb kInk{30, 30, 30};
constexpr int kWidthPx = 1000;
constexpr int kHeightPx = 900;

std::string capitals(std::string text) {
    for (char& c : text) {
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return text;
}

Rgb colour_of(Hanging kind) {
    switch (kind) {
        case Hanging::Free:
            return kFree;
        case Hanging::Plate:
            return kBase;
        case Hanging::Overhang:
            return kBad;
        case Hanging::Bridge:
            return kBridge;
        case Hanging::Island:
            return kIsland;
    }
    return kFree;
}

}  // namespace

Status draw(const CheckRequest& request, const ColouredPart& coloured, decomp::Run& run) {
    if (request.out.empty()) {
        return {};
    }
    const auto view = render::view_named(!request.view.empty()      ? request.view
                                         : request.process == "fdm" ? "under"
                                                                    : "iso");
    if (!view) {
        return decomp::fail(view.error());
    }
    const std::string name = coloured.part->id + coloured.suffix;
    const auto overwrite = request.force ? decomp::Overwrite::Allow : decomp::Overwrite::Refuse;
    std::vector<std::array<std::uint8_t, 3>> faces;
    faces.reserve(coloured.colours.size());
    for (const Rgb& colour : coloured.colours) {
        faces.push_back({colour.red, colour.green, colour.blue});
    }
    if (auto written =
            decomp::write_file(request.out / (name + ".ply"),
                               decomp::io::ply_bytes(coloured.part->mesh, faces), overwrite);
        !written) {
        return written;
    }
    const Eigen::Affine3d turn(coloured.turn);
    const auto mesh = decomp::mesh::transformed(coloured.part->mesh, turn);
    render::Item item;
    item.mesh = &mesh;
    item.triangle_colours = coloured.colours;
    render::ViewOptions options;
    options.view = *view;
    options.width_px = kWidthPx;
    options.height_px = kHeightPx;
    options.margin = 0.08;
    options.legend = coloured.legend;
    options.strokes = coloured.strokes;
    for (render::Stroke& stroke : options.strokes) {
        stroke.from = turn * stroke.from;
        stroke.to = turn * stroke.to;
    }
    const auto png = render::render_meshes_png({item}, options, run);
    if (!png) {
        return decomp::fail(png.error());
    }
    return decomp::write_file(request.out / (name + ".png"), *png, overwrite);
}

Status draw_printing(const CheckRequest& request, const decomp::part::Part& part,
                     const Eigen::Vector3d& down, const cam::check::FdmOptions& options,
                     decomp::Run& run) {
    if (request.out.empty()) {
        return {};
    }
    ColouredPart coloured;
    coloured.part = &part;
    for (const Hanging kind : cam::check::hanging_in(part.mesh, down, options)) {
        coloured.colours.push_back(colour_of(kind));
    }
    coloured.turn =
        Eigen::Quaterniond::FromTwoVectors(-down, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    coloured.legend = {
        {kBase, "PLATE"}, {kBad, "OVERHANG"}, {kBridge, "BRIDGE"}, {kIsland, "ISLAND"}};
    return draw(request, coloured, run);
}

Status draw_milling(const CheckRequest& request, const decomp::part::Part& part,
                    const cam::check::Mill3Check& check, const Eigen::Vector3d& direction,
                    decomp::Run& run) {
    if (request.out.empty()) {
        return {};
    }
    const auto& facets = check.facets;
    ColouredPart coloured;
    coloured.part = &part;
    for (std::size_t i = 0; i < facets.seen.size(); ++i) {
        const bool reached = facets.reached.empty() || facets.reached[i] != 0;
        coloured.colours.push_back(facets.base[i] != 0   ? kBase
                                   : facets.seen[i] == 0 ? kBad
                                   : reached             ? kReached
                                                         : kThin);
    }
    coloured.turn = cam::check::frame_looking_down(direction);
    coloured.legend = {{kBase, "BASE"}, {kReached, "REACHED"}, {kBad, "NOT SEEN"}};
    if (!check.tools.empty()) {
        coloured.legend.push_back({kThin, "NOT BY " + capitals(check.tools.front().tool)});
    }
    return draw(request, coloured, run);
}

Status draw_rotary(const CheckRequest& request, const decomp::part::Part& part,
                   const cam::check::Mill4Check& check, const cam::check::Mill4Options& options,
                   decomp::Run& run) {
    if (request.out.empty()) {
        return {};
    }
    const auto& facets = check.facets;
    ColouredPart coloured;
    coloured.part = &part;
    for (std::size_t i = 0; i < facets.seen.size(); ++i) {
        const bool reached = facets.reached.empty() || facets.reached[i] != 0;
        const Rgb seen =
            facets.index[i] < 0
                ? kReached
                : render::mixed(render::part_colour(static_cast<std::size_t>(facets.index[i])),
                                {255, 255, 255}, 0.35);
        coloured.colours.push_back(facets.end[i] != 0    ? kEnd
                                   : facets.seen[i] == 0 ? kBad
                                   : reached             ? seen
                                                         : kInk);
    }
    const auto& stock = check.stock;
    const double beyond = 0.15 * std::max(stock.length_mm, stock.radius_mm);
    const Eigen::Vector3d low = stock.low - beyond * stock.axis;
    const Eigen::Vector3d high = stock.low + (stock.length_mm + beyond) * stock.axis;
    coloured.strokes.push_back({low, high, kInk, 5});
    coloured.legend = {{kEnd, "END"}, {kBad, "NOT SEEN"}};
    for (std::size_t k = 0; k < check.indices.a_degrees.size(); ++k) {
        const double a = check.indices.a_degrees[k] * std::numbers::pi / 180;
        const Eigen::Vector3d direction =
            check.setup_from_model.inverse().turn(cam::check::tool_direction(a, options.a_sign));
        const Rgb colour = render::part_colour(k);
        coloured.strokes.push_back({high, high + 0.6 * stock.radius_mm * direction, colour, 5});
        coloured.legend.push_back({render::mixed(colour, {255, 255, 255}, 0.35),
                                   "A " + decomp::decimal(check.indices.a_degrees[k], 1)});
    }
    if (!check.tools.empty()) {
        coloured.legend.push_back({kInk, "NOT BY " + capitals(check.tools.front().tool)});
    }
    return draw(request, coloured, run);
}

}  // namespace tools
