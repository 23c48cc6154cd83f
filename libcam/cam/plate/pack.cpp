// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/plate/pack.h"

#include "cam/profile/bed_area.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace cam::plate {

using decomp::fail;
using decomp::Result;
using Eigen::Vector2d;

namespace {

/// Sixteen directions; direction j + 8 is opposite to j.
constexpr std::size_t kDirections = 16;
constexpr double kSlackMm = 1e-6;

const std::array<Vector2d, kDirections>& directions() {
    static const std::array<Vector2d, kDirections> table = [] {
        std::array<Vector2d, kDirections> out;
        for (std::size_t j = 0; j < kDirections; ++j) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(j) / kDirections;
            out.at(j) = {std::cos(angle), std::sin(angle)};
        }
        out[0] = {1, 0};
        out[4] = {0, 1};
        out[8] = {-1, 0};
        out[12] = {0, -1};
        return out;
    }();
    return table;
}

/// How far an outline reaches in each direction. Two outlines are apart when they are so along one
/// of them; the reverse need not hold, which wastes a little room but never lets parts touch.
struct Reach {
    std::array<double, kDirections> along{};

    explicit Reach(const std::vector<Vector2d>& outline) {
        for (std::size_t j = 0; j < kDirections; ++j) {
            double most = -std::numeric_limits<double>::infinity();
            for (const Vector2d& point : outline) {
                most = std::max(most, directions().at(j).dot(point));
            }
            along.at(j) = most;
        }
    }

    [[nodiscard]] Vector2d low() const { return {-along[8], -along[12]}; }

    [[nodiscard]] Vector2d high() const { return {along[0], along[4]}; }
};

struct Placed {
    std::size_t part;
    Vector2d offset;
};

class Plate {
  public:
    Plate(profile::BedArea area, double spacing_mm, const std::vector<Reach>& reaches)
        : area_(std::move(area)), spacing_mm_(spacing_mm), reaches_(reaches) {}

    /// The lowest, then leftmost free place among those where the part touches two things. Places
    /// it there.
    bool place(std::size_t part) {
        const Reach& reach = reaches_[part];
        const Vector2d low = area_.min_mm - reach.low();
        const Vector2d high = area_.max_mm - reach.high();
        std::vector<Obstacle> obstacles = {wall(low, high)};
        for (const Placed& other : placed_) {
            obstacles.push_back(obstacle(other, reach));
        }
        std::optional<Vector2d> best;
        const auto consider = [&](const Vector2d& offset) {
            if (inside(offset, low, high) && (!best || lower(offset, *best)) &&
                free(offset, obstacles)) {
                best = offset;
            }
        };
        for (std::size_t i = 0; i < obstacles.size(); ++i) {
            for (std::size_t j = 0; j < kDirections; ++j) {
                consider(crossing(obstacles[i], j, obstacles[i], (j + 1) % kDirections));
            }
            for (std::size_t k = 0; k < i; ++k) {
                meetings(obstacles[i], obstacles[k], consider);
            }
        }
        if (best) {
            placed_.push_back({part, *best});
        }
        return best.has_value();
    }

    /// The parts of the plate moved together so that their box lies in the middle of the area.
    [[nodiscard]] std::vector<Placed> centred() const {
        Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
        Vector2d high = -low;
        for (const Placed& placed : placed_) {
            low = low.cwiseMin(placed.offset + reaches_[placed.part].low());
            high = high.cwiseMax(placed.offset + reaches_[placed.part].high());
        }
        const Vector2d shift = (area_.min_mm + area_.max_mm - low - high) / 2;
        std::vector<Placed> out = placed_;
        for (Placed& placed : out) {
            placed.offset += shift;
        }
        return out;
    }

  private:
    /// The offsets at which the part would come too near to a placed one: directions[j] . offset <
    /// until[j] for every j, a convex polygon. The first obstacle is the room itself, whose inside
    /// is free.
    struct Obstacle {
        std::array<double, kDirections> until{};

        /// Whether a point on the line of side j belongs to that side.
        [[nodiscard]] bool on_side(std::size_t j, const Vector2d& point) const {
            const std::size_t before = (j + kDirections - 1) % kDirections;
            const std::size_t after = (j + 1) % kDirections;
            return directions().at(before).dot(point) <= until.at(before) + kSlackMm &&
                   directions().at(after).dot(point) <= until.at(after) + kSlackMm;
        }
    };

    [[nodiscard]] static Obstacle wall(const Vector2d& low, const Vector2d& high) {
        const Reach corners({low, {high.x(), low.y()}, high, {low.x(), high.y()}});
        return {corners.along};
    }

    [[nodiscard]] Obstacle obstacle(const Placed& other, const Reach& reach) const {
        Obstacle out;
        for (std::size_t j = 0; j < kDirections; ++j) {
            out.until.at(j) = directions().at(j).dot(other.offset) +
                              reaches_[other.part].along.at(j) +
                              reach.along.at((j + kDirections / 2) % kDirections) + spacing_mm_;
        }
        return out;
    }

    /// Where the lines of two sides cross; they must not be parallel.
    [[nodiscard]] static Vector2d crossing(const Obstacle& a, std::size_t i, const Obstacle& b,
                                           std::size_t j) {
        const Vector2d& m = directions().at(i);
        const Vector2d& n = directions().at(j);
        const double turn = m.x() * n.y() - m.y() * n.x();
        return {(a.until.at(i) * n.y() - b.until.at(j) * m.y()) / turn,
                (m.x() * b.until.at(j) - n.x() * a.until.at(i)) / turn};
    }

    /// Calls `found` with the points where the outlines of two obstacles cross.
    template <class Found>
    static void meetings(const Obstacle& a, const Obstacle& b, const Found& found) {
        for (std::size_t j = 0; j < kDirections / 2; ++j) {
            if (a.until.at(j) < -b.until.at(j + kDirections / 2) ||
                b.until.at(j) < -a.until.at(j + kDirections / 2)) {
                return;  // apart
            }
        }
        for (std::size_t i = 0; i < kDirections; ++i) {
            for (std::size_t j = 0; j < kDirections; ++j) {
                if (i % (kDirections / 2) == j % (kDirections / 2)) {
                    continue;
                }
                const Vector2d point = crossing(a, i, b, j);
                if (a.on_side(i, point) && b.on_side(j, point)) {
                    found(point);
                }
            }
        }
    }

    [[nodiscard]] static bool inside(const Vector2d& offset, const Vector2d& low,
                                     const Vector2d& high) {
        return (offset - low).minCoeff() >= -kSlackMm && (high - offset).minCoeff() >= -kSlackMm;
    }

    [[nodiscard]] static bool lower(const Vector2d& a, const Vector2d& b) {
        return a.y() < b.y() - kSlackMm || (a.y() < b.y() + kSlackMm && a.x() < b.x() - kSlackMm);
    }

    /// Outside every obstacle but the room.
    [[nodiscard]] static bool free(const Vector2d& offset, const std::vector<Obstacle>& obstacles) {
        return std::all_of(obstacles.begin() + 1, obstacles.end(), [&](const Obstacle& obstacle) {
            for (std::size_t j = 0; j < kDirections; ++j) {
                if (directions().at(j).dot(offset) >= obstacle.until.at(j) - kSlackMm) {
                    return true;
                }
            }
            return false;
        });
    }

    profile::BedArea area_;
    double spacing_mm_;
    const std::vector<Reach>& reaches_;
    std::vector<Placed> placed_;
};

/// First fit: every part goes on the first plate that has room for it.
std::vector<Plate> first_fit(const std::vector<std::size_t>& order, const Plate& empty) {
    std::vector<Plate> plates;
    for (const std::size_t part : order) {
        const bool found = std::any_of(plates.begin(), plates.end(),
                                       [&](Plate& plate) { return plate.place(part); });
        if (!found) {
            plates.push_back(empty);
            plates.back().place(part);
        }
    }
    return plates;
}

decomp::Status check_sizes(const std::vector<Footprint>& parts, const std::vector<Reach>& reaches,
                           const profile::BedArea& area) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Vector2d size = reaches[i].high() - reaches[i].low();
        const Vector2d room = area.size_mm();
        const bool fits = (room - size).minCoeff() >= -kSlackMm &&
                          parts[i].height_mm <= area.height_mm + kSlackMm;
        if (!fits) {
            return fail("plate.part_too_large",
                        "the part needs " + decomp::decimal(size.x(), 2) + " x " +
                            decomp::decimal(size.y(), 2) + " x " +
                            decomp::decimal(parts[i].height_mm, 2) + " mm, the bed has " +
                            decomp::decimal(room.x(), 2) + " x " + decomp::decimal(room.y(), 2) +
                            " x " + decomp::decimal(area.height_mm, 2) +
                            " mm less margin and skirt",
                        parts[i].id, "cut it further, or use less brim or skirt");
        }
    }
    return {};
}

}  // namespace

Result<std::vector<Placement>> pack(const std::vector<Footprint>& parts,
                                    const profile::FdmMachine& machine) {
    const profile::BedArea area = profile::bed_area(machine);
    std::vector<Reach> reaches;
    for (const Footprint& part : parts) {
        if (part.outline.empty()) {
            return fail("plate.no_outline", "the part has no outline", part.id);
        }
        reaches.emplace_back(part.outline);
    }
    if (const decomp::Status fits = check_sizes(parts, reaches, area); !fits) {
        return fail(fits.error());
    }
    // Which order packs best depends on the parts: try those that usually do well, and keep the
    // first of the best.
    const std::vector<std::function<double(const Vector2d&)>> measures = {
        [](const Vector2d& size) { return size.x() * size.y(); },
        [](const Vector2d& size) { return size.y(); },
        [](const Vector2d& size) { return size.maxCoeff(); },
        [](const Vector2d& size) { return size.sum(); },
    };
    const Plate empty(area, machine.process.part_spacing_mm, reaches);
    std::vector<Plate> best;
    for (const auto& measure : measures) {
        std::vector<std::size_t> order(parts.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return measure(reaches[a].high() - reaches[a].low()) >
                   measure(reaches[b].high() - reaches[b].low());
        });
        std::vector<Plate> plates = first_fit(order, empty);
        if (best.empty() || plates.size() < best.size()) {
            best = std::move(plates);
        }
    }
    std::vector<Placement> out(parts.size());
    for (std::size_t plate = 0; plate < best.size(); ++plate) {
        for (const Placed& placed : best[plate].centred()) {
            out[placed.part] = {placed.part, static_cast<int>(plate), placed.offset};
        }
    }
    return out;
}

}  // namespace cam::plate
