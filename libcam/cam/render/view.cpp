// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/view_detail.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace cam::render {

namespace {

constexpr int kLeastSidePx = 16;
constexpr int kGreatestSidePx = 8192;
constexpr double kLeastExtentMm = 1e-6;  // a flat item seen edge-on still has a scale

constexpr std::array<std::pair<std::string_view, View>, 8> kViews = {{{"iso", View::Iso},
                                                                      {"under", View::Under},
                                                                      {"front", View::Front},
                                                                      {"back", View::Back},
                                                                      {"left", View::Left},
                                                                      {"right", View::Right},
                                                                      {"top", View::Top},
                                                                      {"bottom", View::Bottom}}};

Camera looking_from(const Eigen::Vector3d& viewer, const Eigen::Vector3d& upward) {
    const Eigen::Vector3d toward = viewer.normalized();
    const Eigen::Vector3d right = upward.cross(toward).normalized();
    return {right, toward.cross(right), toward};
}

}  // namespace

decomp::Result<View> view_named(std::string_view name) {
    for (const auto& [known, view] : kViews) {
        if (known == name) {
            return view;
        }
    }
    return decomp::fail("render.view", "there is no view '" + std::string(name) + "'", {},
                        "views are iso, under, front, back, left, right, top and bottom");
}

Camera camera(View view) {
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    switch (view) {
        case View::Iso:
            return looking_from({0.62, -1.0, 0.62}, z);
        case View::Under:
            return looking_from({0.62, -1.0, -0.62}, z);
        case View::Front:
            return looking_from({0, -1, 0}, z);
        case View::Back:
            return looking_from({0, 1, 0}, z);
        case View::Left:
            return looking_from({-1, 0, 0}, z);
        case View::Right:
            return looking_from({1, 0, 0}, z);
        case View::Top:
            return looking_from({0, 0, 1}, {0, 1, 0});
        case View::Bottom:
            return looking_from({0, 0, -1}, {0, -1, 0});
    }
    return looking_from({0, -1, 0}, z);
}

Eigen::AlignedBox3d bounds_seen(const std::vector<Item>& items, const Camera& camera) {
    Eigen::AlignedBox3d box;
    for (const Item& item : items) {
        for (const auto& triangle : item.mesh->triangles) {
            for (const auto corner : triangle) {
                const Eigen::Vector3d point = item.mesh->points[corner] + item.offset;
                box.extend(Eigen::Vector3d(point.dot(camera.right), point.dot(camera.up),
                                           point.dot(camera.toward_viewer)));
            }
        }
    }
    return box;
}

double fitted_scale_px_per_mm(const Eigen::AlignedBox3d& seen, const ViewOptions& options) {
    const double border = 2 * options.margin * std::min(options.width_px, options.height_px);
    const Eigen::Vector3d size = seen.sizes().cwiseMax(kLeastExtentMm);
    return std::min((options.width_px - border) / size.x(),
                    (options.height_px - border) / size.y());
}

double fitted_scale_px_per_mm(const std::vector<Item>& items, const ViewOptions& options) {
    return fitted_scale_px_per_mm(bounds_seen(items, camera(options.view)), options);
}

decomp::Status check_size(int width_px, int height_px) {
    const int least = std::min(width_px, height_px);
    const int greatest = std::max(width_px, height_px);
    if (least < kLeastSidePx || greatest > kGreatestSidePx) {
        return decomp::fail("render.size",
                            "a picture of " + std::to_string(width_px) + " x " +
                                std::to_string(height_px) + " pixels cannot be made",
                            {}, "choose sides between 16 and 8192 pixels");
    }
    return {};
}

}  // namespace cam::render
