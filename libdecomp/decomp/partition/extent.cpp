// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/partition/extent.h"

#include "decomp/partition/locate.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace decomp::partition {

namespace {

constexpr double kMostOfPart = 0.95;  // of its volume: the cells that it is made of

}  // namespace

std::optional<Extent> extent_of(const cells::CellComplex& cells, const mesh::TriMesh& part) {
    const Locator locator({&part});
    std::vector<const cells::SubTet*> inside;
    std::vector<double> weight(cells.cells.size(), 0);
    for (const cells::SubTet& tet : cells.tets) {
        if (tet.flipped || !(tet.volume_mm3 > 0)) {
            continue;
        }
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
        for (const std::uint32_t corner : tet.corners) {
            centre += cells.shape[corner] / 4;
        }
        if (locator.locate(centre) == 0) {
            inside.push_back(&tet);
            weight[static_cast<std::size_t>(tet.cell)] += tet.volume_mm3;
        }
    }
    if (inside.empty()) {
        return std::nullopt;
    }
    std::vector<std::size_t> order(weight.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t l, std::size_t r) { return weight[l] > weight[r]; });
    const double all = std::accumulate(weight.begin(), weight.end(), 0.0);
    Extent out;
    out.cells.assign(weight.size(), 0);
    double covered = 0;
    for (std::size_t i = 0; i < order.size() && covered < kMostOfPart * all; ++i) {
        out.cells[order[i]] = 1;
        covered += weight[order[i]];
    }
    bool first = true;
    for (const cells::SubTet* tet : inside) {
        if (out.cells[static_cast<std::size_t>(tet->cell)] == 0) {
            continue;
        }
        for (const std::uint32_t corner : tet->corners) {
            const Eigen::Vector3d& point = cells.polycube[corner];
            out.low = first ? point : Eigen::Vector3d(out.low.cwiseMin(point));
            out.high = first ? point : Eigen::Vector3d(out.high.cwiseMax(point));
            first = false;
        }
    }
    return out;
}

}  // namespace decomp::partition
