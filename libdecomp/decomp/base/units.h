// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <numbers>

/// Inside: millimetres, radians, seconds, mm/s, degrees Celsius. A type where two units live, a
/// suffix where one does.
namespace decomp {

/// An angle that never wraps: 720 degrees is not 0.
class Angle {
  public:
    constexpr Angle() = default;

    [[nodiscard]] static constexpr Angle degrees(double value) {
        return Angle(value * std::numbers::pi / 180.0);
    }

    [[nodiscard]] static constexpr Angle radians(double value) { return Angle(value); }

    [[nodiscard]] constexpr double degrees() const { return radians_ * 180.0 / std::numbers::pi; }

    [[nodiscard]] constexpr double radians() const { return radians_; }

    constexpr auto operator<=>(const Angle&) const = default;

  private:
    constexpr explicit Angle(double value) : radians_(value) {}

    double radians_ = 0;
};

/// A speed along a path.
class Speed {
  public:
    constexpr Speed() = default;

    [[nodiscard]] static constexpr Speed mm_per_s(double value) { return Speed(value); }

    [[nodiscard]] static constexpr Speed mm_per_min(double value) { return Speed(value / 60.0); }

    [[nodiscard]] constexpr double mm_per_s() const { return mm_per_s_; }

    [[nodiscard]] constexpr double mm_per_min() const { return mm_per_s_ * 60.0; }

    constexpr auto operator<=>(const Speed&) const = default;

  private:
    constexpr explicit Speed(double value) : mm_per_s_(value) {}

    double mm_per_s_ = 0;
};

}  // namespace decomp
