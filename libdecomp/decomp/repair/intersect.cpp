// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/intersect.h"

#include "decomp/mesh/measure.h"
#include "decomp/repair/soup.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>

namespace decomp::repair {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

class PairTest {
  public:
    explicit PairTest(const mesh::TriMesh& mesh) : triangles_(mesh.triangles) {
        for (const auto& p : mesh.points) {
            points_.emplace_back(p.x(), p.y(), p.z());
        }
        const std::vector<std::uint32_t> place = first_of_equal_points(mesh);
        for (auto& triangle : triangles_) {
            for (auto& corner : triangle) {
                corner = place[corner];
            }
        }
    }

    [[nodiscard]] bool has_area(std::uint32_t i) const {
        const auto& t = triangles_[i];
        return !CGAL::collinear(points_[t[0]], points_[t[1]], points_[t[2]]);
    }

    [[nodiscard]] Box box(std::uint32_t i) const {
        const auto& t = triangles_[i];
        return {points_[t[0]].bbox() + points_[t[1]].bbox() + points_[t[2]].bbox(), i};
    }

    /// Whether two triangles with area meet other than in what they share.
    [[nodiscard]] bool operator()(std::uint32_t i, std::uint32_t j) const {
        const auto [a, b, shared] = shared_first(triangles_[i], triangles_[j]);
        const auto point = [&](std::uint32_t corner) -> const Point& { return points_[corner]; };
        const auto triangle = [&](const mesh::Triangle& t) {
            return Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2]));
        };
        switch (shared) {
            case 0:
                return CGAL::do_intersect(triangle(a), triangle(b));
            case 1:
                return CGAL::do_intersect(triangle(a),
                                          Kernel::Segment_3(point(b[1]), point(b[2]))) ||
                       CGAL::do_intersect(triangle(b), Kernel::Segment_3(point(a[1]), point(a[2])));
            case 2:  // they overlap only if folded flat onto each other
                return CGAL::coplanar(point(a[0]), point(a[1]), point(a[2]), point(b[2])) &&
                       CGAL::coplanar_orientation(point(a[0]), point(a[1]), point(a[2]),
                                                  point(b[2])) == CGAL::POSITIVE;
            default:
                return true;
        }
    }

  private:
    struct Shared {
        mesh::Triangle a;
        mesh::Triangle b;
        int count;
    };

    /// Both triangles with their common corners first, in the same order.
    static Shared shared_first(mesh::Triangle a, mesh::Triangle b) {
        int count = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto found = std::find(b.begin() + count, b.end(), a.at(i));
            if (found != b.end()) {
                std::swap(a.at(i), a.at(static_cast<std::size_t>(count)));
                std::iter_swap(found, b.begin() + count);
                ++count;
            }
        }
        return {a, b, count};
    }

    std::vector<mesh::Triangle> triangles_;
    std::vector<Point> points_;
};

struct Enough {};  // unwinds CGAL's loop; caught below

}  // namespace

std::vector<Pair> self_intersections(const mesh::TriMesh& mesh, std::size_t at_most) {
    std::vector<Pair> pairs;
    if (at_most == 0) {
        return pairs;
    }
    const PairTest meet(mesh);
    std::vector<Box> boxes;
    boxes.reserve(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (meet.has_area(i)) {
            boxes.push_back(meet.box(i));
        }
    }
    std::vector<const Box*> order;
    order.reserve(boxes.size());
    for (const Box& box : boxes) {
        order.push_back(&box);
    }
    const auto report = [&](const Box* a, const Box* b) {
        if (meet(a->info(), b->info())) {
            pairs.emplace_back(std::minmax(a->info(), b->info()));
            if (pairs.size() == at_most) {
                throw Enough{};
            }
        }
    };
    try {
        constexpr std::ptrdiff_t kCutoff = 200;  // boxes below which all pairs are compared
        CGAL::box_self_intersection_d(order.begin(), order.end(), report, kCutoff);
    } catch (const Enough&) {
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace decomp::repair
