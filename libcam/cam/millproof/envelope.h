// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/millproof/program_path.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cam::millproof {

/// What is left standing over a point: the lower envelope of all tools along all cuts, exact.
class Envelope {
  public:
    Envelope(const std::vector<Step>& steps, const MillJob& job);

    struct Top {
        double z = 0;
        std::int64_t step = -1;  ///< that made it; -1: nobody cut here
    };

    /// The height that remains over (x, y): the lowest that any tool's surface came, or
    /// `otherwise`.
    [[nodiscard]] Top over(const Eigen::Vector2d& at, double otherwise) const;

    /// Whether any tool came lower than z over a point, and which step did so first.
    [[nodiscard]] std::int64_t cut_below(const Eigen::Vector3d& at) const;

  private:
    struct Bucket {
        std::vector<std::uint32_t> steps;  ///< by their lowest z
    };

    void enter(std::size_t index);
    [[nodiscard]] const Bucket* bucket(const Eigen::Vector2d& at) const;
    [[nodiscard]] double lowest(const Step& step, const Eigen::Vector2d& at, double below) const;

    const std::vector<Step>& steps_;
    const MillJob& job_;
    Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
    int columns_ = 0;
    int rows_ = 0;
    std::vector<Bucket> buckets_;
};

}  // namespace cam::millproof
