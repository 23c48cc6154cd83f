// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/order.h"

#include <algorithm>

namespace cam::mill {

namespace {

using Eigen::Vector2d;

constexpr std::size_t kWindow = 60;  // stretches that 2-opt turns at once
constexpr int kRounds = 6;           // over all stretches
constexpr double kGain = 1e-9;       // mm: less is rounding

Vector2d entry(const std::vector<Stretch>& stretches, const Turn& turn) {
    return turn.backwards ? stretches[turn.index].last : stretches[turn.index].first;
}

Vector2d leaving(const std::vector<Stretch>& stretches, const Turn& turn) {
    return turn.backwards ? stretches[turn.index].first : stretches[turn.index].last;
}

}  // namespace

std::vector<Turn> short_order(const std::vector<Stretch>& stretches, const Vector2d& start) {
    std::vector<Turn> order;
    std::vector<char> used(stretches.size(), 0);
    Vector2d at = start;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
        Turn best;
        double nearest = -1;
        for (std::size_t i = 0; i < stretches.size(); ++i) {
            for (const bool backwards : {false, true}) {
                const double away =
                    used[i] != 0
                        ? -1
                        : ((backwards ? stretches[i].last : stretches[i].first) - at).squaredNorm();
                if (away >= 0 && (nearest < 0 || away < nearest)) {
                    nearest = away;
                    best = {i, backwards};
                }
            }
        }
        used[best.index] = 1;
        order.push_back(best);
        at = leaving(stretches, best);
    }
    // 2-opt: the stretches i ... j in reverse, each turned round.
    for (int round = 0; round < kRounds; ++round) {
        bool better = false;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Vector2d before = i == 0 ? start : leaving(stretches, order[i - 1]);
            for (std::size_t j = i + 1; j < std::min(order.size(), i + kWindow); ++j) {
                const Vector2d in = entry(stretches, order[i]);
                const Vector2d out = leaving(stretches, order[j]);
                double gain = (before - in).norm() - (before - out).norm();
                if (j + 1 < order.size()) {
                    const Vector2d after = entry(stretches, order[j + 1]);
                    gain += (out - after).norm() - (in - after).norm();
                }
                if (gain > kGain) {
                    std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i),
                                 order.begin() + static_cast<std::ptrdiff_t>(j) + 1);
                    for (std::size_t k = i; k <= j; ++k) {
                        order[k].backwards = !order[k].backwards;
                    }
                    better = true;
                }
            }
        }
        if (!better) {
            break;
        }
    }
    return order;
}

}  // namespace cam::mill
