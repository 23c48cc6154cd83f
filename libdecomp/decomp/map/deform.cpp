// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/deform.h"

#include "decomp/map/energy_detail.h"
#include "decomp/map/lbfgs_detail.h"
#include "decomp/mesh/measure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace decomp::map {

namespace {

constexpr double kFirstRounding = 0.1;  // of |n|: sqrt(n^2 + rounding^2); halves per stage
constexpr double kLeastRounding = 2e-3;
constexpr double kBendRounding = 1e-2;  // squared
constexpr double kFirstStep = 1e-3;     // of the square root of the area
constexpr double kLeastArea = 1e-14;    // of the whole area

/// Two triangles that share an edge.
struct Bend {
    std::array<std::uint32_t, 2> triangles{};
    double share = 0;  ///< of the length of all edges
};

std::vector<Bend> bends_of(const mesh::TriMesh& surface) {
    struct Side {
        std::array<std::uint32_t, 2> edge{};
        std::uint32_t triangle = 0;

        // clang-tidy 14 takes the 0 inside a defaulted comparison for a null pointer.
        // NOLINTNEXTLINE(modernize-use-nullptr)
        auto operator<=>(const Side&) const = default;
    };

    std::vector<Side> sides;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = surface.triangles[t].at(k);
            const std::uint32_t b = surface.triangles[t].at((k + 1) % 3);
            sides.push_back({{std::min(a, b), std::max(a, b)}, t});
        }
    }
    std::sort(sides.begin(), sides.end());
    std::vector<Bend> bends;
    double total = 0;
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        if (sides[i].edge == sides[i + 1].edge) {
            const auto [a, b] = sides[i].edge;
            const double length = (surface.points[a] - surface.points[b]).norm();
            bends.push_back({{sides[i].triangle, sides[i + 1].triangle}, length});
            total += length;
            ++i;
        }
    }
    for (Bend& bend : bends) {
        bend.share /= total;
    }
    return bends;
}

/// The surface's part of the energy: normals off the axes, and bends.
class NormalEnergy {
  public:
    explicit NormalEnergy(const mesh::TriMesh& surface)
        : triangles_(surface.triangles), bends_(bends_of(surface)) {
        area_ = mesh::area_mm2(surface);
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            shares_.push_back(mesh::double_area_normal(surface, t).norm() / 2 / area_);
        }
    }

    [[nodiscard]] double area() const { return area_; }

    /// Adds to the gradient at x (three numbers a point); returns the energy.
    double add(const Eigen::VectorXd& x, double pull, double smoothing, double rounding,
               Eigen::VectorXd& gradient) {
        const std::size_t count = triangles_.size();
        normals_.resize(count);
        lengths_.resize(count);
        slopes_.resize(count);
        double energy = 0;
        for (std::size_t t = 0; t < count; ++t) {
            const Eigen::Vector3d cross = edge(x, t, 0, 1).cross(edge(x, t, 0, 2));
            lengths_[t] = std::max(kLeastArea * area_, cross.norm());
            normals_[t] = cross / lengths_[t];
            const Eigen::Array3d roots =
                (normals_[t].array().square() + rounding * rounding).sqrt();
            energy += pull * shares_[t] * roots.sum();
            slopes_[t] = pull * shares_[t] * (normals_[t].array() / roots).matrix();
        }
        for (const Bend& bend : bends_) {
            const auto [a, b] = bend.triangles;
            const Eigen::Vector3d difference = normals_[a] - normals_[b];
            const double root = std::sqrt(difference.squaredNorm() + kBendRounding);
            const double weight = smoothing * pull * bend.share;
            energy += weight * root;
            slopes_[a] += weight / root * difference;
            slopes_[b] -= weight / root * difference;
        }
        for (std::size_t t = 0; t < count; ++t) {
            const Eigen::Vector3d push =
                (slopes_[t] - normals_[t] * normals_[t].dot(slopes_[t])) / lengths_[t];
            const auto at = [&](std::size_t corner) -> Eigen::Ref<Eigen::Vector3d> {
                return gradient.segment<3>(3 * Eigen::Index{triangles_[t].at(corner)});
            };
            at(0) += edge(x, t, 2, 1).cross(push);
            at(1) += edge(x, t, 0, 2).cross(push);
            at(2) += edge(x, t, 1, 0).cross(push);
        }
        return energy;
    }

    /// Unit normals at x.
    [[nodiscard]] std::vector<Eigen::Vector3d> normals(const Eigen::VectorXd& x) const {
        std::vector<Eigen::Vector3d> out;
        out.reserve(triangles_.size());
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            out.push_back(edge(x, t, 0, 1).cross(edge(x, t, 0, 2)).normalized());
        }
        return out;
    }

  private:
    [[nodiscard]] Eigen::Vector3d edge(const Eigen::VectorXd& x, std::size_t t, std::size_t from,
                                       std::size_t to) const {
        return x.segment<3>(3 * Eigen::Index{triangles_[t].at(to)}) -
               x.segment<3>(3 * Eigen::Index{triangles_[t].at(from)});
    }

    std::vector<mesh::Triangle> triangles_;
    std::vector<Bend> bends_;
    std::vector<double> shares_;
    double area_ = 0;
    std::vector<Eigen::Vector3d> normals_;
    std::vector<Eigen::Vector3d> slopes_;
    std::vector<double> lengths_;
};

}  // namespace

std::vector<Eigen::Vector3d> deformed_normals(const tets::TetMesh& tets,
                                              const mesh::TriMesh& surface,
                                              const DeformOptions& options, const Run& run) {
    std::vector<TetUnknowns> unknowns(tets.tets.size());
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        for (std::size_t k = 0; k < 4; ++k) {
            for (std::uint32_t d = 0; d < 3; ++d) {
                unknowns[t].at(3 * k + d) = 3 * tets.tets[t].at(k) + d;
            }
        }
    }
    const FoldoverEnergy rigidity(tets.points, tets.tets, unknowns);
    NormalEnergy normals(surface);
    Eigen::VectorXd x(3 * static_cast<Eigen::Index>(tets.points.size()));
    for (std::size_t p = 0; p < tets.points.size(); ++p) {
        x.segment<3>(3 * static_cast<Eigen::Index>(p)) = tets.points[p];
    }
    for (int stage = 0; stage < options.stages && !run.cancelled(); ++stage) {
        const double pull = options.pull * std::ldexp(1.0, stage + 1 - options.stages);
        const double rounding = std::max(kLeastRounding, std::ldexp(kFirstRounding, -stage));
        LbfgsOptions lbfgs;
        lbfgs.iterations = options.iterations;
        lbfgs.first_step = kFirstStep * std::sqrt(normals.area());
        minimise(
            x,
            [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
                const double rigid = rigidity(at, 0, gradient);
                return std::isfinite(rigid)
                           ? rigid + normals.add(at, pull, options.smoothing, rounding, gradient)
                           : rigid;
            },
            lbfgs);
    }
    return normals.normals(x);
}

}  // namespace decomp::map
