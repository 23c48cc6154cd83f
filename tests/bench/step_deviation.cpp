// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/rng.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/measure.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

/// How far two files' surfaces lie apart, from samples spread evenly over each.
/// usage: step_deviation PART.stl PART.step SAMPLES   prints: "part-to-solid solid-to-part", mm
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

Triangles triangles_of(const decomp::mesh::TriMesh& mesh) {
    Triangles out;
    for (const auto& t : mesh.triangles) {
        out.emplace_back(point(mesh.points[t[0]]), point(mesh.points[t[1]]),
                         point(mesh.points[t[2]]));
    }
    return out;
}

double farthest(const decomp::mesh::TriMesh& from, const Tree& to, std::size_t samples) {
    decomp::Rng rng(1);
    const double area = decomp::mesh::area_mm2(from);
    double worst = 0;
    double owed = 0;
    for (std::size_t t = 0; t < from.triangles.size(); ++t) {
        const auto& c = from.triangles[t];
        owed += static_cast<double>(samples) * decomp::mesh::double_area_normal(from, t).norm() /
                2 / area;
        for (; owed >= 1; owed -= 1) {
            double u = rng.uniform();
            double v = rng.uniform();
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            const Eigen::Vector3d p =
                (1 - u - v) * from.points[c[0]] + u * from.points[c[1]] + v * from.points[c[2]];
            worst = std::max(worst, to.squared_distance(point(p)));
        }
    }
    return std::sqrt(worst);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: step_deviation PART.stl PART.step SAMPLES\n", stderr);
        return 2;
    }
    const auto part = decomp::io::read_mesh(argv[1], {}, decomp::Run{});
    const auto solid =
        decomp::io::read_mesh(argv[2], {.deflection_mm = 0.002, .angle = 0.1}, decomp::Run{});
    if (!part || !solid) {
        std::fputs((part ? solid.error() : part.error()).text().c_str(), stderr);
        return 3;
    }
    const Triangles of_part = triangles_of(*part);
    const Triangles of_solid = triangles_of(*solid);
    Tree part_tree(of_part.begin(), of_part.end());
    Tree solid_tree(of_solid.begin(), of_solid.end());
    const std::size_t samples = std::stoul(argv[3]);
    std::printf("%.5f %.5f\n", farthest(*part, solid_tree, samples),
                farthest(*solid, part_tree, samples));
    return 0;
}
