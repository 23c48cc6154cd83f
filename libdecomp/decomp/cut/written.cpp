// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/written.h"

#include "decomp/mesh/measure.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace decomp::cut {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

Point point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

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

/// Index of the corner at which the longest edge starts.
std::size_t longest_edge(const mesh::TriMesh& mesh, const mesh::Triangle& t) {
    std::size_t best = 0;
    double best_length = -1;
    for (std::size_t k = 0; k < 3; ++k) {
        const double length = (mesh.points[t.at((k + 1) % 3)] - mesh.points[t.at(k)]).squaredNorm();
        if (length > best_length) {
            best = k;
            best_length = length;
        }
    }
    return best;
}

/// Takes out pairs of triangles with the same corners the other way round; false when there is
/// none.
bool cancel_backs(FloatMesh& surface) {
    std::map<mesh::Triangle, std::vector<std::uint32_t>> even;
    std::map<mesh::Triangle, std::vector<std::uint32_t>> odd;
    std::vector<mesh::Triangle>& triangles = surface.mesh.triangles;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        mesh::Triangle t = triangles[i];
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        const bool is_even = t[1] < t[2];
        std::sort(t.begin(), t.end());
        (is_even ? even : odd)[t].push_back(i);
    }
    std::vector<bool> gone(triangles.size(), false);
    bool any = false;
    for (const auto& [corners, fronts] : even) {
        const auto backs = odd.find(corners);
        for (std::size_t k = 0;
             backs != odd.end() && k < std::min(fronts.size(), backs->second.size()); ++k) {
            gone[fronts[k]] = true;
            gone[backs->second[k]] = true;
            any = true;
        }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (!gone[i]) {
            triangles[kept] = triangles[i];
            surface.origin[kept] = surface.origin[i];
            ++kept;
        }
    }
    triangles.resize(kept);
    surface.origin.resize(kept);
    return any;
}

/// A triangle without area, its middle corner between the two others:
///
///       d              d             the flat triangle (a b c) and its neighbour (b a d) across
///      / \            /|\            the longest edge become (b c d) and (c a d)
///     a-c-b    ->    a-c-b
///
/// False when nothing was flipped. An edge c d that exists already is left alone.
bool flip_flats(FloatMesh& surface) {
    std::vector<mesh::Triangle>& triangles = surface.mesh.triangles;
    const PairTest test(surface.mesh);
    std::vector<std::uint32_t> flats;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        if (test.is_flat(triangles[i])) {
            flats.push_back(i);
        }
    }
    if (flats.empty()) {
        return false;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>
        sides;  // directed edge -> triangle
    const auto enter = [&](std::uint32_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
            sides[{triangles[i].at(k), triangles[i].at((k + 1) % 3)}] = i;
        }
    };
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        enter(i);
    }
    bool any = false;
    for (const std::uint32_t i : flats) {
        mesh::Triangle t = triangles[i];
        if (!test.is_flat(t)) {
            continue;  // flipped meanwhile
        }
        std::rotate(t.begin(),
                    t.begin() + static_cast<std::ptrdiff_t>(longest_edge(surface.mesh, t)),
                    t.end());
        const auto across = sides.find({t[1], t[0]});
        if (across == sides.end()) {
            continue;
        }
        const mesh::Triangle& n = triangles[across->second];
        const std::uint32_t d =
            *std::find_if(n.begin(), n.end(), [&](auto v) { return v != t[0] && v != t[1]; });
        if (d == t[2] || sides.contains({t[2], d}) || sides.contains({d, t[2]})) {
            continue;
        }
        const std::uint32_t neighbour = across->second;
        sides.erase({t[0], t[1]});
        sides.erase({t[1], t[0]});
        triangles[i] = {t[1], t[2], d};
        triangles[neighbour] = {t[2], t[0], d};
        enter(i);
        enter(neighbour);
        any = any || !test.is_flat(triangles[i]) || !test.is_flat(triangles[neighbour]);
    }
    return any;
}

void drop_unused_points(mesh::TriMesh& mesh) {
    std::vector<std::uint32_t> number(mesh.points.size(), 0);
    for (const mesh::Triangle& t : mesh.triangles) {
        for (const std::uint32_t corner : t) {
            number[corner] = 1;
        }
    }
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (number[i] != 0) {
            mesh.points[kept] = mesh.points[i];
            number[i] = kept++;
        }
    }
    mesh.points.resize(kept);
    for (mesh::Triangle& t : mesh.triangles) {
        t = {number[t[0]], number[t[1]], number[t[2]]};
    }
}

}  // namespace

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

WrittenReport check_written(const mesh::TriMesh& mesh, std::size_t intersections_at_most) {
    WrittenReport report;
    report.topology = mesh::check_topology(mesh);
    report.outward = mesh::volume_mm3(mesh) > 0;
    if (intersections_at_most > 0) {
        report.intersections = find_intersections(mesh, intersections_at_most);
    }
    return report;
}

FloatMesh float_mesh(const mesh::TriMesh& mesh) {
    mesh::TriMesh rounded = mesh;
    for (Eigen::Vector3d& p : rounded.points) {
        p = p.cast<float>().cast<double>();
    }
    const std::vector<std::uint32_t> first = first_of_equal(rounded.points);
    FloatMesh out;
    out.mesh.points = std::move(rounded.points);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const mesh::Triangle& t = mesh.triangles[i];
        const mesh::Triangle welded{first[t[0]], first[t[1]], first[t[2]]};
        if (welded[0] != welded[1] && welded[1] != welded[2] && welded[2] != welded[0]) {
            out.mesh.triangles.push_back(welded);
            out.origin.push_back(i);
        }
    }
    while (cancel_backs(out) || flip_flats(out)) {
    }
    drop_unused_points(out.mesh);
    return out;
}

}  // namespace decomp::cut
