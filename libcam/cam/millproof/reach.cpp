// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/reach.h"

#include <algorithm>
#include <cmath>

namespace cam::millproof {

namespace {

/// Beyond the part tools may go this far, in multiples of the largest radius.
constexpr double kBorder = 1.1;

struct Offset {
    int dx = 0;
    int dy = 0;
    float lift = 0;
};

std::vector<Offset> offsets_of(const tool::Tool& tool, double cell_mm) {
    std::vector<Offset> out;
    const int n = static_cast<int>(std::ceil(tool.radius_mm() / cell_mm));
    for (int dy = -n; dy <= n; ++dy) {
        for (int dx = -n; dx <= n; ++dx) {
            const double r = std::hypot(dx, dy) * cell_mm;
            if (r <= tool.radius_mm()) {
                if (const auto lift = tool::cutter_height_mm(tool, r)) {
                    out.push_back({dx, dy, static_cast<float>(*lift)});
                }
            }
        }
    }
    return out;
}

/// out(c) = the largest of in(c + o) - lift(o), or the least of in(c + o) + lift(o).
std::vector<float> swept(const std::vector<float>& in, int columns, int rows,
                         const std::vector<Offset>& offsets, bool lower_onto, float outside) {
    std::vector<float> out(in.size(), lower_onto ? outside : 1e9F);
    for (const Offset& o : offsets) {
        const int first = std::max(0, -o.dx);
        const int last = std::min(columns, columns - o.dx);
        for (int row = std::max(0, -o.dy); row < std::min(rows, rows - o.dy); ++row) {
            const float* from =
                in.data() + static_cast<std::ptrdiff_t>(row + o.dy) * columns + o.dx;
            float* to = out.data() + static_cast<std::ptrdiff_t>(row) * columns;
            if (lower_onto) {
                for (int x = first; x < last; ++x) {
                    to[x] = std::max(to[x], from[x] - o.lift);
                }
            } else {
                for (int x = first; x < last; ++x) {
                    to[x] = std::min(to[x], from[x] + o.lift);
                }
            }
        }
    }
    return out;
}

}  // namespace

Reach::Reach(const MillJob& job, double cell_mm) : cell_mm_(cell_mm) {
    double radius = 0;
    for (const ProofTool& tool : job.tools) {
        radius = std::max(radius, tool.tool.radius_mm());
    }
    origin_ = job.stock.min().head<2>().array() - kBorder * radius;
    const Eigen::Vector2d far = job.stock.max().head<2>().array() + kBorder * radius;
    columns_ = static_cast<int>(std::ceil((far.x() - origin_.x()) / cell_mm)) + 1;
    rows_ = static_cast<int>(std::ceil((far.y() - origin_.y()) / cell_mm)) + 1;
    const auto floor = static_cast<float>(job.floor_z);
    std::vector<float> top(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                           floor);
    const auto raise = [&](double x, double y, double z) {
        const int column = static_cast<int>(std::lround((x - origin_.x()) / cell_mm_));
        const int row = static_cast<int>(std::lround((y - origin_.y()) / cell_mm_));
        if (column >= 0 && row >= 0 && column < columns_ && row < rows_) {
            float& cell = top[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                              static_cast<std::size_t>(column)];
            cell = std::max(cell, static_cast<float>(z));
        }
    };
    for (const decomp::mesh::Triangle& triangle : job.part->triangles) {
        const Eigen::Vector3d& a = job.part->points[triangle[0]];
        const Eigen::Vector3d& b = job.part->points[triangle[1]];
        const Eigen::Vector3d& c = job.part->points[triangle[2]];
        const double area2 = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
        if (!(area2 > 0)) {
            continue;  // looks down, or stands upright
        }
        const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c);
        const Eigen::Vector3d high = a.cwiseMax(b).cwiseMax(c);
        const auto first = [&](double v, int axis) {
            return static_cast<int>(std::ceil((v - origin_[axis]) / cell_mm_));
        };
        for (int row = first(low.y(), 1); origin_.y() + row * cell_mm_ <= high.y(); ++row) {
            for (int column = first(low.x(), 0); origin_.x() + column * cell_mm_ <= high.x();
                 ++column) {
                const double x = origin_.x() + column * cell_mm_;
                const double y = origin_.y() + row * cell_mm_;
                const double u = ((x - a.x()) * (c - a).y() - (y - a.y()) * (c - a).x()) / area2;
                const double v = ((b - a).x() * (y - a.y()) - (b - a).y() * (x - a.x())) / area2;
                if (u >= 0 && v >= 0 && u + v <= 1) {
                    raise(x, y, a.z() + u * (b - a).z() + v * (c - a).z());
                }
            }
        }
    }
    for (const Eigen::AlignedBox3d& keep : job.keeps) {
        for (double y = keep.min().y(); y <= keep.max().y(); y += cell_mm_) {
            for (double x = keep.min().x(); x <= keep.max().x(); x += cell_mm_) {
                raise(x, y, keep.max().z());
            }
        }
    }
    closed_.assign(top.size(), 1e9F);
    for (const ProofTool& tool : job.tools) {
        const std::vector<Offset> offsets = offsets_of(tool.tool, cell_mm_);
        const std::vector<float> lowered = swept(top, columns_, rows_, offsets, true, floor);
        const std::vector<float> left = swept(lowered, columns_, rows_, offsets, false, floor);
        for (std::size_t i = 0; i < left.size(); ++i) {
            closed_[i] = std::min(closed_[i], left[i]);
        }
    }
}

std::array<double, 4> Reach::around(const Eigen::Vector2d& at) const {
    const int column = static_cast<int>(std::floor((at.x() - origin_.x()) / cell_mm_));
    const int row = static_cast<int>(std::floor((at.y() - origin_.y()) / cell_mm_));
    std::array<double, 4> out{};
    for (int i = 0; i < 4; ++i) {
        const int x = std::clamp(column + i % 2, 0, columns_ - 1);
        const int y = std::clamp(row + i / 2, 0, rows_ - 1);
        out[static_cast<std::size_t>(i)] =
            closed_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(x)];
    }
    return out;
}

double Reach::level(const Eigen::Vector2d& at) const {
    const std::array<double, 4> z = around(at);
    const Eigen::Vector2d cells = (at - origin_) / cell_mm_;
    const double u = cells.x() - std::floor(cells.x());
    const double v = cells.y() - std::floor(cells.y());
    return (1 - v) * ((1 - u) * z[0] + u * z[1]) + v * ((1 - u) * z[2] + u * z[3]);
}

double Reach::highest_around(const Eigen::Vector2d& at) const {
    const std::array<double, 4> z = around(at);
    return *std::max_element(z.begin(), z.end());
}

}  // namespace cam::millproof
