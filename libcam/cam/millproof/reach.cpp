// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/reach.h"

#include <algorithm>
#include <cmath>

namespace cam::millproof {

namespace {

/// Beyond the part tools may go this far, in multiples of the largest radius.
constexpr double kBorder = 1.1;
/// mm: higher than any stock.
constexpr float kUncut = 1e9F;
/// Radii of a tool that are tried on a slope.
constexpr int kRadii = 200;
/// Faces whose normals rise less, in shares of their run, are upright.
constexpr double kUprightShare = 1e-6;

struct Offset {
    int dx = 0;
    int dy = 0;
    float lift = 0;
};

/// Cells under a tool whose rim is `rim` larger than it is.
std::vector<Offset> offsets_of(const tool::Tool& tool, double cell_mm, double rim) {
    std::vector<Offset> out;
    const double radius = tool.radius_mm();
    const int n = static_cast<int>(std::ceil((radius + rim) / cell_mm));
    for (int dy = -n; dy <= n; ++dy) {
        for (int dx = -n; dx <= n; ++dx) {
            const double r = std::hypot(dx, dy) * cell_mm;
            if (r > radius + rim) {
                continue;
            }
            if (const auto lift = tool::cutter_height_mm(tool, std::min(r, radius))) {
                out.push_back({dx, dy, static_cast<float>(*lift)});
            }
        }
    }
    return out;
}

/// out(c) = better(out(c), in(c + o)) for each cell c that has a cell there.
template <class Better>
void sweep(const std::vector<float>& in, const Nodes& cells, const Offset& o, const Better& better,
           std::vector<float>& out) {
    const int first = std::max(0, -o.dx);
    const int last = std::min(cells.columns, cells.columns - o.dx);
    for (int row = std::max(0, -o.dy); row < std::min(cells.rows, cells.rows - o.dy); ++row) {
        const float* from =
            in.data() + static_cast<std::ptrdiff_t>(row + o.dy) * cells.columns + o.dx;
        float* to = out.data() + static_cast<std::ptrdiff_t>(row) * cells.columns;
        for (int x = first; x < last; ++x) {
            to[x] = better(to[x], from[x]);
        }
    }
}

/// out(c) = the largest of in(c + o) - lift(o): the tool put down onto the map.
std::vector<float> lowered_onto(const std::vector<float>& in, const Nodes& cells,
                                const std::vector<Offset>& offsets, float floor) {
    std::vector<float> out(in.size(), floor);
    for (const Offset& o : offsets) {
        sweep(
            in, cells, o, [lift = o.lift](float a, float b) { return std::max(a, b - lift); }, out);
    }
    return out;
}

/// Where a tool rests on a slope: the radius at which its profile is as steep.
struct Rest {
    double radius = 0;
    double lift = 0;
};

Rest rest_on(const tool::Tool& tool, double steepness) {
    Rest best;
    double most = 0;
    for (int i = 0; i <= kRadii; ++i) {
        const double r = tool.radius_mm() * i / kRadii;
        const double lift = tool::cutter_height_mm(tool, r).value_or(0);
        if (steepness * r - lift > most) {
            most = steepness * r - lift;
            best = {r, lift};
        }
    }
    return best;
}

/// Raises the tool to where it rests on faces: between the cells of a steep face the map alone lets
/// it sink into it.
void rest_on_faces(const MillJob& job, const Nodes& cells, const tool::Tool& tool,
                   std::vector<float>& lowered) {
    for (const decomp::mesh::Triangle& triangle : job.part->triangles) {
        const Eigen::Vector3d& a = job.part->points[triangle[0]];
        const Eigen::Vector3d normal =
            (job.part->points[triangle[1]] - a).cross(job.part->points[triangle[2]] - a);
        const double across = normal.head<2>().norm();
        if (!(normal.z() > kUprightShare * across)) {
            continue;
        }
        const Rest rest = rest_on(tool, across / normal.z());
        Eigen::Vector2d uphill(0, 0);
        if (across > 0) {
            uphill = -normal.head<2>() / across;
        }
        Nodes axes = cells;
        axes.origin += rest.radius * uphill;
        visit_nodes(*job.part, triangle, axes, [&](std::size_t cell, double z) {
            lowered[cell] = std::max(lowered[cell], static_cast<float>(z - rest.lift));
        });
    }
}

/// out(c) = the least of in(c + o) + lift(o): what the tool leaves.
std::vector<float> left_by(const std::vector<float>& in, const Nodes& cells,
                           const std::vector<Offset>& offsets) {
    std::vector<float> out(in.size(), kUncut);
    for (const Offset& o : offsets) {
        sweep(
            in, cells, o, [lift = o.lift](float a, float b) { return std::min(a, b + lift); }, out);
    }
    return out;
}

/// Heights of the part and of what is kept, never below the floor.
std::vector<float> top_of(const MillJob& job, const Nodes& cells) {
    std::vector<float> top(cells.count(), static_cast<float>(job.floor_z));
    const auto raise = [&](std::size_t cell, double z) {
        top[cell] = std::max(top[cell], static_cast<float>(z));
    };
    const auto raise_nearest = [&](const Eigen::Vector2d& at, double z) {
        const Eigen::Vector2d place = (at - cells.origin) / cells.side;
        const int column = static_cast<int>(std::lround(place.x()));
        const int row = static_cast<int>(std::lround(place.y()));
        if (column >= 0 && row >= 0 && column < cells.columns && row < cells.rows) {
            raise(cells.index(column, row), z);
        }
    };
    for (const decomp::mesh::Triangle& triangle : job.part->triangles) {
        visit_nodes(*job.part, triangle, cells, raise);
    }
    for (const Eigen::AlignedBox3d& keep : job.keeps) {
        for (double y = keep.min().y(); y <= keep.max().y(); y += cells.side) {
            for (double x = keep.min().x(); x <= keep.max().x(); x += cells.side) {
                raise_nearest({x, y}, keep.max().z());
            }
        }
    }
    return top;
}

}  // namespace

Reach::Reach(const MillJob& job, double cell_mm) {
    double radius = 0;
    for (const ProofTool& tool : job.tools) {
        radius = std::max(radius, tool.tool.radius_mm());
    }
    cells_.side = cell_mm;
    cells_.origin = job.stock.min().head<2>().array() - kBorder * radius;
    const Eigen::Vector2d far = job.stock.max().head<2>().array() + kBorder * radius;
    cells_.columns = static_cast<int>(std::ceil((far.x() - cells_.origin.x()) / cell_mm)) + 1;
    cells_.rows = static_cast<int>(std::ceil((far.y() - cells_.origin.y()) / cell_mm)) + 1;
    const std::vector<float> top = top_of(job, cells_);
    closed_.assign(top.size(), kUncut);
    for (const ProofTool& tool : job.tools) {
        // A wall stands up to half a cell before the first cell that knows of it: a tool that just
        // fits on the map does not fit.
        std::vector<float> lowered =
            lowered_onto(top, cells_, offsets_of(tool.tool, cell_mm, cell_mm / 2),
                         static_cast<float>(job.floor_z));
        rest_on_faces(job, cells_, tool.tool, lowered);
        const std::vector<float> left = left_by(lowered, cells_, offsets_of(tool.tool, cell_mm, 0));
        for (std::size_t i = 0; i < left.size(); ++i) {
            closed_[i] = std::min(closed_[i], left[i]);
        }
    }
}

std::array<double, 4> Reach::around(const Eigen::Vector2d& at) const {
    const int column = static_cast<int>(std::floor((at.x() - cells_.origin.x()) / cells_.side));
    const int row = static_cast<int>(std::floor((at.y() - cells_.origin.y()) / cells_.side));
    std::array<double, 4> out{};
    for (int i = 0; i < 4; ++i) {
        const int x = std::clamp(column + i % 2, 0, cells_.columns - 1);
        const int y = std::clamp(row + i / 2, 0, cells_.rows - 1);
        out[static_cast<std::size_t>(i)] = closed_[cells_.index(x, y)];
    }
    return out;
}

double Reach::level(const Eigen::Vector2d& at) const {
    const std::array<double, 4> z = around(at);
    const Eigen::Vector2d cells = (at - cells_.origin) / cells_.side;
    const double u = cells.x() - std::floor(cells.x());
    const double v = cells.y() - std::floor(cells.y());
    return (1 - v) * ((1 - u) * z[0] + u * z[1]) + v * ((1 - u) * z[2] + u * z[3]);
}

double Reach::highest_around(const Eigen::Vector2d& at) const {
    const std::array<double, 4> z = around(at);
    return *std::max_element(z.begin(), z.end());
}

}  // namespace cam::millproof
