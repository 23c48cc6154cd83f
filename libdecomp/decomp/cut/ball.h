// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace decomp::cut {

/// An unevaluated sum of two doubles with a bound on its distance from the true value: about 100
/// bits, enough to settle nearly every predicate that doubles leave open. Sums and products after
/// Dekker (1971) and Knuth; the bounds are wider than theirs by a factor of four or more.
class Ball {
  public:
    Ball() = default;

    explicit Ball(double value) : high_(value) {}

    [[nodiscard]] double high() const { return high_; }

    /// True when the value rounds to high() whatever it is within its bound.
    [[nodiscard]] bool rounds_to_high() const {
        return high_ + (low_ + 2 * error_) == high_ && high_ + (low_ - 2 * error_) == high_;
    }

    /// -1 or +1, or 0 when the bound reaches zero.
    [[nodiscard]] int sign() const {
        if (std::abs(high_) > 2 * (std::abs(low_) + error_)) {  // false for NaN, after an overflow
            return high_ > 0 ? 1 : -1;
        }
        return 0;
    }

    friend Ball operator+(const Ball& a, const Ball& b) {
        const double sum = a.high_ + b.high_;
        const double part = sum - a.high_;
        const double rest = (a.high_ - (sum - part)) + (b.high_ - part);
        return normal(sum, rest + (a.low_ + b.low_),
                      a.error_ + b.error_ + kUnit * (std::abs(a.high_) + std::abs(b.high_)));
    }

    friend Ball operator-(const Ball& a) {
        Ball out;
        out.high_ = -a.high_;
        out.low_ = -a.low_;
        out.error_ = a.error_;
        return out;
    }

    friend Ball operator-(const Ball& a, const Ball& b) { return a + -b; }

    friend Ball operator*(const Ball& a, const Ball& b) {
        const double product = a.high_ * b.high_;
        const double rest =
            std::fma(a.high_, b.high_, -product) + (a.high_ * b.low_ + a.low_ * b.high_);
        const double size_a = std::abs(a.high_);
        const double size_b = std::abs(b.high_);
        return normal(product, rest,
                      2 * (size_a * b.error_ + size_b * a.error_) + a.error_ * b.error_ +
                          kUnit * size_a * size_b + kTiny);
    }

    /// The bound is infinite when the divisor may be zero.
    friend Ball operator/(const Ball& a, const Ball& b) {
        if (b.sign() == 0) {
            Ball out;
            out.error_ = HUGE_VAL;
            return out;
        }
        const double first = a.high_ / b.high_;
        const Ball exact_b = b.without_error();
        const Ball rest = a.without_error() - Ball(first) * exact_b;
        const double second = rest.high_ / b.high_;
        const double third = (rest - Ball(second) * exact_b).high_ / b.high_;
        const double size = std::abs(first);
        return normal(
            first, second + third,
            2 * (a.error_ + size * b.error_) / std::abs(b.high_) + 4 * kUnit * size + kTiny);
    }

    Ball& operator+=(const Ball& other) { return *this = *this + other; }

  private:
    static constexpr double kUnit = 0x1p-98;
    static constexpr double kTiny = 0x1p-1000;  ///< where products lose bits to underflow

    static Ball normal(double high, double low, double error) {
        Ball out;
        out.high_ = high + low;
        out.low_ = low - (out.high_ - high);
        out.error_ = error;
        return out;
    }

    [[nodiscard]] Ball without_error() const {
        Ball out = *this;
        out.error_ = 0;
        return out;
    }

    double high_ = 0;
    double low_ = 0;
    double error_ = 0;
};

}  // namespace decomp::cut
