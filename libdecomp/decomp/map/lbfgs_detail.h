// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <functional>

namespace decomp::map {

/// Value at x; writes the gradient. Infinite where x is not allowed.
using Function = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)>;

struct LbfgsOptions {
    int iterations = 200;
    double least_gain = 1e-6;  ///< stops below this share of the value in one iteration
    double first_step = 1e-2;  ///< length of the first step
};

struct LbfgsResult {
    double value = 0;
    int iterations = 0;
    int evaluations = 0;
};

/// Minimises by limited-memory BFGS (Nocedal 1980; ten pairs) with backtracking (Armijo). x must be
/// allowed; it holds the best point at the end. Counted, serial, deterministic.
LbfgsResult minimise(Eigen::VectorXd& x, const Function& function, const LbfgsOptions& options);

}  // namespace decomp::map
