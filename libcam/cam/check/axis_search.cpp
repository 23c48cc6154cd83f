// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/axis_search.h"

#include "cam/check/rotary.h"
#include "decomp/base/parallel.h"
#include "decomp/mesh/flats.h"
#include "decomp/mesh/moments.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

namespace cam::check {

using decomp::Run;
using decomp::mesh::Facets;
using decomp::part::Part;
using visibility::Facing;
using visibility::Sight;

namespace {

constexpr double kSameAxis = 0.02;   // radians: candidates so near are one
constexpr double kStep = 0.02;       // percent: less is not worth a choice
constexpr double kBand = 0.07;       // sine: directions so near to an axis' ring belong to it
constexpr double kSurely = 1e-9;     // a step so little above a whole number is it
constexpr double kFirstTurn = 0.06;  // radians, of the polish
constexpr int kPolishRounds = 4;     // each with half the turn
constexpr double kEndPlane = 1e-3;   // of the length: so near to an end lies in its plane
constexpr std::size_t kWordBits = 64;

/// Directions evenly over the sphere (Fibonacci lattice); the first half is the upper half sphere.
std::vector<Eigen::Vector3d> fibonacci(int count) {
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    std::vector<Eigen::Vector3d> out;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count;
        const double r = std::sqrt(1 - z * z);
        out.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
    }
    return out;
}

/// An axis has no sense: the one with its largest component positive stands for both.
Eigen::Vector3d without_sense(const Eigen::Vector3d& axis) {
    int largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    return axis[largest] < 0 ? Eigen::Vector3d(-axis) : axis;
}

/// Axes of which no two are nearly one, in the order in which they came.
class DistinctAxes {
  public:
    void add(const Eigen::Vector3d& direction) {
        const Eigen::Vector3d axis = without_sense(direction.normalized());
        const bool known = std::any_of(axes_.begin(), axes_.end(), [&](const auto& other) {
            return std::abs(other.dot(axis)) > 1 - kSameAxis * kSameAxis / 2;
        });
        if (!known) {
            axes_.push_back(axis);
        }
    }

    [[nodiscard]] const std::vector<Eigen::Vector3d>& all() const { return axes_; }

  private:
    std::vector<Eigen::Vector3d> axes_;
};

void add_cut_planes(const Part& part, const Facets& facets, DistinctAxes& axes) {
    std::vector<std::int32_t> planes;
    for (std::size_t i = 0; i < part.sources.size(); ++i) {
        if (part.sources[i].is_cut() && facets.area_mm2[i] > 0 &&
            std::find(planes.begin(), planes.end(), part.sources[i].plane) == planes.end()) {
            planes.push_back(part.sources[i].plane);
            axes.add(facets.unit[i]);
        }
    }
}

/// From the middle of a cube to those of its faces and edges, and to its corners.
void add_cube_directions(DistinctAxes& axes) {
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = x == 0 && y == 0 ? 1 : 0; z <= 1; ++z) {
                axes.add(Eigen::Vector3d(x, y, z));
            }
        }
    }
}

std::vector<Eigen::Vector3d> candidate_axes(const Part& part, const Facets& facets, int spread) {
    DistinctAxes axes;
    add_cut_planes(part, facets, axes);
    for (const auto& flat : decomp::mesh::large_flats(part.mesh)) {
        axes.add(flat.normal);
    }
    for (int axis = 0; axis < 3; ++axis) {
        axes.add(Eigen::Vector3d::Unit(axis));
    }
    const Eigen::Matrix3d principal = decomp::mesh::moments(part.mesh).axes;
    for (int axis = 0; axis < 3; ++axis) {
        axes.add(principal.col(axis));
    }
    add_cube_directions(axes);
    for (const Eigen::Vector3d& direction : fibonacci(2 * spread)) {
        if (direction.z() > 0) {
            axes.add(direction);
        }
    }
    return axes.all();
}

/// Facets that stand for equal parts of the surface.
std::vector<std::size_t> spread_facets(const Facets& facets, int count) {
    std::vector<std::size_t> out;
    double sum = 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < facets.area_mm2.size(); ++i) {
        sum += facets.area_mm2[i];
        while (static_cast<int>(next) < count &&
               sum >= (static_cast<double>(next) + 0.5) / count * facets.total_mm2) {
            out.push_back(i);
            ++next;
        }
    }
    return out;
}

/// How a facet lies about an axis.
class Ends {
  public:
    Ends(const Part& part, const Facets& facets, const Eigen::Vector3d& axis)
        : part_(part), facets_(facets), axis_(axis) {
        for (const Eigen::Vector3d& point : part.mesh.points) {
            low_ = std::min(low_, point.dot(axis));
            high_ = std::max(high_, point.dot(axis));
        }
    }

    [[nodiscard]] bool is_end(std::size_t facet) const {
        return std::abs(facets_.unit[facet].dot(axis_)) > kEndCosine;
    }

    /// An end that is a cut face, or lies in the plane in which the part is sawn off.
    [[nodiscard]] bool is_closed(std::size_t facet) const {
        if (!is_end(facet)) {
            return false;
        }
        if (part_.sources[facet].is_cut()) {
            return true;
        }
        const double slack = kEndPlane * (high_ - low_);
        const auto& t = part_.mesh.triangles[facet];
        const auto within = [&](double from, double to) {
            return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
                const double at = part_.mesh.points[v].dot(axis_);
                return at >= from && at <= to;
            });
        };
        return facets_.unit[facet].dot(axis_) > 0 ? within(high_ - slack, high_)
                                                  : within(low_, low_ + slack);
    }

  private:
    const Part& part_;
    const Facets& facets_;
    const Eigen::Vector3d& axis_;
    double low_ = std::numeric_limits<double>::infinity();
    double high_ = -std::numeric_limits<double>::infinity();
};

class Search {
  public:
    Search(const Part& part, const Sight& sight, const AxisOptions& options, const Run& run)
        : part_(part),
          sight_(sight),
          facets_(sight.facets()),
          options_(options),
          run_(run),
          samples_(spread_facets(facets_, options.samples)),
          sphere_(fibonacci(options.directions)),
          words_((sphere_.size() + kWordBits - 1) / kWordBits) {
        look_around();
    }

    /// Percent left by an axis, read from the map.
    [[nodiscard]] double coarse(const Eigen::Vector3d& axis) const {
        std::vector<std::uint64_t> ring(words_, 0);
        for (std::size_t d = 0; d < sphere_.size(); ++d) {
            if (std::abs(sphere_[d].dot(axis)) < kBand) {
                ring[d / kWordBits] |= std::uint64_t{1} << d % kWordBits;
            }
        }
        const Ends ends(part_, facets_, axis);
        int left = 0;
        for (std::size_t s = 0; s < samples_.size(); ++s) {
            bool seen = false;
            for (std::size_t w = 0; w < words_ && !seen; ++w) {
                seen = (map_[s * words_ + w] & ring[w]) != 0;
            }
            left += seen || ends.is_closed(samples_[s]) ? 0 : 1;
        }
        return 100.0 * left / static_cast<double>(std::max<std::size_t>(1, samples_.size()));
    }

    /// The same with all angles.
    [[nodiscard]] double sampled(const Eigen::Vector3d& axis) const {
        const auto directions = tool_directions(axis, options_.angles, 1);
        int left = 0;
        const Ends ends(part_, facets_, axis);
        for (const std::size_t facet : samples_) {
            left += sees_any(facet, directions) || ends.is_closed(facet) ? 0 : 1;
        }
        return 100.0 * left / static_cast<double>(std::max<std::size_t>(1, samples_.size()));
    }

    /// Turns an axis by little, while that leaves less.
    [[nodiscard]] Eigen::Vector3d polished(Eigen::Vector3d axis) const {
        double best = sampled(axis);
        double turn = kFirstTurn;
        for (int round = 0; round < kPolishRounds && best > 0; ++round, turn /= 2) {
            const Eigen::Vector3d up = up_at_zero(axis);
            const Eigen::Vector3d side = up.cross(axis);
            const Eigen::Vector3d start = axis;
            for (int k = 0; k < 8; ++k) {
                const double angle = std::numbers::pi * k / 4;
                const Eigen::Vector3d tried =
                    (start + turn * (std::cos(angle) * up + std::sin(angle) * side)).normalized();
                const double left = sampled(tried);
                if (left < best - kStep) {
                    best = left;
                    axis = tried;
                }
            }
        }
        return axis;
    }

  private:
    void look_around() {
        map_.assign(samples_.size() * words_, 0);
        decomp::for_each_index(run_, samples_.size(), [&](std::size_t s) {
            for (std::size_t d = 0; d < sphere_.size(); ++d) {
                if (sight_.sees(samples_[s], sphere_[d], Facing::Front)) {
                    map_[s * words_ + d / kWordBits] |= std::uint64_t{1} << d % kWordBits;
                }
            }
        });
    }

    [[nodiscard]] bool sees_any(std::size_t facet,
                                const std::vector<Eigen::Vector3d>& directions) const {
        return std::any_of(directions.begin(), directions.end(), [&](const auto& direction) {
            return sight_.sees(facet, direction, Facing::Front);
        });
    }

    const Part& part_;
    const Sight& sight_;
    const Facets& facets_;
    const AxisOptions& options_;
    const Run& run_;
    std::vector<std::size_t> samples_;
    std::vector<Eigen::Vector3d> sphere_;
    std::size_t words_;
    std::vector<std::uint64_t> map_;
};

/// The best `count` of some axes by a figure; equal figures keep their order.
template <class Figure>
std::vector<Eigen::Vector3d> best_of(const std::vector<Eigen::Vector3d>& axes, int count,
                                     const Run& run, Figure figure) {
    std::vector<double> figures(axes.size());
    decomp::for_each_index(run, axes.size(), [&](std::size_t i) { figures[i] = figure(axes[i]); });
    std::vector<std::size_t> order(axes.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return figures[a] < figures[b]; });
    order.resize(std::min(order.size(), static_cast<std::size_t>(count)));
    std::vector<Eigen::Vector3d> out;
    out.reserve(order.size());
    for (const std::size_t i : order) {
        out.push_back(axes[i]);
    }
    return out;
}

double in_steps(const AxisChoice& choice) {
    return std::floor((choice.unseen_percent + choice.open_end_percent) / kStep + kSurely);
}

}  // namespace

std::vector<char> closed_ends(const Part& part, const Facets& facets, const Eigen::Vector3d& axis) {
    const Ends ends(part, facets, axis);
    std::vector<char> closed(facets.unit.size(), 0);
    for (std::size_t i = 0; i < closed.size(); ++i) {
        closed[i] = ends.is_closed(i) ? 1 : 0;
    }
    return closed;
}

AxisChoice measure_axis(const Part& part, const Sight& sight, const Eigen::Vector3d& axis,
                        int angles, const Run& run) {
    const Facets& facets = sight.facets();
    const auto seen = sight.seen_from_any(tool_directions(axis, angles, 1), Facing::Front, run);
    const Ends ends(part, facets, axis);
    double unseen = 0;
    double open = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen[i] == 0 && !ends.is_closed(i)) {
            (ends.is_end(i) ? open : unseen) += facets.area_mm2[i];
        }
    }
    AxisChoice choice;
    choice.axis = axis;
    if (facets.total_mm2 > 0) {
        choice.unseen_percent = 100 * unseen / facets.total_mm2;
        choice.open_end_percent = 100 * open / facets.total_mm2;
    }
    const Cylinder stock = smallest_cylinder(part.mesh, axis);
    choice.stock_mm3 = std::numbers::pi * stock.radius_mm * stock.radius_mm * stock.length_mm;
    return choice;
}

std::vector<AxisChoice> search_axes(const Part& part, const Sight& sight,
                                    const AxisOptions& options, const Run& run) {
    const Search search(part, sight, options, run);
    const auto axes = candidate_axes(part, sight.facets(), options.spread);
    const auto refined = best_of(axes, options.refined, run,
                                 [&](const Eigen::Vector3d& axis) { return search.coarse(axis); });
    std::vector<Eigen::Vector3d> finalists =
        best_of(refined, options.finalists, run,
                [&](const Eigen::Vector3d& axis) { return search.sampled(axis); });
    if (!finalists.empty()) {
        finalists.push_back(search.polished(finalists.front()));
    }
    std::vector<AxisChoice> choices;
    choices.reserve(finalists.size());
    for (const Eigen::Vector3d& axis : finalists) {
        choices.push_back(measure_axis(part, sight, axis, options.angles, run));
    }
    std::stable_sort(choices.begin(), choices.end(), [](const AxisChoice& a, const AxisChoice& b) {
        const double left_a = in_steps(a);
        const double left_b = in_steps(b);
        return left_a != left_b ? left_a < left_b : a.stock_mm3 < b.stock_mm3;
    });
    return choices;
}

}  // namespace cam::check
