// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/quantise.h"

#include "decomp/tets/boundary.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace decomp::map {

namespace {

constexpr double kFlatShare = 0.02;  // of the extent: facets of one chart of a foreign pair

constexpr double kLevel = 1e-6;  // of the extent: no solid is as thin

/// Facets in one plane that look the same way.
struct Layer {
    double coordinate = 0;
    double area = 0;
    int sign = 1;
    Eigen::AlignedBox2d reach;  ///< along the two other axes
};

struct Facet {
    labels::AxisLabel label{};
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double area = 0;
    std::array<Eigen::Vector3d, 3> corners;
};

std::vector<Facet> facets_of(const tets::Pair& pair, const labels::Labeling& labels) {
    std::vector<Facet> out;
    const auto boundary = tets::boundary_of(pair.tets);
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        Facet facet;
        facet.label = labels[i];
        for (std::size_t k = 0; k < 3; ++k) {
            facet.corners.at(k) = pair.polycube[boundary[i].corners.at(k)];
            facet.centre += facet.corners.at(k) / 3;
        }
        facet.area = (facet.corners[1] - facet.corners[0])
                         .cross(facet.corners[2] - facet.corners[0])
                         .norm() /
                     2;
        out.push_back(facet);
    }
    return out;
}

/// Layers of one axis by rising coordinate; facets of one sign closer than `flat` to the first of
/// their layer are joined with it.
std::vector<Layer> layers_of(const std::vector<Facet>& facets, int axis, double flat) {
    std::vector<Layer> out;
    for (const int sign : {-1, 1}) {
        std::vector<const Facet*> mine;
        for (const Facet& facet : facets) {
            if (facet.label == labels::label_of(axis, sign)) {
                mine.push_back(&facet);
            }
        }
        std::stable_sort(mine.begin(), mine.end(), [&](const Facet* a, const Facet* b) {
            return a->centre[axis] < b->centre[axis];
        });
        double first = 0;
        for (std::size_t i = 0; i < mine.size(); ++i) {
            const double at = mine[i]->centre[axis];
            if (i == 0 || at - first > flat) {
                out.push_back({0, 0, sign, {}});
                first = at;
            }
            Layer& layer = out.back();
            layer.coordinate += mine[i]->area * at;
            layer.area += mine[i]->area;
            for (const Eigen::Vector3d& corner : mine[i]->corners) {
                layer.reach.extend(Eigen::Vector2d(corner[(axis + 1) % 3], corner[(axis + 2) % 3]));
            }
        }
    }
    std::erase_if(out, [](const Layer& layer) { return !(layer.area > 0); });
    for (Layer& layer : out) {
        layer.coordinate /= layer.area;
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Layer& a, const Layer& b) { return a.coordinate < b.coordinate; });
    return out;
}

/// Whether solid lies between two layers: the lower looks down, the upper up, and they overlap.
bool solid_between(const Layer& lower, const Layer& upper) {
    return lower.sign < 0 && upper.sign > 0 && lower.reach.intersects(upper.reach);
}

std::vector<double> merged_planes(const std::vector<Layer>& layers, double low, double high,
                                  double merge) {
    std::vector<double> planes;
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= layers.size(); ++i) {
        bool joins = i < layers.size() &&
                     layers[i].coordinate - layers[i - 1].coordinate <= merge * (high - low);
        for (std::size_t k = begin; joins && k < i; ++k) {
            joins = layers[i].coordinate - layers[k].coordinate <= kLevel * (high - low) ||
                    !solid_between(layers[k], layers[i]);
        }
        if (joins) {
            continue;
        }
        double sum = 0;
        double area = 0;
        for (std::size_t k = begin; k < i; ++k) {
            sum += layers[k].area * layers[k].coordinate;
            area += layers[k].area;
        }
        if (area > 0) {
            planes.push_back(sum / area);
        }
        begin = i;
    }
    // The outermost planes bound the polycube, whatever was merged into them.
    if (planes.size() < 2) {
        return {low, high};
    }
    planes.front() = low;
    planes.back() = high;
    return planes;
}

tets::Lattice lattice(const tets::Pair& pair, const labels::Labeling& labels, double flat_share,
                      double merge_share) {
    Eigen::AlignedBox3d box;
    for (const tets::Tet& tet : pair.tets) {
        for (const std::uint32_t corner : tet) {
            box.extend(pair.polycube[corner]);
        }
    }
    const std::vector<Facet> facets = facets_of(pair, labels);
    tets::Lattice out;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min()[axis];
        const double high = box.max()[axis];
        out.planes.at(static_cast<std::size_t>(axis)) = merged_planes(
            layers_of(facets, axis, flat_share * (high - low)), low, high, merge_share);
    }
    return out;
}

}  // namespace

tets::Lattice quantise(const MapResult& map, double merge_share) {
    return lattice(map.pair, map.labels, 0, merge_share);
}

labels::Labeling labels_of(const tets::Pair& pair) {
    const auto boundary = tets::boundary_of(pair.tets);
    const bool mirrored = tets::measure(pair).polycube_mm3 < 0;
    labels::Labeling out;
    out.reserve(boundary.size());
    for (const auto& facet : boundary) {
        const Eigen::Vector3d& a = pair.polycube[facet.corners[0]];
        const Eigen::Vector3d normal =
            (pair.polycube[facet.corners[1]] - a).cross(pair.polycube[facet.corners[2]] - a) *
            (mirrored ? -1.0 : 1.0);
        int axis = 0;
        normal.cwiseAbs().maxCoeff(&axis);
        out.push_back(labels::label_of(axis, normal[axis] > 0 ? 1 : -1));
    }
    return out;
}

tets::Lattice lattice_of(const tets::Pair& pair, double merge_share) {
    return lattice(pair, labels_of(pair), kFlatShare, merge_share);
}

}  // namespace decomp::map
