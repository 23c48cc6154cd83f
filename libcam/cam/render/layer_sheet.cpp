// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/lettering_detail.h"
#include "cam/render/view_detail.h"
#include "decomp/base/number.h"
#include "decomp/base/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace cam::render {

namespace {

constexpr int kSide = 3;       // samples along a pixel's side
constexpr double kRim = 0.80;  // the outer part of a bead's half width is drawn darker
constexpr double kRimShade = 0.28;
constexpr int kGapPx = 8;
constexpr int kTitleSize = 2;
constexpr int kLegendPx = 26;  // one line of the legend
constexpr int kLegendWidthPx = 250;
constexpr double kBarShare = 0.80;  // of the legend's width, at most, for the scale bar
constexpr Rgb kInk{40, 40, 40};
constexpr std::size_t kFeatures = 13;
constexpr double kLeastLength2 = 1e-12;  // a bead of no length is a dot

/// A rectangle of the picture that shows one layer.
struct Cell {
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
};

/// From millimetres to pixels: the point `centre` comes to the middle of the cell.
struct Fit {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double px_per_mm = 1;
};

Eigen::AlignedBox2d bounds_of(const path::Layer& layer) {
    Eigen::AlignedBox2d box;
    for (const auto& bead : layer.beads) {
        const Eigen::Vector2d reach = Eigen::Vector2d::Constant(bead.width_mm / 2);
        for (const auto& point : bead.points) {
            box.extend(Eigen::Vector2d(point - reach));
            box.extend(Eigen::Vector2d(point + reach));
        }
    }
    return box;
}

/// Samples of one cell, kSide x kSide a pixel, painted in printing order: what is printed later
/// lies on top.
class Canvas {
  public:
    Canvas(const Cell& cell, Rgb background)
        : image_(cell.width * kSide, cell.height * kSide, background) {}

    void paint(const path::Bead& bead, const Fit& fit) {
        for (std::size_t i = 0; i + 1 < bead.points.size(); ++i) {
            paint(on_canvas(bead.points[i], fit), on_canvas(bead.points[i + 1], fit),
                  {bead.width_mm / 2 * fit.px_per_mm * kSide, feature_colour(bead.feature)});
        }
    }

    void average_into(Image& picture, const Cell& cell) const {
        for (int y = 0; y < cell.height; ++y) {
            for (int x = 0; x < cell.width; ++x) {
                picture.at(cell.left + x, cell.top + y) = mean_at(x, y);
            }
        }
    }

  private:
    struct Brush {
        double half_width = 0;
        Rgb colour;
    };

    [[nodiscard]] Eigen::Vector2d on_canvas(const Eigen::Vector2d& point, const Fit& fit) const {
        const Eigen::Vector2d d = (point - fit.centre) * fit.px_per_mm * kSide;
        return {image_.width_px / 2.0 + d.x(), image_.height_px / 2.0 - d.y()};
    }

    void paint(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Brush& brush) {
        const Eigen::Vector2d along = b - a;
        const double length2 = std::max(along.squaredNorm(), kLeastLength2);
        const Rgb rim = mixed(brush.colour, kInk, kRimShade);
        const auto first = [](double p, double q, double half) {
            return std::max(0, static_cast<int>(std::floor(std::min(p, q) - half)));
        };
        const auto last = [](double p, double q, double half) {
            return static_cast<int>(std::ceil(std::max(p, q) + half));
        };
        const int x0 = first(a.x(), b.x(), brush.half_width);
        const int y0 = first(a.y(), b.y(), brush.half_width);
        const int x1 = std::min(image_.width_px, last(a.x(), b.x(), brush.half_width));
        const int y1 = std::min(image_.height_px, last(a.y(), b.y(), brush.half_width));
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                const Eigen::Vector2d p(x + 0.5, y + 0.5);
                const double t = std::clamp((p - a).dot(along) / length2, 0.0, 1.0);
                const double distance = (p - a - t * along).norm();
                if (distance <= brush.half_width) {
                    image_.at(x, y) = distance > kRim * brush.half_width ? rim : brush.colour;
                }
            }
        }
    }

    [[nodiscard]] Rgb mean_at(int x, int y) const {
        std::array<int, 3> sum{};
        for (int part = 0; part < kSide * kSide; ++part) {
            const Rgb c = image_.at(kSide * x + part % kSide, kSide * y + part / kSide);
            sum[0] += c.red;
            sum[1] += c.green;
            sum[2] += c.blue;
        }
        const auto mean = [](int total) {
            return static_cast<std::uint8_t>((total + kSide * kSide / 2) / (kSide * kSide));
        };
        return {mean(sum[0]), mean(sum[1]), mean(sum[2])};
    }

    Image image_;
};

void fill(Image& image, const Cell& area, Rgb colour) {
    for (int y = std::max(0, area.top); y < std::min(image.height_px, area.top + area.height);
         ++y) {
        for (int x = std::max(0, area.left); x < std::min(image.width_px, area.left + area.width);
             ++x) {
            image.at(x, y) = colour;
        }
    }
}

/// The longest of 1, 2, 5, 10, 20, 50 ... mm that fits.
double bar_length_mm(double greatest_mm) {
    double length = std::pow(10.0, std::floor(std::log10(greatest_mm)));
    for (const double factor : {5.0, 2.0}) {
        if (length * factor <= greatest_mm) {
            return length * factor;
        }
    }
    return length;
}

void draw_scale_bar(Image& image, const Cell& cell, double px_per_mm) {
    const double length_mm = bar_length_mm(kBarShare * cell.width / px_per_mm);
    const int length = static_cast<int>(std::lround(length_mm * px_per_mm));
    const int bottom = cell.top + cell.height - kGapPx;
    fill(image, {cell.left + kGapPx, bottom - 4, length, 4}, kInk);
    write(image, decomp::decimal(length_mm, 3) + " mm",
          {cell.left + kGapPx, bottom - 8 - kTitleSize * kLetterHeightPx, kTitleSize, kInk});
}

using FeatureSet = std::array<bool, kFeatures>;

FeatureSet features_of(const path::Layer& layer) {
    FeatureSet set{};
    for (const auto& bead : layer.beads) {
        set.at(static_cast<std::size_t>(bead.feature)) = true;
    }
    return set;
}

void draw_legend(Image& image, const FeatureSet& set, int left) {
    int top = kGapPx;
    for (std::size_t i = 0; i < set.size(); ++i) {
        if (set.at(i)) {
            const auto feature = static_cast<path::Feature>(i);
            fill(image, {left, top, kLegendPx - kGapPx, kLegendPx - kGapPx},
                 feature_colour(feature));
            write(image, path::feature_name(feature),
                  {left + kLegendPx, top + 2, kTitleSize, kInk});
            top += kLegendPx;
        }
    }
}

struct Sheet {
    std::vector<Cell> cells;
    int legend_left = 0;
};

/// The number of columns that leaves the layers biggest, then their cells row by row.
Sheet arranged(std::size_t count, const Eigen::Vector2d& size_mm, const LayerViewOptions& options) {
    Sheet sheet;
    sheet.legend_left =
        options.width_px - (options.legend ? std::min(kLegendWidthPx, options.width_px / 3) : 0);
    const int n = static_cast<int>(count);
    int columns = 1;
    double best = 0;
    for (int c = 1; c <= n; ++c) {
        const int rows = (n + c - 1) / c;
        const double scale = std::min(sheet.legend_left / (c * size_mm.x()),
                                      options.height_px / (rows * size_mm.y()));
        if (scale > best) {
            best = scale;
            columns = c;
        }
    }
    const int rows = (n + columns - 1) / columns;
    for (int i = 0; i < n; ++i) {
        const int width = sheet.legend_left / columns;
        const int height = options.height_px / rows;
        sheet.cells.push_back({i % columns * width, i / columns * height, width, height});
    }
    return sheet;
}

decomp::Result<std::string> draw(const std::vector<const path::Layer*>& layers,
                                 const std::vector<std::size_t>& numbers,
                                 const LayerViewOptions& options, decomp::Run& run) {
    if (const auto size = check_size(options.width_px, options.height_px); !size) {
        return decomp::fail(size.error());
    }
    Eigen::AlignedBox2d box;
    FeatureSet features{};
    for (const auto* layer : layers) {
        box.extend(bounds_of(*layer));
        const FeatureSet own = features_of(*layer);
        for (std::size_t i = 0; i < own.size(); ++i) {
            features.at(i) = features.at(i) || own.at(i);
        }
    }
    if (box.isEmpty()) {
        return decomp::fail("render.empty", "there is nothing to draw: the layers hold no bead");
    }
    const Sheet sheet = arranged(layers.size(), box.sizes(), options);
    const Cell& cell = sheet.cells.front();
    const int text = options.legend ? kTitleSize * kLetterHeightPx + kGapPx : 0;
    const double room_x = std::max(1, cell.width - 2 * kGapPx);
    const double room_y = std::max(1, cell.height - 2 * kGapPx - 2 * text);
    const Fit fit{box.center(), std::min(room_x / box.sizes().x(), room_y / box.sizes().y())};
    Image image(options.width_px, options.height_px, options.background);
    decomp::for_each_index(run, layers.size(), [&](std::size_t i) {
        Canvas canvas(sheet.cells[i], options.background);
        for (const auto& bead : layers[i]->beads) {
            canvas.paint(bead, fit);
        }
        canvas.average_into(image, sheet.cells[i]);
    });
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    if (options.legend) {
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const std::string number =
                numbers.empty() ? "" : "layer " + std::to_string(numbers[i] + 1) + "  ";
            write(image, number + "z " + decomp::decimal(layers[i]->z_mm, 3),
                  {sheet.cells[i].left + kGapPx, sheet.cells[i].top + kGapPx, kTitleSize, kInk});
        }
        draw_scale_bar(image,
                       {sheet.legend_left, 0, options.width_px - sheet.legend_left, cell.height},
                       fit.px_per_mm);
        draw_legend(image, features, sheet.legend_left + kGapPx);
    }
    return png_bytes(image);
}

}  // namespace

Rgb feature_colour(path::Feature feature) {
    switch (feature) {
        case path::Feature::OuterWall:
            return {222, 96, 48};
        case path::Feature::InnerWall:
            return {240, 176, 80};
        case path::Feature::SolidInfill:
            return {120, 132, 205};
        case path::Feature::TopSkin:
            return {205, 84, 108};
        case path::Feature::BottomSkin:
            return {92, 150, 214};
        case path::Feature::SparseInfill:
            return {170, 86, 160};
        case path::Feature::OverhangWall:
            return {250, 60, 160};
        case path::Feature::Bridge:
            return {60, 170, 190};
        case path::Feature::Support:
            return {120, 190, 110};
        case path::Feature::SupportInterface:
            return {60, 140, 70};
        case path::Feature::Skirt:
            return {150, 150, 150};
        case path::Feature::Brim:
            return {190, 190, 150};
        case path::Feature::Prime:
            return {110, 110, 110};
    }
    return {};
}

decomp::Result<std::string> render_layer_png(const path::Layer& layer,
                                             const LayerViewOptions& options, decomp::Run& run) {
    return draw({&layer}, {}, options, run);
}

decomp::Result<std::string> render_layers_png(const path::LayerStack& stack,
                                              const std::vector<std::size_t>& chosen,
                                              const LayerViewOptions& options, decomp::Run& run) {
    if (chosen.empty()) {
        return decomp::fail("render.empty", "there is nothing to draw: no layer was chosen");
    }
    std::vector<const path::Layer*> layers;
    for (const auto index : chosen) {
        if (index >= stack.layers.size()) {
            return decomp::fail(
                "render.layer", "there is no layer " + std::to_string(index + 1), {},
                "the layers are numbered 1 to " + std::to_string(stack.layers.size()));
        }
        layers.push_back(&stack.layers[index]);
    }
    return draw(layers, chosen, options, run);
}

std::vector<std::size_t> spread_layers(const path::LayerStack& stack, std::size_t count) {
    const std::size_t all = stack.layers.size();
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < std::min(count, all); ++i) {
        chosen.push_back(count >= all ? i : i * (all - 1) / std::max<std::size_t>(1, count - 1));
    }
    return chosen;
}

}  // namespace cam::render
