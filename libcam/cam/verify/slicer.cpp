// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/slicer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cam::verify {
namespace {

constexpr double kThinnestBinMm = 1e-9;

struct Crossing {
    int row;
    int sign;
    double x;
};

/// Where the edge a-b meets the plane; the same bits for b-a, so that neighbours share the point.
Eigen::Vector2d meet(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double z) {
    const bool swap = std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3);
    const Eigen::Vector3d& p = swap ? b : a;
    const Eigen::Vector3d& q = swap ? a : b;
    const double t = (z - p.z()) / (q.z() - p.z());
    return (p + t * (q - p)).head<2>();
}

}  // namespace

Slicer::Slicer(const decomp::mesh::TriMesh& mesh) : mesh_(&mesh) {
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t v : triangle) {
            bounds_.extend(mesh.points[v]);
        }
    }
    if (bounds_.isEmpty()) {
        starts_.assign(2, 0);
        return;
    }
    const double height = bounds_.max().z() - bounds_.min().z();
    const auto bins = static_cast<std::size_t>(std::clamp(height / 0.25, 1.0, 1000.0));
    bin_mm_ = std::max(height / static_cast<double>(bins), kThinnestBinMm);
    const auto range = [&](const decomp::mesh::Triangle& t) {
        const double a = mesh.points[t[0]].z();
        const double b = mesh.points[t[1]].z();
        const double c = mesh.points[t[2]].z();
        const auto bin = [&](double z) {
            const double at = std::floor((z - bounds_.min().z()) / bin_mm_);
            return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(bins - 1)));
        };
        return std::pair{bin(std::min({a, b, c})), bin(std::max({a, b, c}))};
    };
    starts_.assign(bins + 1, 0);
    for (const auto& t : mesh.triangles) {
        const auto [low, high] = range(t);
        for (std::size_t b = low; b <= high; ++b) {
            ++starts_[b + 1];
        }
    }
    for (std::size_t b = 0; b < bins; ++b) {
        starts_[b + 1] += starts_[b];
    }
    triangles_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [low, high] = range(mesh.triangles[i]);
        for (std::size_t b = low; b <= high; ++b) {
            triangles_[next[b]++] = i;
        }
    }
}

Section Slicer::at(double z) const {
    Section section;
    if (bounds_.isEmpty() || z < bounds_.min().z() || z > bounds_.max().z()) {
        return section;
    }
    const auto last = static_cast<double>(starts_.size() - 2);
    const auto bin = static_cast<std::size_t>(
        std::clamp(std::floor((z - bounds_.min().z()) / bin_mm_), 0.0, last));
    for (std::uint32_t k = starts_[bin]; k < starts_[bin + 1]; ++k) {
        const auto& t = mesh_->triangles[triangles_[k]];
        const std::array<bool, 3> above = {mesh_->points[t[0]].z() >= z,
                                           mesh_->points[t[1]].z() >= z,
                                           mesh_->points[t[2]].z() >= z};
        if (above[0] == above[1] && above[1] == above[2]) {
            continue;
        }
        // Seen from outside, the outline runs from the edge that comes down to the edge that goes
        // up.
        Eigen::Vector2d down = Eigen::Vector2d::Zero();
        Eigen::Vector2d up = Eigen::Vector2d::Zero();
        for (std::size_t e = 0; e < 3; ++e) {
            const std::size_t f = (e + 1) % 3;
            if (above[e] != above[f]) {
                (above[e] ? down : up) = meet(mesh_->points[t[e]], mesh_->points[t[f]], z);
            }
        }
        section.edges.push_back({down.x(), down.y(), up.x(), up.y()});
        section.bounds.extend(down);
        section.bounds.extend(up);
    }
    return section;
}

void fill_section(const Section& section, double pixel_mm, Bitmap& bitmap) {
    const int lowest = bitmap.window().bottom;
    const int highest = lowest + bitmap.window().rows - 1;
    std::vector<Crossing> crossings;
    for (const auto& [x0, y0, x1, y1] : section.edges) {
        const bool rising = y1 > y0;
        const double low = rising ? y0 : y1;
        const double high = rising ? y1 : y0;
        const int from = std::max(lowest, static_cast<int>(std::ceil(low / pixel_mm - 0.5)) - 1);
        const int to = std::min(highest, static_cast<int>(std::floor(high / pixel_mm - 0.5)) + 1);
        for (int j = from; j <= to; ++j) {
            const double y = (j + 0.5) * pixel_mm;
            if ((y0 <= y) != (y1 <= y)) {
                crossings.push_back({j, rising ? -1 : 1, x0 + (y - y0) / (y1 - y0) * (x1 - x0)});
            }
        }
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return a.row != b.row ? a.row < b.row : (a.x != b.x ? a.x < b.x : a.sign > b.sign);
    });
    int winding = 0;
    for (std::size_t k = 0; k < crossings.size(); ++k) {
        if (k == 0 || crossings[k].row != crossings[k - 1].row) {
            winding = 0;
        }
        winding += crossings[k].sign;
        if (winding > 0 && k + 1 < crossings.size() && crossings[k + 1].row == crossings[k].row) {
            bitmap.fill(crossings[k].row,
                        static_cast<int>(std::ceil(crossings[k].x / pixel_mm - 0.5)),
                        static_cast<int>(std::ceil(crossings[k + 1].x / pixel_mm - 0.5)) - 1);
        }
    }
}

void draw_outline(const Section& section, double radius_mm, double pixel_mm, Bitmap& bitmap) {
    const GridRows rows(bitmap.window(), pixel_mm);
    for (const auto& [x0, y0, x1, y1] : section.edges) {
        for_capsule_rows({x0, y0, x1, y1, radius_mm}, rows,
                         [&](int j, int i0, int i1) { bitmap.fill(j, i0, i1); });
    }
}

}  // namespace cam::verify
