// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/lbfgs_detail.h"

#include <array>
#include <cmath>

namespace decomp::map {

namespace {

constexpr std::size_t kPairs = 10;
constexpr int kHalvings = 25;
constexpr double kArmijo = 1e-4;
constexpr double kLeastCurvature = 1e-14;
constexpr double kLeastGradient = 1e-12;

/// The last ten steps and changes of the gradient, oldest first from `begin`.
class Memory {
  public:
    [[nodiscard]] bool empty() const { return count_ == 0; }

    void clear() { count_ = 0; }

    void push(const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
        const double curvature = step.dot(change);
        if (!(curvature > kLeastCurvature)) {
            return;
        }
        const std::size_t slot = (begin_ + count_) % kPairs;
        steps_.at(slot) = step;
        changes_.at(slot) = change;
        inverse_.at(slot) = 1 / curvature;
        if (count_ < kPairs) {
            ++count_;
        } else {
            begin_ = (begin_ + 1) % kPairs;
        }
    }

    /// q becomes H q, H the approximate inverse Hessian (two-loop recursion).
    void apply(Eigen::VectorXd& q) const {
        std::array<double, kPairs> alpha{};
        for (std::size_t n = count_; n-- > 0;) {
            const std::size_t i = (begin_ + n) % kPairs;
            alpha.at(i) = inverse_.at(i) * steps_.at(i).dot(q);
            q -= alpha.at(i) * changes_.at(i);
        }
        const std::size_t last = (begin_ + count_ - 1) % kPairs;
        q *= 1 / (inverse_.at(last) * changes_.at(last).squaredNorm());
        for (std::size_t n = 0; n < count_; ++n) {
            const std::size_t i = (begin_ + n) % kPairs;
            q += (alpha.at(i) - inverse_.at(i) * changes_.at(i).dot(q)) * steps_.at(i);
        }
    }

  private:
    std::array<Eigen::VectorXd, kPairs> steps_;
    std::array<Eigen::VectorXd, kPairs> changes_;
    std::array<double, kPairs> inverse_{};
    std::size_t begin_ = 0;
    std::size_t count_ = 0;
};

}  // namespace

LbfgsResult minimise(Eigen::VectorXd& x, const Function& function, const LbfgsOptions& options) {
    LbfgsResult result;
    Eigen::VectorXd gradient;
    Eigen::VectorXd next_gradient;
    Eigen::VectorXd next;
    Eigen::VectorXd direction;
    result.value = function(x, gradient);
    result.evaluations = 1;
    Memory memory;
    for (; result.iterations < options.iterations; ++result.iterations) {
        direction = gradient;
        const double steepest = options.first_step / std::max(kLeastGradient, gradient.norm());
        if (memory.empty()) {
            direction *= steepest;
        } else {
            memory.apply(direction);
            if (!(gradient.dot(direction) > 0)) {
                memory.clear();
                direction = gradient * steepest;
            }
        }
        const double slope = -gradient.dot(direction);
        double length = 1;
        double value = 0;
        int halvings = 0;
        for (; halvings < kHalvings; ++halvings, length /= 2) {
            next = x - length * direction;
            value = function(next, next_gradient);
            ++result.evaluations;
            if (std::isfinite(value) && value <= result.value + kArmijo * length * slope) {
                break;
            }
        }
        if (halvings == kHalvings) {
            break;
        }
        memory.push(next - x, next_gradient - gradient);
        const double gain = result.value - value;
        x.swap(next);
        gradient.swap(next_gradient);
        result.value = value;
        if (gain < options.least_gain * std::abs(value)) {
            ++result.iterations;
            break;
        }
    }
    return result;
}

}  // namespace decomp::map
