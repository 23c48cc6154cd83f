// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cells/divide.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace decomp::cells {

namespace {

using Ends = std::pair<std::uint32_t, std::uint32_t>;

class Divider {
  public:
    Divider(CellComplex& complex, int axis, double coordinate, double on_plane)
        : complex_(complex), axis_(axis), coordinate_(coordinate) {
        sides_.reserve(complex.polycube.size());
        for (Eigen::Vector3d& point : complex.polycube) {
            const double height = point[axis] - coordinate;
            if (std::abs(height) <= on_plane) {
                point[axis] = coordinate;
                sides_.push_back(0);
            } else {
                sides_.push_back(height > 0 ? 1 : -1);
            }
        }
    }

    void run() {
        std::vector<SubTet> whole;
        whole.swap(complex_.tets);
        complex_.tets.reserve(whole.size() + whole.size() / 2);
        for (const SubTet& tet : whole) {
            divide(tet);
        }
    }

  private:
    /// Bisects the first crossing edge and goes on with both halves. A face sees the same order of
    /// its edges from either side.
    void divide(const SubTet& tet) {
        Ends first{UINT32_MAX, UINT32_MAX};
        for (const std::uint32_t a : tet.corners) {
            for (const std::uint32_t b : tet.corners) {
                if (a < b && sides_[a] * sides_[b] < 0) {
                    first = std::min(first, Ends{a, b});
                }
            }
        }
        if (first.first == UINT32_MAX) {
            complex_.tets.push_back(tet);
            return;
        }
        const std::uint32_t middle = crossing(first);
        for (const std::uint32_t end : {first.first, first.second}) {
            SubTet half = tet;
            std::replace(half.corners.begin(), half.corners.end(), end, middle);
            divide(half);
        }
    }

    std::uint32_t crossing(const Ends& ends) {
        const std::uint64_t key = (std::uint64_t{ends.first} << 32U) | ends.second;
        const auto [entry, is_new] =
            crossings_.try_emplace(key, static_cast<std::uint32_t>(complex_.shape.size()));
        if (is_new) {
            const Eigen::Vector3d a = complex_.polycube[ends.first];
            const Eigen::Vector3d b = complex_.polycube[ends.second];
            const double t = (coordinate_ - a[axis_]) / (b[axis_] - a[axis_]);
            Eigen::Vector3d there = a + t * (b - a);
            there[axis_] = coordinate_;
            const Eigen::Vector3d p = complex_.shape[ends.first];
            const Eigen::Vector3d q = complex_.shape[ends.second];
            complex_.polycube.push_back(there);
            complex_.shape.emplace_back(p + t * (q - p));
            sides_.push_back(0);
        }
        return entry->second;
    }

    CellComplex& complex_;
    int axis_;
    double coordinate_;
    std::vector<int> sides_;
    std::unordered_map<std::uint64_t, std::uint32_t> crossings_;  // looked up only
};

}  // namespace

void divide_at(CellComplex& complex, int axis, double coordinate, double on_plane) {
    Divider(complex, axis, coordinate, on_plane).run();
}

}  // namespace decomp::cells
