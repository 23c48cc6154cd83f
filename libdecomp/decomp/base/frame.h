// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstddef>

namespace decomp {

/// Frames are empty tags; docs/frames.md has the drawing. All are right-handed, millimetres, Z up.
struct ModelFrame {};  ///< the input shape after units, --up and --height; every part lives here

struct PartBedFrame {
};  ///< one part as it is printed: base at z = 0, bounding box centred on x = y = 0

struct SetupFrame {
};  ///< one part as it is clamped to turn: rotary axis through the origin along X, Z up at A = 0

struct BedFrame {};  ///< one plate: the machine's own coordinates, z = 0 on the plate

/// A rigid motion that carries points of From into To. `Pose<A, B> * Pose<B, C>` composes; other
/// pairs do not compile.
template <class To, class From>
class Pose {
  public:
    Pose() : map_(Eigen::Isometry3d::Identity()) {}

    // Of fixed size: moving it would be copying it.
    // NOLINTNEXTLINE(modernize-pass-by-value)
    explicit Pose(const Eigen::Isometry3d& map) : map_(map) {}

    [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
        return map_ * point;
    }

    [[nodiscard]] Eigen::Vector3d turn(const Eigen::Vector3d& direction) const {
        return map_.linear() * direction;
    }

    [[nodiscard]] Pose<From, To> inverse() const { return Pose<From, To>(map_.inverse()); }

    [[nodiscard]] const Eigen::Isometry3d& map() const { return map_; }

    /// 16 numbers, row-major, as written in job.json.
    [[nodiscard]] std::array<double, 16> row_major() const {
        std::array<double, 16> out{};
        std::size_t next = 0;
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) {
                out.at(next++) = map_.matrix()(row, column);
            }
        }
        return out;
    }

    [[nodiscard]] static Pose from_row_major(const std::array<double, 16>& values) {
        Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
        std::size_t next = 0;
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) {
                map.matrix()(row, column) = values.at(next++);
            }
        }
        return Pose(map);
    }

  private:
    Eigen::Isometry3d map_;
};

template <class A, class B, class C>
[[nodiscard]] Pose<A, C> operator*(const Pose<A, B>& a_from_b, const Pose<B, C>& b_from_c) {
    return Pose<A, C>(a_from_b.map() * b_from_c.map());
}

}  // namespace decomp
