// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/layers.h"
#include "cam/render/image.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/part.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cam::render {

/// Where the viewer stands. Front looks along +Y with Z up; Top looks down with Y up; Iso stands at
/// the front, to the right and above; Under the same from below.
enum class View { Iso, Under, Front, Back, Left, Right, Top, Bottom };

/// The view of that name, lower case. @error render.view
[[nodiscard]] decomp::Result<View> view_named(std::string_view name);

/// A straight line drawn into a picture: solid where nothing is in front of it, dotted where
/// something is.
struct Stroke {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< mm, frame of the items
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    Rgb colour;
    double width_px = 3;
};

/// A line of text with a patch of colour before it, in the picture's lower left corner.
struct Legend {
    Rgb colour;
    std::string text;  ///< capitals, digits and "-.:/ "
};

struct ViewOptions {
    View view = View::Iso;
    int width_px = 1200;
    int height_px = 900;
    double margin = 0.04;  ///< empty border, fraction of the shorter side
    Rgb background{255, 255, 255};
    bool edges = true;      ///< silhouettes and creases are drawn
    bool occlusion = true;  ///< hollows are darker
    std::vector<Stroke> strokes{};
    std::vector<Legend> legend{};
};

/// One mesh in a picture.
struct Item {
    const decomp::mesh::TriMesh* mesh = nullptr;
    Rgb colour{150, 170, 200};
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< mm, added to every point
    std::vector<bool> highlighted_triangles;           ///< tinted; empty: none
    std::vector<Rgb> triangle_colours{};               ///< instead of `colour`; empty: none
};

/// A colour for part number `index`, well apart from that of its neighbours in number.
[[nodiscard]] Rgb part_colour(std::size_t index);

/// The parts of an assembly, each moved away from the centre of the whole by `fraction` of the way
/// between the two centres, cut faces highlighted. The items point into the assembly.
[[nodiscard]] std::vector<Item> explode(const decomp::part::Assembly& assembly, double fraction);

/// Pixels per millimetre at which these items fill the picture up to its margin.
[[nodiscard]] double fitted_scale_px_per_mm(const std::vector<Item>& items,
                                            const ViewOptions& options);

/// An orthographic picture, fitted to the items. Cost: 4 rays a pixel, and 16 more where something
/// is hit.
/// @error render.empty (nothing to draw), render.size (a side outside 16 ... 8192 pixels),
/// render.device, render.png, run.cancelled
[[nodiscard]] decomp::Result<std::string> render_meshes_png(const std::vector<Item>& items,
                                                            const ViewOptions& options,
                                                            decomp::Run& run);

struct LayerViewOptions {
    int width_px = 1200;
    int height_px = 900;
    Rgb background{255, 255, 255};
    bool legend = true;  ///< height, features and scale bar are written
};

/// The colour of a feature in every picture of toolpaths.
[[nodiscard]] Rgb feature_colour(path::Feature feature);

/// One layer seen from above, its beads in their true width, coloured by feature.
/// @error render.empty (no bead), render.size, render.png, run.cancelled
[[nodiscard]] decomp::Result<std::string> render_layer_png(const path::Layer& layer,
                                                           const LayerViewOptions& options,
                                                           decomp::Run& run);

/// A contact sheet: the chosen layers side by side at one scale, in the given order.
/// @error render.empty (no layer chosen, or no bead in any), render.layer (no such layer),
/// render.size, render.png, run.cancelled
[[nodiscard]] decomp::Result<std::string> render_layers_png(const path::LayerStack& stack,
                                                            const std::vector<std::size_t>& chosen,
                                                            const LayerViewOptions& options,
                                                            decomp::Run& run);

/// `count` layer indices spread evenly from the first layer to the last.
[[nodiscard]] std::vector<std::size_t> spread_layers(const path::LayerStack& stack,
                                                     std::size_t count);

/// The beads of one feature as prisms, to be drawn in space.
struct BeadMesh {
    path::Feature feature = path::Feature::OuterWall;
    decomp::mesh::TriMesh mesh;
};

/// The beads of layers [first, last) as meshes, one for each feature that occurs, in the order of
/// the features.
[[nodiscard]] std::vector<BeadMesh> bead_meshes(const path::LayerStack& stack, std::size_t first,
                                                std::size_t last);

}  // namespace cam::render
