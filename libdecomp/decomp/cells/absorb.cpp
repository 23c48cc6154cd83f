// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cells/divide.h"

#include <map>
#include <numeric>

namespace decomp::cells {

namespace {

/// Areas of contact of every living cell, kept up to date while cells join.
using Touching = std::vector<std::map<std::int32_t, double>>;

std::int32_t most_touched(const std::map<std::int32_t, double>& touching) {
    std::int32_t best = -1;
    double best_area = 0;
    for (const auto& [other, area] : touching) {
        if (best < 0 || area > best_area) {
            best = other;
            best_area = area;
        }
    }
    return best;
}

std::int32_t smallest(const std::vector<Cell>& cells, const Touching& touching,
                      const std::vector<std::int32_t>& joined, double least_mm3) {
    std::int32_t found = -1;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const bool alive = joined[i] == static_cast<std::int32_t>(i);
        if (alive && cells[i].volume_mm3 < least_mm3 && !touching[i].empty() &&
            (found < 0 ||
             cells[i].volume_mm3 < cells[static_cast<std::size_t>(found)].volume_mm3)) {
            found = static_cast<std::int32_t>(i);
        }
    }
    return found;
}

}  // namespace

void absorb_small(CellComplex& complex, double least_mm3) {
    std::vector<Cell>& cells = complex.cells;
    Touching touching(cells.size());
    for (const Contact& contact : complex.contacts) {
        touching[static_cast<std::size_t>(contact.a)][contact.b] = contact.area_mm2;
        touching[static_cast<std::size_t>(contact.b)][contact.a] = contact.area_mm2;
    }
    std::vector<std::int32_t> joined(cells.size());
    std::iota(joined.begin(), joined.end(), 0);
    for (;;) {
        const std::int32_t from = smallest(cells, touching, joined, least_mm3);
        if (from < 0) {
            break;
        }
        const std::int32_t into = most_touched(touching[static_cast<std::size_t>(from)]);
        Cell& gone = cells[static_cast<std::size_t>(from)];
        complex.fragment_share += gone.volume_mm3 / complex.volume_mm3;
        ++complex.fragments;
        cells[static_cast<std::size_t>(into)].volume_mm3 += gone.volume_mm3;
        joined[static_cast<std::size_t>(from)] = into;
        for (const auto& [other, area] : touching[static_cast<std::size_t>(from)]) {
            touching[static_cast<std::size_t>(other)].erase(from);
            if (other != into) {
                touching[static_cast<std::size_t>(other)][into] += area;
                touching[static_cast<std::size_t>(into)][other] += area;
            }
        }
        touching[static_cast<std::size_t>(from)].clear();
    }
    const auto root = [&](std::int32_t cell) {
        while (joined[static_cast<std::size_t>(cell)] != cell) {
            cell = joined[static_cast<std::size_t>(cell)];
        }
        return cell;
    };
    std::vector<std::int32_t> number(cells.size(), -1);
    std::vector<Cell> kept;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (joined[i] == static_cast<std::int32_t>(i)) {
            number[i] = static_cast<std::int32_t>(kept.size());
            kept.push_back(cells[i]);
        }
    }
    for (SubTet& tet : complex.tets) {
        tet.cell = number[static_cast<std::size_t>(root(tet.cell))];
    }
    cells = std::move(kept);
}

}  // namespace decomp::cells
