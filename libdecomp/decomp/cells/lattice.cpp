// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cells/lattice.h"

#include "decomp/tets/boundary.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace decomp::cells {

namespace {

constexpr double kFacing = 0.9;        // cosine of about 25 degrees
constexpr double kLeastArea = 0.002;   // of the surface: less is the wrinkle of a map, no side
constexpr double kLeastExtent = 1e-9;  // of the diagonal

/// Area at a coordinate.
struct Mass {
    double coordinate = 0;
    double area = 0;
};

/// Joins masses from the lowest up while they are closer than `gap`.
std::vector<Mass> clustered(std::vector<Mass> masses, double gap) {
    std::sort(masses.begin(), masses.end(),
              [](const Mass& l, const Mass& r) { return l.coordinate < r.coordinate; });
    std::vector<Mass> out;
    for (const Mass& mass : masses) {
        if (!out.empty() && mass.coordinate - out.back().coordinate < gap) {
            Mass& last = out.back();
            last.coordinate = (last.coordinate * last.area + mass.coordinate * mass.area) /
                              (last.area + mass.area);
            last.area += mass.area;
        } else {
            out.push_back(mass);
        }
    }
    return out;
}

}  // namespace

Result<tets::Lattice> lattice_from(const tets::Pair& pair, double merge_share) {
    std::array<std::vector<Mass>, 3> masses;
    Eigen::AlignedBox3d bounds;
    double surface = 0;
    for (const tets::BoundaryFacet& facet : tets::boundary_of(pair.tets)) {
        const Eigen::Vector3d& a = pair.polycube[facet.corners[0]];
        const Eigen::Vector3d& b = pair.polycube[facet.corners[1]];
        const Eigen::Vector3d& c = pair.polycube[facet.corners[2]];
        const Eigen::Vector3d cross = (b - a).cross(c - a);
        const double area = cross.norm() / 2;
        surface += area;
        bounds.extend(a).extend(b).extend(c);
        for (int axis = 0; axis < 3; ++axis) {
            if (area > 0 && std::abs(cross[axis]) > kFacing * 2 * area) {
                masses.at(static_cast<std::size_t>(axis))
                    .push_back({(a[axis] + b[axis] + c[axis]) / 3, area});
            }
        }
    }
    tets::Lattice out;
    for (int axis = 0; axis < 3; ++axis) {
        const double extent = bounds.sizes()[axis];
        std::vector<double>& planes = out.planes.at(static_cast<std::size_t>(axis));
        for (const Mass& mass :
             clustered(masses.at(static_cast<std::size_t>(axis)), merge_share * extent)) {
            if (mass.area >= kLeastArea * surface) {
                planes.push_back(mass.coordinate);
            }
        }
        if (planes.size() < 2 || !(extent > kLeastExtent * bounds.diagonal().norm())) {
            return fail("cells.bad_pair",
                        "the second mesh of the pair is no polycube: few of its "
                        "facets face along the axes");
        }
    }
    return out;
}

}  // namespace decomp::cells
