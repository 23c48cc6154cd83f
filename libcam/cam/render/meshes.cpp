// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/lettering_detail.h"
#include "cam/render/shading_detail.h"
#include "decomp/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cam::render {

namespace {

using Eigen::Vector3f;

constexpr int kSide = 2;  // samples along a pixel's side
constexpr int kRaysPerSample = kSkyDirections / (kSide * kSide);
constexpr int kTile = 4;              // the pattern of sky directions repeats after so many pixels
constexpr float kViewerDistance = 2;  // of the scene's radius
constexpr float kLiftOff = 1e-3F;     // sky rays start so far above the surface, of the radius
constexpr float kSkyReach = 0.20F;    // what is farther away takes no light, of the radius
constexpr float kCreaseCosine = 0.75F;  // a drawn edge bends more than 41 degrees
constexpr float kStep = 0.012F;         // a drawn step in depth, of the radius
constexpr double kSilhouetteShade = 0.45;
constexpr double kCreaseShade = 0.70;
constexpr Rgb kCutFace{255, 246, 222};
constexpr double kCutFaceTint = 0.68;

class Picture {
  public:
    Picture(const std::vector<Item>& items, const ViewOptions& options, const Camera& camera,
            const RayScene& scene)
        : items_(items),
          options_(options),
          camera_(camera),
          scene_(scene),
          columns_(kSide * options.width_px),
          rows_(kSide * options.height_px),
          samples_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
          open_(static_cast<std::size_t>(options.width_px) *
                    static_cast<std::size_t>(options.height_px),
                1.0F) {
        for (const Item& item : items) {
            normals_.push_back(corner_normals(*item.mesh));
        }
    }

    /// Fills the samples of one row of samples. `step` is the distance of two samples in units of
    /// the radius.
    void see_row(int row, double step) {
        const Vector3f away = -camera_.toward_viewer.cast<float>();
        for (int column = 0; column < columns_; ++column) {
            const double x = (column + 0.5 - columns_ / 2.0) * step;
            const double y = (rows_ / 2.0 - row - 0.5) * step;
            const Eigen::Vector3d origin = x * camera_.right + y * camera_.up +
                                           double{kViewerDistance} * camera_.toward_viewer;
            const Hit hit = scene_.first_hit(origin.cast<float>(), away);
            if (hit.item >= 0) {
                sample(column, row) = seen(hit);
            }
        }
    }

    /// Casts the sky rays of one row of pixels.
    void open_row(int row, double step) {
        for (int column = 0; column < options_.width_px; ++column) {
            int cast = 0;
            int open = 0;
            for (int part = 0; part < kSide * kSide; ++part) {
                const int x = kSide * column + part % kSide;
                const int y = kSide * row + part / kSide;
                const Sample& s = sample(x, y);
                if (s.item < 0) {
                    continue;
                }
                const Vector3f start = sky_origin(s, x, y, step);
                const int slot = (row % kTile) * kTile + column % kTile;
                for (int ray = 0; ray < kRaysPerSample; ++ray) {
                    const int direction = ray * kSide * kSide + part;
                    ++cast;
                    open += scene_.blocked(start, sky_direction(s.flat_normal, direction, slot),
                                           kSkyReach)
                                ? 0
                                : 1;
                }
            }
            if (cast > 0) {
                open_[pixel(column, row)] = static_cast<float>(open) / static_cast<float>(cast);
            }
        }
    }

    /// The finished colour of one pixel.
    [[nodiscard]] Rgb colour(int column, int row) const {
        std::array<double, 3> sum{};
        for (int part = 0; part < kSide * kSide; ++part) {
            const Rgb c = sample_colour(kSide * column + part % kSide, kSide * row + part / kSide);
            sum[0] += c.red;
            sum[1] += c.green;
            sum[2] += c.blue;
        }
        const auto mean = [](double total) {
            return static_cast<std::uint8_t>(std::lround(total / (kSide * kSide)));
        };
        return {mean(sum[0]), mean(sum[1]), mean(sum[2])};
    }

    [[nodiscard]] int sample_rows() const { return rows_; }

    /// How far from the camera the surface is that a pixel shows, in units of the radius; infinite
    /// for the background.
    [[nodiscard]] float depth(int column, int row) const {
        const Sample& s = sample(kSide * column, kSide * row);
        return s.item < 0 ? std::numeric_limits<float>::infinity() : s.distance;
    }

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(x);
    }

    [[nodiscard]] std::size_t pixel(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(options_.width_px) +
               static_cast<std::size_t>(x);
    }

    [[nodiscard]] Sample& sample(int x, int y) { return samples_[index(x, y)]; }

    [[nodiscard]] const Sample& sample(int x, int y) const { return samples_[index(x, y)]; }

    [[nodiscard]] Sample seen(const Hit& hit) const {
        const auto which = static_cast<std::size_t>(hit.item);
        const Item& item = items_[which];
        const Vector3f* corner = &normals_[which][3 * std::size_t{hit.triangle}];
        const Vector3f toward = camera_.toward_viewer.cast<float>();
        const auto facing = [&](const Vector3f& n) { return n.dot(toward) < 0 ? Vector3f(-n) : n; };
        const auto& mesh = *item.mesh;
        const auto& t = mesh.triangles[hit.triangle];
        const Eigen::Vector3d flat = (mesh.points[t[1]] - mesh.points[t[0]])
                                         .cross(mesh.points[t[2]] - mesh.points[t[0]])
                                         .stableNormalized();
        const Vector3f smooth =
            (corner[0] * (1 - hit.u - hit.v) + corner[1] * hit.u + corner[2] * hit.v)
                .stableNormalized();
        const bool marked = hit.triangle < item.highlighted_triangles.size() &&
                            item.highlighted_triangles[hit.triangle];
        return {hit.item, hit.distance, facing(smooth), facing(flat.cast<float>()),
                marked,   hit.triangle};
    }

    [[nodiscard]] Vector3f sky_origin(const Sample& s, int x, int y, double step) const {
        const double along_right = (x + 0.5 - columns_ / 2.0) * step;
        const double along_up = (rows_ / 2.0 - y - 0.5) * step;
        const Eigen::Vector3d at = along_right * camera_.right + along_up * camera_.up +
                                   double{kViewerDistance - s.distance} * camera_.toward_viewer;
        return at.cast<float>() + kLiftOff * s.flat_normal;
    }

    /// Mean of the sky seen from the pixels around this one that show the same smooth surface: the
    /// pattern of directions repeats every kTile pixels, so the mean over a tile is free of it.
    [[nodiscard]] double open_around(int column, int row, const Sample& s) const {
        double sum = 0;
        int count = 0;
        for (int y = std::max(0, row - 1); y < std::min(options_.height_px, row - 1 + kTile); ++y) {
            for (int x = std::max(0, column - 1);
                 x < std::min(options_.width_px, column - 1 + kTile); ++x) {
                const Sample& other = sample(kSide * x, kSide * y);
                if (other.item == s.item && other.flat_normal.dot(s.flat_normal) > 0.9F &&
                    std::abs(other.distance - s.distance) < kStep * kTile) {
                    sum += double{open_[pixel(x, y)]};
                    ++count;
                }
            }
        }
        return count > 0 ? sum / count : double{open_[pixel(column, row)]};
    }

    /// How much darker a drawn edge makes a sample: 1 is no edge. Only the nearer surface carries
    /// the line, so a silhouette does not grow.
    [[nodiscard]] double edge_shade(int x, int y) const {
        const Sample& s = sample(x, y);
        double shade = 1;
        constexpr std::array<std::array<int, 2>, 4> kAround = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
        for (const auto& [dx, dy] : kAround) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= columns_ || y + dy >= rows_) {
                continue;
            }
            const Sample& other = sample(x + dx, y + dy);
            const bool nearer = other.item < 0 || s.distance <= other.distance;
            // A slanted surface falls away from one sample to the next; only a step beyond that is
            // a silhouette.
            const float slant =
                std::max(0.1F, s.flat_normal.dot(camera_.toward_viewer.cast<float>()));
            const bool step_down = other.item >= 0 && other.distance - s.distance > kStep / slant;
            if (nearer && (other.item != s.item || step_down)) {
                shade = std::min(shade, kSilhouetteShade);
            } else if (nearer && (s.normal.dot(other.normal) < kCreaseCosine ||
                                  s.highlighted != other.highlighted)) {
                shade = std::min(shade, kCreaseShade);
            }
        }
        return shade;
    }

    [[nodiscard]] Rgb sample_colour(int x, int y) const {
        const Sample& s = sample(x, y);
        if (s.item < 0) {
            return options_.background;
        }
        const Item& item = items_[static_cast<std::size_t>(s.item)];
        Rgb colour = s.triangle < item.triangle_colours.size() ? item.triangle_colours[s.triangle]
                                                               : item.colour;
        if (s.highlighted) {
            colour = mixed(colour, kCutFace, kCutFaceTint);
        }
        const double open = options_.occlusion ? open_around(x / kSide, y / kSide, s) : 1.0;
        double light = light_on(s.normal, camera_, open);
        if (options_.edges) {
            light *= edge_shade(x, y);
        }
        return mixed(Rgb{}, colour, light);
    }

    const std::vector<Item>& items_;
    const ViewOptions& options_;
    const Camera& camera_;
    const RayScene& scene_;
    int columns_;
    int rows_;
    std::vector<Sample> samples_;
    std::vector<float> open_;  // for each pixel, the part of the sky that its samples see
    std::vector<std::vector<Vector3f>> normals_;
};

}  // namespace

namespace {

/// Where the items of a picture lie in it.
struct Placing {
    const Camera& viewer;
    Eigen::Vector3d centre;
    double radius_mm;
    double px_per_mm;
};

void put_dot(Image& image, int x, int y, int reach, Rgb colour) {
    for (int j = std::max(0, y - reach); j <= std::min(image.height_px - 1, y + reach); ++j) {
        for (int i = std::max(0, x - reach); i <= std::min(image.width_px - 1, x + reach); ++i) {
            image.at(i, j) = colour;
        }
    }
}

void draw_stroke(Image& image, const Picture& picture, const Stroke& stroke,
                 const Placing& placing) {
    constexpr int kDotPx = 8;           // length of a dot and of a gap
    constexpr float kInFront = 0.004F;  // of the radius: a line on the surface is in front
    const double length_px = (stroke.to - stroke.from).norm() * placing.px_per_mm;
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * length_px)));
    const int reach = static_cast<int>(stroke.width_px / 2);
    for (int i = 0; i <= steps; ++i) {
        const Eigen::Vector3d at = stroke.from +
                                   (stroke.to - stroke.from) * (static_cast<double>(i) / steps) -
                                   placing.centre;
        const int x = static_cast<int>(
            std::floor(image.width_px / 2.0 + at.dot(placing.viewer.right) * placing.px_per_mm));
        const int y = static_cast<int>(
            std::floor(image.height_px / 2.0 - at.dot(placing.viewer.up) * placing.px_per_mm));
        if (x < 0 || y < 0 || x >= image.width_px || y >= image.height_px) {
            continue;
        }
        const auto distance = static_cast<float>(
            double{kViewerDistance} - at.dot(placing.viewer.toward_viewer) / placing.radius_mm);
        const bool hidden = distance > picture.depth(x, y) + kInFront;
        if (!hidden || (i / 2 / kDotPx) % 2 == 0) {
            put_dot(image, x, y, hidden ? std::max(0, reach - 1) : reach, stroke.colour);
        }
    }
}

void draw_legend(Image& image, const std::vector<Legend>& legend) {
    constexpr int kLetterDots = 2;
    constexpr int kRowPx = 10 * kLetterDots;
    constexpr int kLeftPx = 12;
    int top = image.height_px - kRowPx * static_cast<int>(legend.size()) - kLeftPx / 2;
    for (const Legend& row : legend) {
        const int half = kLetterHeightPx * kLetterDots / 2;
        put_dot(image, kLeftPx + half, top + half, half, row.colour);
        write(image, row.text,
              {.left_px = kLeftPx + 3 * half,
               .top_px = top,
               .size = kLetterDots,
               .colour = {40, 40, 40}});
        top += kRowPx;
    }
}

}  // namespace

decomp::Result<std::string> render_meshes_png(const std::vector<Item>& items,
                                              const ViewOptions& options, decomp::Run& run) {
    if (const auto size = check_size(options.width_px, options.height_px); !size) {
        return decomp::fail(size.error());
    }
    const Camera viewer = camera(options.view);
    Eigen::AlignedBox3d box = bounds_seen(items, viewer);
    if (box.isEmpty()) {
        return decomp::fail("render.empty", "there is nothing to draw: no item has a triangle");
    }
    for (const Stroke& stroke : options.strokes) {
        for (const Eigen::Vector3d& end : {stroke.from, stroke.to}) {
            box.extend(Eigen::Vector3d(end.dot(viewer.right), end.dot(viewer.up),
                                       end.dot(viewer.toward_viewer)));
        }
    }
    const Eigen::Vector3d seen = box.center();
    const Eigen::Vector3d centre =
        seen.x() * viewer.right + seen.y() * viewer.up + seen.z() * viewer.toward_viewer;
    const double radius_mm =
        std::max(box.diagonal().norm() / 2, 1 / fitted_scale_px_per_mm(box, options));
    auto scene = RayScene::of(items, centre, radius_mm);
    if (!scene) {
        return decomp::fail(scene.error());
    }
    Picture picture(items, options, viewer, *scene);
    const double step = 1 / (fitted_scale_px_per_mm(box, options) * kSide * radius_mm);
    const auto height = static_cast<std::size_t>(options.height_px);
    decomp::for_each_index(run, static_cast<std::size_t>(picture.sample_rows()),
                           [&](std::size_t row) { picture.see_row(static_cast<int>(row), step); });
    if (options.occlusion) {
        decomp::for_each_index(
            run, height, [&](std::size_t row) { picture.open_row(static_cast<int>(row), step); });
    }
    Image image(options.width_px, options.height_px, options.background);
    decomp::for_each_index(run, height, [&](std::size_t row) {
        for (int x = 0; x < options.width_px; ++x) {
            image.at(x, static_cast<int>(row)) = picture.colour(x, static_cast<int>(row));
        }
    });
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    const Placing placing{viewer, centre, radius_mm, fitted_scale_px_per_mm(box, options)};
    for (const Stroke& stroke : options.strokes) {
        draw_stroke(image, picture, stroke, placing);
    }
    draw_legend(image, options.legend);
    return png_bytes(image);
}

}  // namespace cam::render
