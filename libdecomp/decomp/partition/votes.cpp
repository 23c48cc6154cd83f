// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/partition/votes.h"

#include "decomp/partition/locate.h"

#include <algorithm>
#include <numeric>

namespace decomp::partition {

namespace {

constexpr double kFlippedWeight = 1e-9;  // enough to win where nobody else votes

}  // namespace

std::int32_t winner(const Tally& tally) {
    const auto most = std::max_element(tally.begin(), tally.end());
    return most == tally.end() || *most <= 0 ? -1 : static_cast<std::int32_t>(most - tally.begin());
}

Ballot::Ballot(const cells::CellComplex& cells, const sheets::Sheets& sheets)
    : of_boxes_(sheets.boxes.size(), 0) {
    for (const cells::SubTet& tet : cells.tets) {
        if (!(tet.volume_mm3 > 0)) {
            continue;
        }
        Vote vote;
        for (const std::uint32_t corner : tet.corners) {
            vote.point += cells.shape[corner] / 4;
        }
        vote.weight_mm3 = tet.flipped ? kFlippedWeight * tet.volume_mm3 : tet.volume_mm3;
        vote.box = sheets.box_of_cell[static_cast<std::size_t>(tet.cell)];
        total_mm3_ += vote.weight_mm3;
        of_boxes_[static_cast<std::size_t>(vote.box)] += vote.weight_mm3;
        votes_.push_back(vote);
    }
}

std::vector<Atom> Ballot::placed(const cut::Complex& complex,
                                 const std::vector<std::int32_t>& regions) const {
    std::vector<std::uint32_t> all(votes_.size());
    std::iota(all.begin(), all.end(), 0U);
    return placed(complex, regions, all, nullptr);
}

std::vector<Atom> Ballot::placed(const cut::Complex& complex,
                                 const std::vector<std::int32_t>& regions,
                                 const std::vector<std::uint32_t>& votes,
                                 const part::Plane* plane) const {
    std::vector<Atom> out;
    out.reserve(regions.size());
    std::vector<const mesh::TriMesh*> solids;
    solids.reserve(regions.size());
    for (const std::int32_t region : regions) {
        out.push_back({region, complex.region(region), {}, Tally(of_boxes_.size(), 0)});
    }
    for (const Atom& atom : out) {
        solids.push_back(&atom.part.mesh);
    }
    const auto put = [&](std::uint32_t vote, std::size_t atom) {
        out[atom].votes.push_back(vote);
        out[atom].tally[static_cast<std::size_t>(votes_[vote].box)] += votes_[vote].weight_mm3;
    };
    if (plane != nullptr && regions.size() == 2) {
        for (const std::uint32_t vote : votes) {
            put(vote, plane->normal.dot(votes_[vote].point) < plane->offset_mm ? 0 : 1);
        }
        return out;
    }
    const Locator locator(solids);
    for (const std::uint32_t vote : votes) {
        const int solid = locator.locate(votes_[vote].point);
        if (solid >= 0) {
            put(vote, static_cast<std::size_t>(solid));
        }
    }
    return out;
}

}  // namespace decomp::partition
