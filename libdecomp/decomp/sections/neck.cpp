// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/flats.h"
#include "decomp/mesh/moments.h"
#include "decomp/sections/profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace decomp::sections {

namespace {

constexpr double kSameDirection = 0.9998;  // cosine of about 1 degree
constexpr double kLargeFlat = 0.03;        // of the area: what is worth cutting parallel to
constexpr std::size_t kMostFlats = 6;
constexpr double kLeastGain = 1e-9;  // relative: a smaller section by less is rounding

/// A plane by its tilt about two fixed axes and its distance from a fixed pivot.
struct Tilted {
    Eigen::Vector3d pivot, direction, u, v;

    [[nodiscard]] part::Plane plane(const std::array<double, 3>& move) const {
        part::Plane out;
        out.normal = (direction + std::tan(move[0]) * u + std::tan(move[1]) * v).normalized();
        out.offset_mm = out.normal.dot(pivot) + move[2];
        return out;
    }
};

/// Mean of the points in which the plane cuts edges: close enough to the section's centre to tilt
/// about.
Eigen::Vector3d section_centre(const mesh::TriMesh& mesh, const part::Plane& plane) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for (const mesh::Triangle& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Eigen::Vector3d& a = mesh.points[t.at(i)];
            const Eigen::Vector3d& b = mesh.points[t.at((i + 1) % 3)];
            const double at_a = plane.normal.dot(a) - plane.offset_mm;
            const double at_b = plane.normal.dot(b) - plane.offset_mm;
            if ((at_a < 0) != (at_b < 0)) {
                sum += a + at_a / (at_a - at_b) * (b - a);
                count += 1;
            }
        }
    }
    return count > 0 ? Eigen::Vector3d(sum / count)
                     : Eigen::Vector3d(plane.offset_mm * plane.normal);
}

/// Moves a plane, along one parameter at a time, to where its section is smaller.
class PatternSearch {
  public:
    PatternSearch(const mesh::TriMesh& mesh, Tilted tilted, const NeckSearch& limits, double shift)
        : mesh_(mesh),
          tilted_(std::move(tilted)),
          limits_(limits),
          start_shift_(shift),
          best_{0, 0, shift},
          least_(section_area(mesh, tilted_.plane(best_))) {}

    /// Tries a step up and down each parameter and keeps what is better; false where none is.
    bool improve(double tilt_step, double shift_step) {
        bool better = false;
        for (std::size_t k = 0; k < 6; ++k) {
            std::array<double, 3> tried = best_;
            const std::size_t axis = k / 2;
            tried.at(axis) += (k % 2 == 0 ? 1 : -1) * (axis == 2 ? shift_step : tilt_step);
            if (std::hypot(tried[0], tried[1]) > limits_.max_tilt ||
                std::abs(tried[2] - start_shift_) > limits_.max_shift_mm) {
                continue;
            }
            const double area = section_area(mesh_, tilted_.plane(tried));
            if (area > 0 && area < least_ * (1 - kLeastGain)) {
                best_ = tried;
                least_ = area;
                better = true;
            }
        }
        return better;
    }

    [[nodiscard]] part::Plane plane() const { return tilted_.plane(best_); }

  private:
    const mesh::TriMesh& mesh_;
    Tilted tilted_;
    NeckSearch limits_;
    double start_shift_;
    std::array<double, 3> best_;
    double least_;
};

}  // namespace

std::vector<Eigen::Vector3d> directions(const mesh::TriMesh& mesh) {
    std::vector<Eigen::Vector3d> out{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(),
                                     Eigen::Vector3d::UnitY()};
    const auto add = [&](const Eigen::Vector3d& direction) {
        const bool known = std::any_of(out.begin(), out.end(), [&](const Eigen::Vector3d& other) {
            return std::abs(other.dot(direction)) > kSameDirection;
        });
        if (!known) {
            out.push_back(direction);
        }
    };
    const mesh::Moments moments = mesh::moments(mesh);
    for (int i = 0; i < 3; ++i) {
        add(moments.axes.col(i));
    }
    std::size_t flats = 0;
    for (const mesh::Flat& flat : mesh::large_flats(mesh, {.min_share = kLargeFlat})) {
        if (flats++ < kMostFlats) {
            add(flat.normal);
        }
    }
    return out;
}

part::Plane refined_neck(const mesh::TriMesh& mesh, const part::Plane& start,
                         const NeckSearch& search) {
    Tilted tilted;
    tilted.direction = start.normal.normalized();
    const auto basis = plane_basis(tilted.direction);
    tilted.u = basis[0];
    tilted.v = basis[1];
    tilted.pivot = section_centre(mesh, start);
    const double shift = start.offset_mm / start.normal.norm() - tilted.direction.dot(tilted.pivot);
    PatternSearch pattern(mesh, tilted, search, shift);
    double tilt_step = search.max_tilt / 4;
    double shift_step = search.max_shift_mm / 4;
    for (int round = 0; round < search.rounds; ++round) {
        while (pattern.improve(tilt_step, shift_step)) {
        }
        tilt_step /= 2;
        shift_step /= 2;
    }
    return pattern.plane();
}

}  // namespace decomp::sections
