// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/written.h"

#include "decomp/mesh/measure.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <numeric>

namespace decomp::cut {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

Point point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// For each point the lowest index with the same coordinates.
std::vector<std::uint32_t> first_of_equal(const std::vector<Eigen::Vector3d>& points) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) {
        return std::tuple(points[i].x(), points[i].y(), points[i].z(), i);
    };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> first(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && points[order[i]] == points[order[i - 1]];
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// Whether two triangles over welded points meet elsewhere than in common points and edges.
class PairTest {
  public:
    explicit PairTest(const mesh::TriMesh& mesh) : mesh_(mesh) {}

    [[nodiscard]] bool meet(mesh::Triangle s, mesh::Triangle t) const {
        const std::size_t common = gather(s, t);
        if (common == 3) {
            return true;
        }
        if (common == 2) {
            return same_side(s, t);
        }
        if (common == 1) {
            return CGAL::do_intersect(Kernel::Segment_3(at(s[1]), at(s[2])), triangle(t)) ||
                   CGAL::do_intersect(Kernel::Segment_3(at(t[1]), at(t[2])), triangle(s));
        }
        return CGAL::do_intersect(triangle(s), triangle(t));
    }

    [[nodiscard]] bool is_flat(const mesh::Triangle& t) const {
        return CGAL::collinear(at(t[0]), at(t[1]), at(t[2]));
    }

  private:
    /// Moves the common points of both to the front, in the same order; returns how many there are.
    static std::size_t gather(mesh::Triangle& s, mesh::Triangle& t) {
        std::size_t common = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = common; j < 3; ++j) {
                if (s.at(i) == t.at(j)) {
                    std::swap(t.at(j), t.at(common));
                    std::swap(s.at(i), s.at(common));
                    ++common;
                    break;
                }
            }
        }
        return common;
    }

    /// Two triangles on a common edge overlap when they are coplanar and on the same side of it.
    [[nodiscard]] bool same_side(const mesh::Triangle& s, const mesh::Triangle& t) const {
        return CGAL::orientation(at(s[0]), at(s[1]), at(s[2]), at(t[2])) == CGAL::COPLANAR &&
               CGAL::coplanar_orientation(at(s[0]), at(s[1]), at(s[2]), at(t[2])) == CGAL::POSITIVE;
    }

    [[nodiscard]] Point at(std::uint32_t i) const { return point(mesh_.points[i]); }

    [[nodiscard]] Kernel::Triangle_3 triangle(const mesh::Triangle& t) const {
        return {at(t[0]), at(t[1]), at(t[2])};
    }

    const mesh::TriMesh& mesh_;
};

struct Enough {};

std::vector<std::pair<std::uint32_t, std::uint32_t>> find_intersections(const mesh::TriMesh& mesh,
                                                                        std::size_t at_most) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    const std::vector<std::uint32_t> first = first_of_equal(mesh.points);
    std::vector<mesh::Triangle> welded = mesh.triangles;
    const PairTest test(mesh);
    std::vector<Box> boxes;
    boxes.reserve(welded.size());
    for (std::uint32_t i = 0; i < welded.size(); ++i) {
        CGAL::Bbox_3 box;
        for (std::uint32_t& corner : welded[i]) {
            corner = first[corner];
            box += point(mesh.points[corner]).bbox();
        }
        if (!test.is_flat(welded[i])) {
            boxes.emplace_back(box, i);
        }
    }
    std::vector<const Box*> pointers;
    pointers.reserve(boxes.size());
    for (const Box& box : boxes) {
        pointers.push_back(&box);
    }
    const auto visit = [&](const Box* a, const Box* b) {
        if (test.meet(welded[a->info()], welded[b->info()])) {
            found.emplace_back(std::minmax(a->info(), b->info()));
            if (found.size() >= at_most) {
                throw Enough{};
            }
        }
    };
    try {
        CGAL::box_self_intersection_d(pointers.begin(), pointers.end(), visit, std::ptrdiff_t{500});
    } catch (const Enough&) {
        // the caller wants no more
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace

WrittenReport check_written(const mesh::TriMesh& mesh, std::size_t intersections_at_most) {
    WrittenReport report;
    report.topology = mesh::check_topology(mesh);
    report.outward = mesh::volume_mm3(mesh) > 0;
    if (intersections_at_most > 0) {
        report.intersections = find_intersections(mesh, intersections_at_most);
    }
    return report;
}

mesh::TriMesh float_mesh(const mesh::TriMesh& mesh) {
    mesh::TriMesh rounded = mesh;
    for (Eigen::Vector3d& p : rounded.points) {
        p = p.cast<float>().cast<double>();
    }
    const std::vector<std::uint32_t> first = first_of_equal(rounded.points);
    mesh::TriMesh out;
    std::vector<std::int64_t> number(rounded.points.size(), -1);
    for (const mesh::Triangle& t : rounded.triangles) {
        mesh::Triangle welded{first[t[0]], first[t[1]], first[t[2]]};
        if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) {
            continue;
        }
        for (std::uint32_t& corner : welded) {
            if (number[corner] < 0) {
                number[corner] = static_cast<std::int64_t>(out.points.size());
                out.points.push_back(rounded.points[corner]);
            }
            corner = static_cast<std::uint32_t>(number[corner]);
        }
        out.triangles.push_back(welded);
    }
    return out;
}

}  // namespace decomp::cut
