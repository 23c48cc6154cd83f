// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/samples.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>

namespace cam::check {

using decomp::mesh::Facets;
using decomp::mesh::TriMesh;

namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// Which edge is longest (corner i to i + 1), and its length.
struct Longest {
    std::size_t edge = 0;
    double mm = 0;
};

Longest longest_edge(const Corners& t) {
    Longest out;
    for (std::size_t i = 0; i < 3; ++i) {
        const double mm = (t.at((i + 1) % 3) - t.at(i)).norm();
        if (mm > out.mm) {
            out = {i, mm};
        }
    }
    return out;
}

/// Adds the pieces of one facet; false when there are more than `most` in all.
bool cut(const Corners& whole, const Eigen::Vector3d& unit, std::uint32_t facet, std::size_t most,
         Samples& samples) {
    std::vector<Corners> left{whole};
    while (!left.empty()) {
        const Corners t = left.back();
        left.pop_back();
        const Longest longest = longest_edge(t);
        if (longest.mm > samples.spacing_mm) {
            const std::size_t i = longest.edge;
            const Eigen::Vector3d& far = t.at((i + 2) % 3);
            const Eigen::Vector3d middle = (t.at(i) + t.at((i + 1) % 3)) / 2;
            left.push_back({middle, t.at((i + 1) % 3), far});
            left.push_back({t.at(i), middle, far});
            continue;
        }
        if (samples.facet.size() >= most) {
            return false;
        }
        samples.facet.push_back(facet);
        samples.pieces.unit.push_back(unit);
        samples.pieces.centre.emplace_back((t[0] + t[1] + t[2]) / 3);
        samples.pieces.area_mm2.push_back((t[1] - t[0]).cross(t[2] - t[0]).norm() / 2);
    }
    return true;
}

bool cut_all(const TriMesh& mesh, const Facets& facets, std::size_t most, Samples& samples) {
    samples.facet.clear();
    samples.pieces = {};
    samples.pieces.total_mm2 = facets.total_mm2;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        const Corners corners{mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
        const std::size_t before = samples.facet.size();
        if (!cut(corners, facets.unit[i], static_cast<std::uint32_t>(i),
                 most - (mesh.triangles.size() - 1 - i), samples)) {
            return false;
        }
        if (samples.facet.size() == before + 1) {
            samples.pieces.centre.back() = facets.centre[i];
            samples.pieces.area_mm2.back() = facets.area_mm2[i];
        }
    }
    return true;
}

}  // namespace

Samples sample_facets(const TriMesh& mesh, const Facets& facets, const SampleOptions& options) {
    Samples samples;
    samples.spacing_mm = options.spacing_mm;
    while (!cut_all(mesh, facets, mesh.triangles.size() + options.most_pieces, samples)) {
        samples.spacing_mm *= 2;
    }
    return samples;
}

std::vector<char> mostly(const Samples& samples, std::size_t facet_count,
                         const std::vector<char>& marked) {
    std::vector<double> balance(facet_count, 0);
    for (std::size_t i = 0; i < marked.size(); ++i) {
        balance[samples.facet[i]] += (marked[i] != 0 ? 1 : -1) * samples.pieces.area_mm2[i];
    }
    std::vector<char> out(facet_count, 0);
    for (std::size_t i = 0; i < facet_count; ++i) {
        out[i] = balance[i] > 0 ? 1 : 0;
    }
    return out;
}

}  // namespace cam::check
