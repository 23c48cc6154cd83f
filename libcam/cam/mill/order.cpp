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

/// The unused stretch that begins, from either end, nearest to a place.
Turn nearest_turn(const std::vector<Stretch>& stretches, const std::vector<char>& used,
                  const Vector2d& at) {
    Turn best;
    double nearest = -1;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        if (used[i] != 0) {
            continue;
        }
        for (const bool backwards : {false, true}) {
            const double away = (entry(stretches, {i, backwards}) - at).squaredNorm();
            if (nearest < 0 || away < nearest) {
                nearest = away;
                best = {i, backwards};
            }
        }
    }
    return best;
}

std::vector<Turn> nearest_neighbours(const std::vector<Stretch>& stretches, const Vector2d& start) {
    std::vector<Turn> order;
    order.reserve(stretches.size());
    std::vector<char> used(stretches.size(), 0);
    Vector2d at = start;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
        const Turn best = nearest_turn(stretches, used, at);
        used[best.index] = 1;
        order.push_back(best);
        at = leaving(stretches, best);
    }
    return order;
}

/// The stretches i ... j of an order in reverse, each turned round.
void turn_round(std::vector<Turn>& order, std::size_t i, std::size_t j) {
    std::reverse(order.begin() + static_cast<std::ptrdiff_t>(i),
                 order.begin() + static_cast<std::ptrdiff_t>(j) + 1);
    for (std::size_t k = i; k <= j; ++k) {
        order[k].backwards = !order[k].backwards;
    }
}

/// One round of 2-opt; false: nothing got shorter.
bool two_opt_round(const std::vector<Stretch>& stretches, const Vector2d& start,
                   std::vector<Turn>& order) {
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
                turn_round(order, i, j);
                better = true;
            }
        }
    }
    return better;
}

}  // namespace

std::vector<Turn> short_order(const std::vector<Stretch>& stretches, const Vector2d& start) {
    std::vector<Turn> order = nearest_neighbours(stretches, start);
    for (int round = 0; round < kRounds; ++round) {
        if (!two_opt_round(stretches, start, order)) {
            break;
        }
    }
    return order;
}

}  // namespace cam::mill
