// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/mill/finishing_detail.h"
#include "decomp/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cam::mill {

using check::HeightMap;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kRestMm = 0.05;  // that a second finishing tool finds worth cutting

}  // namespace

bool Finishing::sample(double step, decomp::Run& run) {
    const double angle = task_.lines.radians();
    grid_.along = {std::cos(angle), std::sin(angle)};
    grid_.across = {-std::sin(angle), std::cos(angle)};
    grid_.step = step;
    Eigen::AlignedBox2d turned;
    for (const double x : {room_.min().x(), room_.max().x()}) {
        for (const double y : {room_.min().y(), room_.max().y()}) {
            const Vector2d p(x, y);
            turned.extend(Vector2d(p.dot(grid_.along), p.dot(grid_.across)));
        }
    }
    grid_.origin = turned.min().x() * grid_.along + turned.min().y() * grid_.across;
    grid_.lattice.columns = 1 + static_cast<int>(turned.sizes().x() / step + kOnFloor);
    grid_.lattice.rows = 1 + static_cast<int>(turned.sizes().y() / step + kOnFloor);
    Lattice& lattice = grid_.lattice;
    lattice.values.assign(
        static_cast<std::size_t>(lattice.columns) * static_cast<std::size_t>(lattice.rows), 0);
    z_.assign(lattice.values.size(), 0);
    decomp::for_each_index(run, static_cast<std::size_t>(lattice.rows), [&](std::size_t r) {
        const int row = static_cast<int>(r);
        for (int column = 0; column < lattice.columns; ++column) {
            const Vector2d at = grid_.place(column, row);
            z_[lattice.index(column, row)] = inside(at) ? tip_.lowest(at) : bench_.program.safe_z;
        }
    });
    for (std::size_t i = 0; i < z_.size(); ++i) {
        lattice.values[i] = static_cast<float>(z_[i]);
    }
    return !run.cancelled();
}

void Finishing::sort_by_slope(bool rest_only) {
    const Lattice& lattice = grid_.lattice;
    const double steepest = std::tan(task_.steep.radians());
    std::vector<char> steep(z_.size(), 0);
    std::vector<char> needed(z_.size(), 0);
    for (int row = 0; row < lattice.rows; ++row) {
        for (int column = 0; column < lattice.columns; ++column) {
            const std::size_t i = lattice.index(column, row);
            const Vector2d at = grid_.place(column, row);
            needed[i] = inside(at) && z_[i] < bench_.program.stock.max().z() + kRestMm &&
                        (!rest_only || highest_near(air_, at) > z_[i] + kRestMm);
            if (needed[i] == 0) {
                continue;
            }
            const double gx = slope(column - 1, row, column + 1, row);
            const double gy = slope(column, row - 1, column, row + 1);
            steep[i] = std::hypot(gx, gy) > steepest;
            figures_.nodes += z_[i] > bench_.floor_z + kOnFloor ? 1 : 0;
            figures_.held_up +=
                z_[i] > bench_.floor_z + kOnFloor && tip_.body(at) >= z_[i] - kOnFloor ? 1 : 0;
        }
    }
    line_.assign(z_.size(), 0);
    level_.assign(z_.size(), 0);
    for (int row = 0; row < lattice.rows; ++row) {
        for (int column = 0; column < lattice.columns; ++column) {
            const std::size_t i = lattice.index(column, row);
            const bool on_floor = z_[i] <= bench_.floor_z + kOnFloor;
            line_[i] = needed[i] != 0 && !on_floor && gentlest(column, row) <= steepest;
            level_[i] = near(steep, column, row);
        }
    }
}

void Finishing::sort_feet() {
    const Lattice& lattice = grid_.lattice;
    const double steepest = std::tan(task_.steep.radians());
    line_.assign(z_.size(), 0);
    level_.assign(z_.size(), 0);
    for (int row = 0; row < lattice.rows; ++row) {
        for (int column = 0; column < lattice.columns; ++column) {
            const std::size_t i = lattice.index(column, row);
            const Vector2d at = grid_.place(column, row);
            const double ground = gentlest(column, row);
            if (usable(column, row) && ground <= steepest) {
                // The map of the stock is as wrong as the ground rises across its cells.
                const double worth = kRestMm + ground * std::numbers::sqrt2 * air_.cell_mm;
                line_[i] = highest_near(air_, at) > z_[i] + worth;
            }
        }
    }
}

HeightMap Finishing::heights_on(const HeightMap& like) const {
    HeightMap out = like;
    for (int row = 0; row < out.rows; ++row) {
        for (int column = 0; column < out.columns; ++column) {
            const Vector2d at = out.low_mm + out.cell_mm * Vector2d(column, row);
            out.z_mm[out.index(column, row)] = static_cast<float>(height_at(at));
        }
    }
    return out;
}

double Finishing::gentlest(int column, int row) const {
    const double x = std::min(std::abs(slope(column - 1, row, column, row)),
                              std::abs(slope(column, row, column + 1, row)));
    const double y = std::min(std::abs(slope(column, row - 1, column, row)),
                              std::abs(slope(column, row, column, row + 1)));
    return std::hypot(x, y);
}

double Finishing::height_at(const Vector2d& at) const {
    const Vector2d from = at - grid_.origin;
    const int column = static_cast<int>(std::lround(from.dot(grid_.along) / grid_.step));
    const int row = static_cast<int>(std::lround(from.dot(grid_.across) / grid_.step));
    if (column < 0 || row < 0 || column >= grid_.lattice.columns || row >= grid_.lattice.rows) {
        return bench_.program.safe_z;
    }
    const std::size_t i = grid_.lattice.index(column, row);
    return line_[i] != 0 || level_[i] != 0 ? highest_around(column, row) : bench_.program.safe_z;
}

double Finishing::slope(int c0, int r0, int c1, int r1) const {
    const Lattice& lattice = grid_.lattice;
    const auto fit = [](int value, int count) { return std::clamp(value, 0, count - 1); };
    c0 = fit(c0, lattice.columns);
    c1 = fit(c1, lattice.columns);
    r0 = fit(r0, lattice.rows);
    r1 = fit(r1, lattice.rows);
    const double run = grid_.step * std::hypot(c1 - c0, r1 - r0);
    if (run == 0 || !inside(grid_.place(c0, r0)) || !inside(grid_.place(c1, r1))) {
        return 0;
    }
    return (z_[lattice.index(c1, r1)] - z_[lattice.index(c0, r0)]) / run;
}

bool Finishing::near(const std::vector<char>& mask, int column, int row) const {
    const Lattice& lattice = grid_.lattice;
    for (int r = std::max(0, row - 1); r <= std::min(lattice.rows - 1, row + 1); ++r) {
        for (int c = std::max(0, column - 1); c <= std::min(lattice.columns - 1, column + 1); ++c) {
            if (mask[lattice.index(c, r)] != 0) {
                return true;
            }
        }
    }
    return false;
}

double Finishing::highest_around(int column, int row) const {
    const Lattice& lattice = grid_.lattice;
    double z = z_[lattice.index(column, row)];
    for (int r = std::max(0, row - 1); r <= std::min(lattice.rows - 1, row + 1); ++r) {
        for (int c = std::max(0, column - 1); c <= std::min(lattice.columns - 1, column + 1); ++c) {
            z = std::max(z, z_[lattice.index(c, r)]);
        }
    }
    return z;
}

}  // namespace cam::mill
