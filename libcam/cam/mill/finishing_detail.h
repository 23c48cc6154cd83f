// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/check/height_map.h"
#include "cam/mill/finish.h"
#include "cam/mill/maps.h"
#include "cam/mill/tip.h"
#include "cam/mill/trace.h"
#include "cam/mill/work.h"

#include <Eigen/Geometry>

#include <optional>
#include <utility>
#include <vector>

namespace cam::mill {

inline constexpr double kAboveCut = 1.0;  // mm over what is there before a tool slows down
inline constexpr double kOnFloor = 1e-6;  // mm: nothing is finished there
inline constexpr double kThinMm = 0.002;
inline constexpr double kJumpLines = 3;  // stepovers across which a line goes on to the next

/// Places and heights of the lattice of finishing.
struct Grid {
    Lattice lattice;
    Eigen::Vector2d origin;
    Eigen::Vector2d along;
    Eigen::Vector2d across;
    double step = 0;

    [[nodiscard]] Eigen::Vector2d place(const Eigen::Vector2d& node) const {
        return origin + step * (node.x() * along + node.y() * across);
    }

    [[nodiscard]] Eigen::Vector2d place(int column, int row) const {
        return place(Eigen::Vector2d(column, row));
    }
};

/// One tool finishing a set-up: its lattice of exact drops, what is to be done at each node, and
/// the moves that do it.
class Finishing {
  public:
    Finishing(const Work& work, const Cutter& cutter, Tip tip)
        : writer_(work.writer),
          bench_(work.bench),
          cutter_(cutter),
          task_(work.task),
          tip_(std::move(tip)),
          air_(air_tips(work.maps.stock, cutter.tool)),
          room_(axis_room(work.bench, cutter.tool)) {}

    /// Drops the tool at every node. False when cancelled.
    [[nodiscard]] bool sample(double step, decomp::Run& run);

    /// What is to be done at each node: nothing, a line, a level, or both.
    void sort_by_slope(bool rest_only);

    /// What a round tip left at the feet of walls and this flat one can take: lines there.
    void sort_feet();

    /// Level lines from one height down to another, about `step` apart, where levels are wanted.
    void levels(double from_z, double to_z, double step);

    /// The lines of all rows, in a short order.
    void lines(path::MillOperation operation);

    /// Heights at which the tip has been, on the nodes of a map.
    [[nodiscard]] check::HeightMap heights_on(const check::HeightMap& like) const;

    [[nodiscard]] const Finished& figures() const { return figures_; }

    /// Level lines everywhere.
    void mark_all_levels() {
        level_.assign(z_.size(), 1);
        line_.assign(z_.size(), 0);
    }

  private:
    [[nodiscard]] Eigen::Vector3d node(int column, int row) const {
        const Eigen::Vector2d at = grid_.place(column, row);
        return {at.x(), at.y(), z_[grid_.lattice.index(column, row)]};
    }

    /// The lines of a row.
    void add_row(int row, std::vector<std::vector<Eigen::Vector3d>>& lines) const;

    /// Lines between a row and the next, where the surface rises from one to the other.
    void add_row_between(int row, std::vector<std::vector<Eigen::Vector3d>>& lines) const;

    /// Where a further line passes between two nodes of a column: at the foot of a wall right
    /// beside it, for a round tip that stays off leaves the whole corner; on a slope midway.
    [[nodiscard]] std::optional<Eigen::Vector3d> node_between(int column, int row) const;

    /// The slope on the gentler side of a node along the rows and across them: at the foot of a
    /// wall and at its brink that is the ground's.
    [[nodiscard]] double gentlest(int column, int row) const;

    /// The highest that the tip has been around a place; the safe height where it has not been.
    [[nodiscard]] double height_at(const Eigen::Vector2d& at) const;

    [[nodiscard]] bool inside(const Eigen::Vector2d& at) const { return room_.contains(at); }

    [[nodiscard]] bool usable(int column, int row) const {
        const std::size_t i = grid_.lattice.index(column, row);
        return inside(grid_.place(column, row)) && z_[i] > bench_.floor_z + kOnFloor;
    }

    [[nodiscard]] double slope(int c0, int r0, int c1, int r1) const;

    [[nodiscard]] bool near(const std::vector<char>& mask, int column, int row) const;

    [[nodiscard]] double highest_around(int column, int row) const;

    /// Between a node that is clear at z and one that is not: the last clear place, by bisection.
    [[nodiscard]] Eigen::Vector2d onto_surface(const Eigen::Vector2d& below,
                                               const Eigen::Vector2d& above, double z) const;

    /// From `from` along a direction, clear or not by `start`, to where that changes: the last
    /// clear distance, within kPlaceMm; nothing within `farthest`.
    [[nodiscard]] std::optional<double> brink(const Eigen::Vector2d& from,
                                              const Eigen::Vector2d& direction, bool start_clear,
                                              double start, double farthest, double z) const;

    /// Moves a chord's middle onto the surface, out of what it cuts or into the hollow that it
    /// passes over, and asks again for its halves.
    void clear_chord(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double z, int depth,
                     std::vector<Eigen::Vector3d>& out) const;

    /// Where a chain may be entered.
    struct Entry {
        std::size_t chain = 0;
        std::size_t corner = 0;
    };

    /// The entry nearest to where the tip is, of chains that are not done: a closed one is entered
    /// at any corner.
    [[nodiscard]] Entry nearest_entry(const std::vector<Chain>& chains,
                                      const std::vector<char>& done) const;

    void level_lines(std::vector<Chain>& chains, double z);

    void cut_level_line(const Chain& chain, double z);

    /// From a line just cut to the next one below it, without going up.
    bool step_over_to(const Eigen::Vector3d& to, double z);

    [[nodiscard]] double clear_above(const Eigen::Vector3d& at) const {
        return std::max<double>(at.z(), highest_near(air_, at.head<2>())) + kAboveCut;
    }

    void cut_line(const std::vector<Eigen::Vector3d>& nodes);

    Writer& writer_;
    const Bench& bench_;
    const Cutter& cutter_;
    const MillTask& task_;
    Tip tip_;
    check::HeightMap air_;
    Eigen::AlignedBox2d room_;
    Grid grid_;
    std::vector<double> z_;
    std::vector<char> line_;
    std::vector<char> level_;
    Finished figures_;
};

}  // namespace cam::mill
