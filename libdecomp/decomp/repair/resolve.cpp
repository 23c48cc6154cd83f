// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/resolve.h"

#include "decomp/mesh/measure.h"
#include "decomp/repair/edges.h"
#include "decomp/repair/shells.h"
#include "decomp/repair/soup.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace decomp::repair {

namespace {

constexpr std::size_t kMostPatches = 5000;
constexpr double kFromInteger = 0.1;  // how far a winding number may lie from its integer

/// Patches: triangles connected across edges that only two of them share.
Components patches_of(const mesh::TriMesh& mesh) {
    Sets sets(mesh.triangles.size());
    const std::vector<Side> sides = sorted_sides(mesh);
    for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 2) {
            sets.unite(sides[begin].triangle, sides[begin + 1].triangle);
        }
    });
    Components patches;
    patches.of_triangle.resize(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t root = sets.find(i);
        patches.of_triangle[i] =
            root == i ? static_cast<std::uint32_t>(patches.count++) : patches.of_triangle[root];
    }
    return patches;
}

std::vector<std::size_t> largest_triangles(const mesh::TriMesh& mesh, const Components& patches) {
    std::vector<std::size_t> largest(patches.count, 0);
    std::vector<double> area(patches.count, -1);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t patch = patches.of_triangle[i];
        const double here = mesh::double_area_normal(mesh, i).squaredNorm();
        if (here > area[patch]) {
            area[patch] = here;
            largest[patch] = i;
        }
    }
    return largest;
}

/// The winding number just before a triangle. Seen from a point of it the triangle itself subtends
/// nothing, and the others sum to the mean of the two sides, which differ by one.
double winding_before(const mesh::TriMesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const Eigen::Vector3d centre = (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3;
    mesh::TriMesh others = mesh;
    others.triangles.erase(others.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
    return winding_number(others, centre) - 0.5;
}

}  // namespace

Result<mesh::TriMesh> resolve_crossings(const mesh::TriMesh& mesh) {
    Result<mesh::TriMesh> cut = cut_along_crossings(mesh);
    if (!cut) {
        return cut;
    }
    const Components patches = patches_of(*cut);
    if (patches.count > kMostPatches) {
        return fail("repair.failed", "the surface crosses itself along too many lines");
    }
    std::vector<bool> wanted(patches.count);
    const std::vector<std::size_t> largest = largest_triangles(*cut, patches);
    for (std::size_t patch = 0; patch < patches.count; ++patch) {
        const double before = winding_before(*cut, largest[patch]);
        if (std::abs(before - std::round(before)) > kFromInteger) {
            return fail("repair.failed", "a patch of the surface has no clear side");
        }
        wanted[patch] = std::lround(before) == 0;
    }
    mesh::TriMesh out = extract(*cut, patches, wanted);
    split_non_manifold(out);
    return out;
}

}  // namespace decomp::repair
