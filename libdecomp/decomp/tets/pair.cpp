// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/pair.h"

#include "decomp/tets/measure.h"

#include <algorithm>
#include <numeric>
#include <string>

namespace decomp::tets {

namespace {

std::vector<std::pair<Tet, std::size_t>> canonical(const std::vector<Tet>& tets) {
    std::vector<std::pair<Tet, std::size_t>> out;
    out.reserve(tets.size());
    for (std::size_t i = 0; i < tets.size(); ++i) {
        Tet tet = tets[i];
        std::sort(tet.begin(), tet.end());
        out.emplace_back(tet, i);
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::string text_of(const Tet& tet) {
    std::string out;
    for (const std::uint32_t corner : tet) {
        out += (out.empty() ? "" : " ") + std::to_string(corner);
    }
    return out;
}

std::string counts(std::size_t shape, std::size_t polycube, const char* what) {
    return "the shape has " + std::to_string(shape) + " " + what + ", the polycube " +
           std::to_string(polycube);
}

/// The tet that stands first, in the order of its file, in one mesh only.
Status same_tets(const TetMesh& shape, const TetMesh& polycube) {
    const auto ours = canonical(shape.tets);
    const auto theirs = canonical(polycube.tets);
    const auto lone = [](const auto& from, const auto& in) {
        std::size_t first = from.size();
        std::size_t j = 0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            while (j < in.size() && in[j].first < from[i].first) {
                ++j;
            }
            if (j < in.size() && in[j].first == from[i].first) {
                ++j;
            } else {
                first = std::min(first, from[i].second);
            }
        }
        return first;
    };
    const std::size_t here = lone(ours, theirs);
    const std::size_t there = lone(theirs, ours);
    if (here == ours.size() && there == theirs.size()) {
        return {};
    }
    const bool in_shape = here <= there && here < shape.tets.size();
    const std::size_t index = in_shape ? here : there;
    const Tet& tet = in_shape ? shape.tets[index] : polycube.tets[index];
    return fail("tets.connectivity",
                "tet " + std::to_string(index) + " of the " + (in_shape ? "shape" : "polycube") +
                    " (points " + text_of(tet) + ", the first is 0) is none of the " +
                    (in_shape ? "polycube's" : "shape's"),
                {}, "the two must have the same points and tets, moved");
}

}  // namespace

Result<Pair> pair_of(TetMesh shape, TetMesh polycube) {
    if (shape.tets.empty() || polycube.tets.empty()) {
        return fail(
            "tets.empty",
            std::string("the ") + (shape.tets.empty() ? "shape" : "polycube") + " holds no tet");
    }
    const char* hint = "the two must have the same points and tets, moved";
    if (shape.points.size() != polycube.points.size()) {
        return fail("tets.connectivity",
                    counts(shape.points.size(), polycube.points.size(), "points"), {}, hint);
    }
    if (shape.tets.size() != polycube.tets.size()) {
        return fail("tets.connectivity", counts(shape.tets.size(), polycube.tets.size(), "tets"),
                    {}, hint);
    }
    if (Status status = same_tets(shape, polycube); !status) {
        return fail(status.error());
    }
    Pair pair{std::move(shape.points), std::move(polycube.points), std::move(shape.tets)};
    for (Tet& tet : pair.tets) {
        if (six_volumes(pair.shape, tet) < 0) {
            std::swap(tet[2], tet[3]);
        }
    }
    return pair;
}

}  // namespace decomp::tets
