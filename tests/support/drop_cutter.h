// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

/// Where a rotating tool, lowered along -Z, comes to rest on triangles: in double precision and
/// without a grid. A tool is its outline z(r), convex and growing, up to a radius. Over a triangle
/// the tip rests at max over its points x of x.z - z(|x - q|), a concave function on a convex set:
/// its maximum is where the plane touches the tool, if the triangle holds that point, or else on an
/// edge.
namespace tests {

using decomp::mesh::TriMesh;

struct Outline {
    double radius_mm = 0;
    std::function<double(double r_mm)> height;
};

inline Outline flat_end(double radius) {
    return {radius, [](double) { return 0.0; }};
}

inline Outline ball_end(double radius) {
    return {radius, [radius](double r) {
                return radius - std::sqrt(std::max(0.0, radius * radius - r * r));
            }};
}

inline Outline bull_nose(double radius, double corner) {
    return {radius, [radius, corner](double r) {
                const double in = std::max(0.0, r - (radius - corner));
                return corner - std::sqrt(std::max(0.0, corner * corner - in * in));
            }};
}

/// A pointed cone, `slope` up per mm of radius.
inline Outline pointed(double radius, double slope) {
    return {radius, [slope](double r) { return slope * r; }};
}

/// Maximum of a concave function between two places.
template <class Function>
double highest_between(double low, double high, Function value) {
    constexpr int kSteps = 40;  // each leaves 0.62 of the interval: 4e-9 of it
    constexpr double kGolden = 0.6180339887498949;
    double a = high - kGolden * (high - low);
    double b = low + kGolden * (high - low);
    double at_a = value(a);
    double at_b = value(b);
    for (int step = 0; step < kSteps; ++step) {
        if (at_a < at_b) {
            low = std::exchange(a, b);
            at_a = at_b;
            b = low + kGolden * (high - low);
            at_b = value(b);
        } else {
            high = std::exchange(b, a);
            at_b = at_a;
            a = high - kGolden * (high - low);
            at_a = value(a);
        }
    }
    return std::max({at_a, at_b, value(low), value(high)});
}

/// Where along the radius a tool touches a plane that rises by `slope` a mm.
inline double contact_radius(const Outline& tool, double slope) {
    double low = 0;
    double high = tool.radius_mm;
    constexpr int kSteps = 60;  // each leaves two thirds of the interval
    for (int step = 0; step < kSteps && high > low; ++step) {
        const double a = low + (high - low) / 3;
        const double b = high - (high - low) / 3;
        // Ties go outwards: a flat end touches a floor with all of itself.
        (slope * a - tool.height(a) > slope * b - tool.height(b) ? high : low) =
            slope * a - tool.height(a) > slope * b - tool.height(b) ? b : a;
    }
    return high;
}

class DropCutter {
  public:
    DropCutter(const TriMesh& mesh, Outline tool) : mesh_(mesh), tool_(std::move(tool)) {}

    /// Whether the tip may stand at `z` above q: no triangle lifts it by more.
    [[nodiscard]] bool stands(const Eigen::Vector2d& q, double z) const {
        return std::all_of(mesh_.triangles.begin(), mesh_.triangles.end(), [&](const auto& t) {
            // No tool rests higher than what it rests on.
            const bool low = mesh_.points[t[0]].z() <= z && mesh_.points[t[1]].z() <= z &&
                             mesh_.points[t[2]].z() <= z;
            return low || rest(t, q) <= z;
        });
    }

    /// Lowest place of the tip above q; minus infinity where nothing is below.
    [[nodiscard]] double lowest(const Eigen::Vector2d& q) const {
        double z = -std::numeric_limits<double>::infinity();
        for (const auto& t : mesh_.triangles) {
            z = std::max(z, rest(t, q));
        }
        return z;
    }

    [[nodiscard]] const Outline& tool() const { return tool_; }

  private:
    using Corners = std::array<Eigen::Vector3d, 3>;

    [[nodiscard]] double rest(const decomp::mesh::Triangle& t, const Eigen::Vector2d& q) const {
        const Corners c{mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]};
        for (int axis = 0; axis < 2; ++axis) {
            const auto [low, high] = std::minmax({c[0][axis], c[1][axis], c[2][axis]});
            if (low > q[axis] + tool_.radius_mm || high < q[axis] - tool_.radius_mm) {
                return -std::numeric_limits<double>::infinity();
            }
        }
        double z = on_face(c, q);
        for (std::size_t i = 0; i < 3; ++i) {
            z = std::max(z, on_edge(c.at(i), c.at((i + 1) % 3), q));
        }
        return z;
    }

    [[nodiscard]] double on_face(const Corners& c, const Eigen::Vector2d& q) const {
        const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
        if (normal.z() == 0) {
            return -std::numeric_limits<double>::infinity();
        }
        const Eigen::Vector2d gradient = -normal.head<2>() / normal.z();
        const double slope = gradient.norm();
        const double r = contact_radius(tool_, slope);
        Eigen::Vector2d at = q;
        if (slope > 0) {
            at += r / slope * gradient;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const Eigen::Vector2d edge = (c.at((i + 1) % 3) - c.at(i)).head<2>();
            const Eigen::Vector2d to = at - c.at(i).head<2>();
            if ((edge.x() * to.y() - edge.y() * to.x()) * normal.z() < 0) {
                return -std::numeric_limits<double>::infinity();
            }
        }
        return c[0].z() + gradient.dot(at - c[0].head<2>()) - tool_.height(slope > 0 ? r : 0);
    }

    [[nodiscard]] double on_edge(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector2d& q) const {
        const Eigen::Vector2d along = (b - a).head<2>();
        const Eigen::Vector2d from = a.head<2>() - q;
        double low = 0;
        double high = 1;
        const double square = along.squaredNorm();
        if (square > 0) {
            const double half = from.dot(along) / square;
            const double under =
                half * half - (from.squaredNorm() - tool_.radius_mm * tool_.radius_mm) / square;
            if (under < 0) {
                return -std::numeric_limits<double>::infinity();
            }
            low = std::max(0.0, -half - std::sqrt(under));
            high = std::min(1.0, -half + std::sqrt(under));
        } else if (from.norm() > tool_.radius_mm) {
            low = 1;
            high = 0;
        }
        if (low > high) {
            return -std::numeric_limits<double>::infinity();
        }
        return highest_between(low, high, [&](double t) {
            return a.z() + t * (b.z() - a.z()) -
                   tool_.height(std::min(tool_.radius_mm, (from + t * along).norm()));
        });
    }

    const TriMesh& mesh_;
    Outline tool_;
};

/// A tool as the oracle sees it: what cuts, and a stem of the given radius above `flute_mm`.
struct WholeTool {
    Outline cutter;
    double stem_radius_mm = 0;
    double flute_mm = 0;
};

/// Whether a tool lowered along -Z sweeps a point: for the place at which it touches a plane of
/// that normal, or one of some places around (rings, four times as many places on each), tip and
/// stem may stand so low. What it says yes to is so; a no may miss a place between its own.
class SweepOracle {
  public:
    SweepOracle(const TriMesh& mesh, const WholeTool& tool)
        : cutter_(mesh, tool.cutter),
          stem_(mesh, flat_end(tool.stem_radius_mm)),
          flute_mm_(tool.flute_mm) {}

    [[nodiscard]] bool sweeps(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                              int rings) const {
        const double radius = cutter_.tool().radius_mm;
        const double side = normal.head<2>().norm();
        if (side > 0) {
            const double r =
                normal.z() > 0 ? contact_radius(cutter_.tool(), side / normal.z()) : radius;
            if (from(point, point.head<2>() + r / side * normal.head<2>())) {
                return true;
            }
        }
        const int around = 4 * rings;
        for (int ring = 0; ring <= rings; ++ring) {
            for (int k = 0; k < (ring == 0 ? 1 : around); ++k) {
                const double angle = 2 * std::numbers::pi * k / around;
                if (from(point,
                         point.head<2>() + radius * ring / rings *
                                               Eigen::Vector2d(std::cos(angle), std::sin(angle)))) {
                    return true;
                }
            }
        }
        return false;
    }

  private:
    [[nodiscard]] bool from(const Eigen::Vector3d& point, const Eigen::Vector2d& q) const {
        const double r = std::min(cutter_.tool().radius_mm, (q - point.head<2>()).norm());
        const double tip = point.z() - cutter_.tool().height(r);
        return cutter_.stands(q, tip) && stem_.stands(q, tip + flute_mm_);
    }

    DropCutter cutter_;
    DropCutter stem_;
    double flute_mm_;
};

}  // namespace tests
