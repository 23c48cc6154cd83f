// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sheets/boxes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace decomp::sheets {

namespace {

using CellPair = std::pair<std::int32_t, std::int32_t>;

class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    std::int32_t find(std::int32_t i) {
        while (at(i) != i) {
            i = at(i) = at(at(i));
        }
        return i;
    }

    void unite(std::int32_t a, std::int32_t b) {
        a = find(a);
        b = find(b);
        at(std::max(a, b)) = std::min(a, b);
    }

  private:
    std::int32_t& at(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }

    std::vector<std::int32_t> parent_;
};

class Sweeper {
  public:
    Sweeper(const cells::CellComplex& cells, double least_contact) : cells_(cells) {
        list_faces(least_contact);
    }

    void mark(Sweep how) {
        Sets floods(out_.faces.size());
        for (std::size_t i = 0; i < out_.faces.size(); ++i) {
            look_round(static_cast<std::int32_t>(i), floods);
        }
        std::set<std::pair<int, int>> planes;
        std::set<std::int32_t> marked;
        for (std::size_t i = 0; i < out_.faces.size(); ++i) {
            LatticeFace& face = out_.faces[i];
            face.flood = floods.find(static_cast<std::int32_t>(i));
            if (face.marked) {
                planes.emplace(face.axis, face.plane);
                marked.insert(face.flood);
            }
        }
        for (LatticeFace& face : out_.faces) {
            face.marked = how == Sweep::Global ? planes.contains({face.axis, face.plane})
                                               : marked.contains(face.flood);
        }
    }

    Boxes boxes() {
        Sets sets(cells_.cells.size());
        for (const LatticeFace& face : out_.faces) {
            if (!face.marked) {
                sets.unite(face.lower, face.upper);
            }
        }
        std::vector<std::int32_t> number(cells_.cells.size(), -1);
        for (std::size_t i = 0; i < cells_.cells.size(); ++i) {
            const cells::Cell& cell = cells_.cells[i];
            std::int32_t& n =
                number[static_cast<std::size_t>(sets.find(static_cast<std::int32_t>(i)))];
            if (n < 0) {
                n = static_cast<std::int32_t>(out_.boxes.size());
                out_.boxes.push_back({0, cell.index, cell.index});
            }
            Box& box = out_.boxes[static_cast<std::size_t>(n)];
            box.volume_mm3 += cell.volume_mm3;
            for (std::size_t k = 0; k < 3; ++k) {
                box.low.at(k) = std::min(box.low.at(k), cell.index.at(k));
                box.high.at(k) = std::max(box.high.at(k), cell.index.at(k) + 1);
            }
            out_.box_of_cell.push_back(n);
        }
        return std::move(out_);
    }

  private:
    void list_faces(double least_contact) {
        std::map<CellPair, double> areas;
        for (const cells::SheetPiece& piece : cells_.pieces) {
            areas[{piece.lower, piece.upper}] += piece.area_mm2;
        }
        std::map<CellPair, std::pair<int, int>> where;
        for (const cells::SheetPiece& piece : cells_.pieces) {
            where[{piece.lower, piece.upper}] = {piece.axis, piece.plane};
        }
        for (const auto& [pair, area] : areas) {
            const double smaller =
                std::min(cells_.cells[static_cast<std::size_t>(pair.first)].volume_mm3,
                         cells_.cells[static_cast<std::size_t>(pair.second)].volume_mm3);
            if (area > least_contact * std::pow(smaller, 2.0 / 3.0)) {
                const auto [axis, plane] = where[pair];
                number_[pair] = static_cast<std::int32_t>(out_.faces.size());
                out_.faces.push_back({pair.first, pair.second, axis, plane, -1, false});
                above_[{pair.first, axis}].push_back(pair.second);
                below_[{pair.second, axis}].push_back(pair.first);
            }
        }
    }

    using Neighbours = std::map<std::pair<std::int32_t, int>, std::vector<std::int32_t>>;

    [[nodiscard]] static std::vector<std::int32_t> of(const Neighbours& neighbours,
                                                      std::int32_t cell, int axis) {
        const auto found = neighbours.find({cell, axis});
        return found == neighbours.end() ? std::vector<std::int32_t>{} : found->second;
    }

    /// Beyond each of its four edges a face goes on where both of its cells do; where one of them
    /// does, the edge is concave.
    void look_round(std::int32_t index, Sets& floods) {
        LatticeFace& face = out_.faces[static_cast<std::size_t>(index)];
        for (int axis = 0; axis < 3; ++axis) {
            if (axis == face.axis) {
                continue;
            }
            for (const Neighbours* side : {&below_, &above_}) {
                const std::vector<std::int32_t> lower = of(*side, face.lower, axis);
                const std::vector<std::int32_t> upper = of(*side, face.upper, axis);
                const bool goes_on = flood_between(index, lower, upper, floods);
                face.marked = face.marked || (!goes_on && (!lower.empty() || !upper.empty()));
            }
        }
    }

    /// One flood with all faces between the cells beyond an edge; false where there is none.
    bool flood_between(std::int32_t index, const std::vector<std::int32_t>& lower,
                       const std::vector<std::int32_t>& upper, Sets& floods) {
        bool goes_on = false;
        for (const std::int32_t l : lower) {
            for (const std::int32_t u : upper) {
                const auto found = number_.find({l, u});
                if (found != number_.end()) {
                    goes_on = true;
                    floods.unite(index, found->second);
                }
            }
        }
        return goes_on;
    }

    const cells::CellComplex& cells_;
    Boxes out_;
    std::map<CellPair, std::int32_t> number_;
    Neighbours above_;
    Neighbours below_;
};

}  // namespace

Boxes sweep(const cells::CellComplex& cells, Sweep how, double least_contact) {
    Sweeper sweeper(cells, least_contact);
    sweeper.mark(how);
    return sweeper.boxes();
}

}  // namespace decomp::sheets
