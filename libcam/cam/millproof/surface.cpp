// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/surface.h"

#include "cam/millproof/solid.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace cam::millproof {

namespace {

/// Surfaces that look up by less than this share of their normal belong to the other side.
constexpr double kUpright = -1e-6;
/// What an upright wall's points are judged by lies this far beside it.
constexpr double kSlackMm = 1e-4;
/// Normals that rise less than this are walls' to the map of reach.
constexpr double kSteep = 0.2;
constexpr double kCellsOut = 1.5;
/// Deeper gouges and higher rests are given as this.
constexpr double kDeepestMm = 20;
/// By how much farther from the surface is looked next.
constexpr double kFarther = 1.3;
constexpr int kBisections = 24;

class Surface {
  public:
    Surface(const MillJob& job, const ProofOptions& options, const std::vector<Step>& steps,
            MillProof& proof)
        : job_(job),
          options_(options),
          steps_(steps),
          proof_(proof),
          envelope_(steps, job),
          reach_(job, options.cell_mm),
          solid_(*job.part) {}

    void run() {
        for (const decomp::mesh::Triangle& t : job_.part->triangles) {
            triangle(job_.part->points[t[0]], job_.part->points[t[1]], job_.part->points[t[2]]);
        }
        sum_up();
    }

  private:
    void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
        const Eigen::Vector3d cross = (b - a).cross(c - a);
        const double area = cross.norm() / 2;
        if (!(area > 0) || cross.z() < kUpright * 2 * area) {
            return;
        }
        const Eigen::Vector3d normal = cross.normalized();
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const int n = std::max(1, static_cast<int>(std::ceil(longest / options_.sample_mm)));
        const auto at = [&](double i, double j) -> Eigen::Vector3d {
            return a + (b - a) * (i / n) + (c - a) * (j / n);
        };
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; i + j <= n; ++j) {
                gouge(at(i, j), normal);
            }
        }
        if (!job_.finished) {
            return;
        }
        const double share = area / (static_cast<double>(n) * n);
        constexpr double kThird = 1.0 / 3;
        for (int i = 0; i < n; ++i) {
            for (int j = 0; i + j < n; ++j) {
                left(at(i + kThird, j + kThird), normal, share);
                if (i + j + 1 < n) {
                    left(at(i + 2 * kThird, j + 2 * kThird), normal, share);
                }
            }
        }
    }

    /// How deep the part was cut at a point of its surface. Looked for along the normal, from the
    /// surface down as far as the tools were; what counts is how deep below the whole surface it
    /// lies there: beside an edge the normal of one face runs along another, or out of it.
    void gouge(const Eigen::Vector3d& at, const Eigen::Vector3d& normal) {
        const auto below = [&](double depth) -> Eigen::Vector3d {
            return at - normal * depth - Eigen::Vector3d(0, 0, kSlackMm);
        };
        const auto cut_at = [&](double depth) { return envelope_.cut_below(below(depth)) >= 0; };
        double deepest = options_.max_gouge_mm;
        std::int64_t step = -1;
        const auto look = [&](double down) {
            const double depth = solid_.depth(below(down), down + kSlackMm);
            if (depth > deepest) {
                deepest = depth;
                step = envelope_.cut_below(below(down));
            }
            return depth > 0;
        };
        double cut = options_.max_gouge_mm;
        if (!cut_at(cut)) {
            return;
        }
        while (cut < kDeepestMm && look(cut)) {
            const double next = std::min(cut * kFarther, kDeepestMm);
            if (!cut_at(next)) {
                look(between(cut, next, cut_at));
                break;
            }
            cut = next;
        }
        if (step < 0) {
            return;
        }
        proof_.figures.max_gouge_mm = std::max(proof_.figures.max_gouge_mm, deepest);
        double& worst = gouged_[steps_[static_cast<std::size_t>(step)].line];
        worst = std::max(worst, deepest);
    }

    /// Where what holds at `yes` and not at `no` ends.
    template <class Holds>
    static double between(double yes, double no, const Holds& holds) {
        for (int i = 0; i < kBisections; ++i) {
            const double middle = (yes + no) / 2;
            (holds(middle) ? yes : no) = middle;
        }
        return yes;
    }

    /// Whether some tool can come down to this point beside the surface.
    [[nodiscard]] bool within_reach(const Eigen::Vector3d& beside,
                                    const Eigen::Vector3d& normal) const {
        if (normal.z() > kSteep) {
            return reach_.level(beside.head<2>()) <= beside.z() + kSlackMm;
        }
        // Beside a wall the map's cells stand on both sides of it: look a little further out.
        const Eigen::Vector2d out = normal.head<2>().normalized() * (kCellsOut * options_.cell_mm);
        return reach_.highest_around(beside.head<2>() + out) <= beside.z() + kSlackMm;
    }

    [[nodiscard]] bool stands_above(const Eigen::Vector3d& at, double top) const {
        return envelope_.over(at.head<2>(), top).z > at.z() + kSlackMm;
    }

    /// What stands on a point, along the normal, and whether a tool could have taken it.
    void left(const Eigen::Vector3d& at, const Eigen::Vector3d& normal, double area) {
        upward_ += area;
        const Eigen::Vector3d beside = at + normal * options_.reach_mm;
        const bool reachable = within_reach(beside, normal);
        const double stock_top = job_.stock.contains(beside) ? job_.stock.max().z() : -1e9;
        const auto excess_above = [&](double e) {
            const Eigen::Vector3d there = at + normal * e;
            return job_.stock.contains(there) && stands_above(there, stock_top) &&
                   !solid_.holds(there);
        };
        double excess = 0;
        if (excess_above(options_.max_excess_mm)) {
            // The first gap ends it: beyond may stand another wall.
            excess = options_.max_excess_mm;
            double high = excess * kFarther;
            while (high < kDeepestMm && excess_above(high)) {
                excess = high;
                high *= kFarther;
            }
            excess = high < kDeepestMm ? between(excess, high, excess_above) : kDeepestMm;
            left_ += area;
        } else {
            const double over = envelope_.over(at.head<2>(), stock_top).z - at.z();
            excess = std::clamp(over * normal.z(), 0.0, options_.max_excess_mm);
        }
        // The map of reach is unsure by two cells beside walls: what is left there by no more is
        // not judged.
        const bool unsure = normal.z() <= kSteep && excess > options_.max_excess_mm &&
                            excess <= options_.max_excess_mm + 2 * options_.cell_mm;
        if (!reachable || unsure) {
            unreachable_ += area;
            return;
        }
        heap_.emplace_back(excess, area);
        if (excess > proof_.figures.max_excess_mm) {
            proof_.figures.max_excess_mm = excess;
            worst_ = at;
        }
    }

    /// The line of the cut that came nearest to what is left: of the stock's map.
    [[nodiscard]] long line_near(const Eigen::Vector3d& at) const {
        const StockMap& map = proof_.stock;
        const auto cell = [&](double v, double low, int count) {
            return std::clamp(static_cast<int>((v - low) / map.cell_mm), 0, count - 1);
        };
        const int column = cell(at.x(), map.origin.x(), map.columns);
        const int row = cell(at.y(), map.origin.y(), map.rows);
        constexpr int kWindow = 40;
        long line = 0;
        int nearest = 2 * kWindow * kWindow;
        for (int y = std::max(0, row - kWindow); y <= std::min(map.rows - 1, row + kWindow); ++y) {
            for (int x = std::max(0, column - kWindow);
                 x <= std::min(map.columns - 1, column + kWindow); ++x) {
                const int there =
                    map.line[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.columns) +
                             static_cast<std::size_t>(x)];
                const int d2 = (x - column) * (x - column) + (y - row) * (y - row);
                if (there > 0 && d2 < nearest) {
                    nearest = d2;
                    line = there;
                }
            }
        }
        return line;
    }

    [[nodiscard]] std::string tool_of(long line) const {
        for (const Step& step : steps_) {
            if (step.line == line && step.tool >= 0) {
                return ", tool " +
                       std::to_string(job_.tools[static_cast<std::size_t>(step.tool)].tool.number);
            }
        }
        return {};
    }

    void sum_up() {
        for (const auto& [line, depth] : gouged_) {
            proof_.faults.push_back(
                {"gouge", line,
                 "cuts " + decomp::decimal(depth, 3) + " mm into the part" + tool_of(line)});
        }
        if (upward_ > 0) {
            proof_.figures.unreachable = unreachable_ / upward_;
            proof_.figures.left = left_ / upward_;
        }
        std::sort(heap_.begin(), heap_.end());
        double reachable = 0;
        for (const auto& [excess, area] : heap_) {
            reachable += area;
        }
        constexpr double kPercentile = 0.999;
        double below = 0;
        for (const auto& [excess, area] : heap_) {
            below += area;
            if (below >= kPercentile * reachable) {
                proof_.figures.excess_999_mm = excess;
                break;
            }
        }
        if (proof_.figures.excess_999_mm > options_.max_excess_mm) {
            const long line = line_near(worst_);
            proof_.faults.push_back({"excess", line,
                                     decomp::decimal(proof_.figures.max_excess_mm, 3) +
                                         " mm left at X " + decomp::decimal(worst_.x(), 2) + " Y " +
                                         decomp::decimal(worst_.y(), 2) + " Z " +
                                         decomp::decimal(worst_.z(), 2) + ", where a tool reaches" +
                                         tool_of(line)});
        }
    }

    const MillJob& job_;
    const ProofOptions& options_;
    const std::vector<Step>& steps_;
    MillProof& proof_;
    Envelope envelope_;
    Reach reach_;
    Solid solid_;
    std::map<long, double> gouged_;
    std::vector<std::pair<double, double>> heap_;  ///< excess and area, reachable
    double upward_ = 0;
    double unreachable_ = 0;
    double left_ = 0;
    Eigen::Vector3d worst_ = Eigen::Vector3d::Zero();
};

}  // namespace

void examine_surface(const MillJob& job, const ProofOptions& options,
                     const std::vector<Step>& steps, MillProof& proof) {
    Surface(job, options, steps, proof).run();
}

}  // namespace cam::millproof
