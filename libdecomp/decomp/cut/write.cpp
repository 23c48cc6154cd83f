// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/assert.h"
#include "decomp/base/parallel.h"
#include "decomp/cut/cells.h"
#include "decomp/cut/pinch.h"
#include "decomp/cut/planar.h"
#include "decomp/cut/shells.h"
#include "decomp/cut/written.h"
#include "decomp/mesh/measure.h"
#include "decomp/part/part_id.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

namespace decomp::cut {

namespace {

/// A self-intersection farther from every plane than this share of the diagonal is the input's own.
constexpr double kNearPlane = 1e-3;

/// Triangles of all faces, made once, so that both regions at a cap write the same ones.
using FaceTriangles = std::vector<std::vector<VertexTriangle>>;

/// The cells, or a copy with pinched edges bisected where there are any.
class Writable {
  public:
    explicit Writable(const Cells& cells) : cells_(&cells) {
        const std::vector<std::int32_t> pinched = pinched_edges(cells);
        if (!pinched.empty()) {
            opened_ = cells;
            bisect(*opened_, pinched);
            cells_ = &*opened_;
        }
    }

    Writable(const Writable&) = delete;
    Writable& operator=(const Writable&) = delete;

    [[nodiscard]] const Cells& cells() const { return *cells_; }

  private:
    const Cells* cells_;
    std::optional<Cells> opened_;
};

/// A triangle of a region, outward, with the face it belongs to.
struct Facet {
    VertexTriangle corners{};
    FaceSide side;
};

struct FacetEdge {
    std::int32_t low = -1;
    std::int32_t high = -1;
    std::int32_t facet = -1;
    bool forward = false;
};

std::vector<FacetEdge> sorted_edges(const std::vector<Facet>& facets) {
    std::vector<FacetEdge> edges;
    edges.reserve(facets.size() * 3);
    for (std::size_t i = 0; i < facets.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t a = facets[i].corners.at(k);
            const std::int32_t b = facets[i].corners.at((k + 1) % 3);
            edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(i), a < b});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const FacetEdge& l, const FacetEdge& r) {
        return std::tie(l.low, l.high, l.facet) < std::tie(r.low, r.high, r.facet);
    });
    return edges;
}

/// Corners of facets, united around a vertex where facets are joined across an edge: one set is one
/// umbrella.
class Umbrellas {
  public:
    explicit Umbrellas(const std::vector<Facet>& facets)
        : facets_(facets), parent_(facets.size() * 3) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    void join(const FacetEdge& a, const FacetEdge& b) {
        unite(corner(a.facet, a.low), corner(b.facet, b.low));
        unite(corner(a.facet, a.high), corner(b.facet, b.high));
    }

    std::size_t find(std::size_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }

  private:
    [[nodiscard]] std::size_t corner(std::int32_t facet, std::int32_t vertex) const {
        const VertexTriangle& c = facets_[static_cast<std::size_t>(facet)].corners;
        const auto k = static_cast<std::size_t>(std::find(c.begin(), c.end(), vertex) - c.begin());
        return 3 * static_cast<std::size_t>(facet) + k;
    }

    void unite(std::size_t a, std::size_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const std::vector<Facet>& facets_;
    std::vector<std::size_t> parent_;
};

/// Joins the facets across every edge; where more than two meet, those around the same wedge of
/// material.
void join_all(const Cells& cells, const std::vector<Facet>& facets, Umbrellas& umbrellas) {
    const std::vector<FacetEdge> edges = sorted_edges(facets);
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        for (end = begin; end < edges.size() && edges[end].low == edges[begin].low &&
                          edges[end].high == edges[begin].high;
             ++end) {
        }
        if (end - begin == 2) {
            umbrellas.join(edges[begin], edges[begin + 1]);
            continue;
        }
        std::vector<Wing> wings;
        for (std::size_t i = begin; i < end; ++i) {
            const FaceSide& side = facets[static_cast<std::size_t>(edges[i].facet)].side;
            wings.push_back({cells.face(side.face).carrier, side.flipped, edges[i].forward});
        }
        const std::vector<std::int32_t> partner =
            partners(cells, edges[begin].low, edges[begin].high, wings);
        for (std::size_t i = 0; i < partner.size(); ++i) {
            if (partner[i] >= 0) {
                umbrellas.join(edges[begin + i],
                               edges[begin + static_cast<std::size_t>(partner[i])]);
            }
        }
    }
}

/// Writes one region: each umbrella gets a point of its own, in the order of vertices.
part::Part written(const Cells& cells, std::int32_t region, const FaceTriangles& triangles) {
    std::vector<Facet> facets;
    for (const FaceSide& side : sides_of(cells, region)) {
        for (VertexTriangle t : triangles[static_cast<std::size_t>(side.face)]) {
            if (side.flipped) {
                std::swap(t[1], t[2]);
            }
            facets.push_back({t, side});
        }
    }
    Umbrellas umbrellas(facets);
    join_all(cells, facets, umbrellas);
    std::vector<std::pair<std::int32_t, std::size_t>> roots;  // vertex, umbrella
    for (std::size_t i = 0; i < facets.size() * 3; ++i) {
        if (umbrellas.find(i) == i) {
            roots.emplace_back(facets[i / 3].corners.at(i % 3), i);
        }
    }
    std::sort(roots.begin(), roots.end());
    part::Part out;
    std::vector<std::uint32_t> index(facets.size() * 3);
    for (std::size_t i = 0; i < roots.size(); ++i) {
        index[roots[i].second] = static_cast<std::uint32_t>(i);
        out.mesh.points.push_back(cells.point(roots[i].first));
    }
    for (std::size_t i = 0; i < facets.size(); ++i) {
        mesh::Triangle t{};
        for (std::size_t k = 0; k < 3; ++k) {
            t.at(k) = index[umbrellas.find(3 * i + k)];
        }
        out.mesh.triangles.push_back(t);
        const Face& face = cells.face(facets[i].side.face);
        out.sources.push_back(face.carrier.is_plane
                                  ? part::FacetSource{face.carrier.index, face.inside == region
                                                                              ? face.outside
                                                                              : face.inside}
                                  : part::FacetSource{});
    }
    return out;
}

/// Triangulates the faces that `wanted` names.
Result<FaceTriangles> triangulate(const Cells& cells, const Run& run, const auto& wanted) {
    std::vector<std::optional<Error>> errors(cells.faces.size());
    FaceTriangles out(cells.faces.size());
    for_each_index(run, cells.faces.size(), [&](std::size_t i) {
        if (wanted(cells.faces[i])) {
            Result<std::vector<VertexTriangle>> triangles = triangles_of(cells, cells.faces[i]);
            if (triangles) {
                out[i] = std::move(*triangles);
            } else {
                errors[i] = triangles.error();
            }
        }
    });
    for (const std::optional<Error>& error : errors) {
        if (error) {
            return fail(*error);
        }
    }
    return out;
}

/// Sources with the indices of the assembly instead of those of the complex.
void renumber(part::Assembly& assembly, const Cells& cells,
              const std::vector<std::int32_t>& order) {
    std::vector<std::int32_t> part_of(static_cast<std::size_t>(cells.regions), -1);
    for (std::size_t i = 0; i < order.size(); ++i) {
        part_of[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
    }
    std::vector<std::int32_t> plane_of(cells.planes.size(), -1);
    for (const part::Part& p : assembly.parts) {
        for (const part::FacetSource& source : p.sources) {
            if (source.is_cut()) {
                plane_of[static_cast<std::size_t>(source.plane)] = 0;
            }
        }
    }
    for (std::size_t i = 0; i < plane_of.size(); ++i) {
        if (plane_of[i] == 0) {
            plane_of[i] = static_cast<std::int32_t>(assembly.planes.size());
            assembly.planes.push_back(cells.planes[i]);
        }
    }
    for (part::Part& p : assembly.parts) {
        for (part::FacetSource& source : p.sources) {
            if (source.is_cut()) {
                source = {plane_of[static_cast<std::size_t>(source.plane)],
                          part_of[static_cast<std::size_t>(source.neighbour)]};
            }
        }
    }
}

void collect_interfaces(part::Assembly& assembly) {
    std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, double> areas;
    for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
        const part::Part& p = assembly.parts[i];
        for (std::size_t t = 0; t < p.sources.size(); ++t) {
            const auto here = static_cast<std::int32_t>(i);
            if (p.sources[t].is_cut() && here < p.sources[t].neighbour) {
                areas[{here, p.sources[t].neighbour, p.sources[t].plane}] +=
                    mesh::double_area_normal(p.mesh, t).norm() / 2;
            }
        }
    }
    for (const auto& [key, area] : areas) {
        assembly.interfaces.push_back({std::get<2>(key), std::get<0>(key), std::get<1>(key), area});
    }
}

/// Least distance of a triangle's corners from a plane.
double distance_mm(const part::Plane& plane, const mesh::TriMesh& mesh, std::uint32_t triangle) {
    double least = HUGE_VAL;
    for (const std::uint32_t corner : mesh.triangles[triangle]) {
        least = std::min(least, std::abs(plane.normal.dot(mesh.points[corner]) - plane.offset_mm));
    }
    return least / plane.normal.norm();
}

/// The plane to blame for triangles that meet: one that they lie in, or else the nearest that cuts
/// the part, if it is near; -1 for the input surface.
std::int32_t plane_behind(const Cells& cells, const part::Part& part,
                          const std::array<std::uint32_t, 2>& triangles) {
    std::set<std::int32_t> cuts;
    for (const part::FacetSource& source : part.sources) {
        if (source.is_cut()) {
            cuts.insert(source.plane);
        }
    }
    std::int32_t nearest = -1;
    double least = kNearPlane * mesh::diagonal_mm(part.mesh);
    for (const std::uint32_t triangle : triangles) {
        if (part.sources[triangle].is_cut()) {
            return part.sources[triangle].plane;
        }
        for (const std::int32_t cut : cuts) {
            const double distance =
                distance_mm(cells.planes[static_cast<std::size_t>(cut)], part.mesh, triangle);
            if (distance < least) {
                nearest = cut;
                least = distance;
            }
        }
    }
    return nearest;
}

Error rounding_error(const Cells& cells, const part::Part& part,
                     const std::array<std::uint32_t, 2>& triangles, const char* rounded_to) {
    const std::int32_t plane = plane_behind(cells, part, triangles);
    const std::string place = plane < 0 ? "the input surface" : "plane " + std::to_string(plane);
    return {
        "cut.rounding_intersects",
        std::string("the part intersects itself once its coordinates are rounded to ") + rounded_to,
        part.id + ", " + place,
        plane < 0 ? "repair the mesh after rounding it to float"
                  : "shift the plane a little: hundred-thousandths of the diagonal",
        {}};
}

/// The part with equal points as one: what rounding to float may not make worse.
mesh::TopologyReport welded_topology(const mesh::TriMesh& mesh) {
    mesh::TriMesh welded = mesh;
    const std::vector<std::uint32_t> first = first_of_equal(mesh.points);
    for (mesh::Triangle& t : welded.triangles) {
        t = {first[t[0]], first[t[1]], first[t[2]]};
    }
    return mesh::check_topology(welded);
}

/// Checks a part as double and as an STL carries it.
std::optional<Error> fault_of(const Cells& cells, const part::Part& part) {
    const WrittenReport whole = check_written(part.mesh);
    if (!whole.topology.manifold() || !whole.outward) {
        return Error{"cut.not_a_volume",
                     "a written part is not a closed manifold",
                     part.id,
                     "repair the mesh first",
                     {}};
    }
    if (!whole.intersections.empty()) {
        const auto& [a, b] = whole.intersections.front();
        return rounding_error(cells, part, {a, b}, "double");
    }
    const FloatMesh stl = float_mesh(part.mesh);
    const WrittenReport single = check_written(stl.mesh);
    if (!single.intersections.empty()) {
        const auto& [a, b] = single.intersections.front();
        return rounding_error(cells, part, {stl.origin[a], stl.origin[b]}, "float");
    }
    if (!single.topology.manifold()) {
        const mesh::TopologyReport before = welded_topology(part.mesh);
        if (!single.topology.closed() || !single.outward ||
            single.topology.non_manifold_edges > before.non_manifold_edges ||
            single.topology.misoriented_edges > before.misoriented_edges ||
            single.topology.non_manifold_vertices > before.non_manifold_vertices) {
            return rounding_error(cells, part, {0, 0}, "float");
        }
    }
    return std::nullopt;
}

Status check_order(const Cells& cells, const std::vector<std::int32_t>& order) {
    std::vector<std::int32_t> listed(static_cast<std::size_t>(cells.regions), 0);
    for (const std::int32_t region : order) {
        if (region < 0 || region >= cells.regions ||
            ++listed[static_cast<std::size_t>(region)] > 1) {
            return fail("cut.bad_order", "a region is listed twice or does not exist",
                        std::to_string(region));
        }
    }
    for (const Face& face : cells.faces) {
        for (const std::int32_t region : {face.inside, face.outside}) {
            if (region >= 0 && listed[static_cast<std::size_t>(region)] == 0) {
                return fail("cut.bad_order", "a region is not listed", std::to_string(region));
            }
        }
    }
    return {};
}

}  // namespace

part::Part Complex::region(std::int32_t region) const {
    const Writable writable(*state_);
    const Cells& cells = writable.cells();
    const Result<FaceTriangles> triangles =
        triangulate(cells, Run{}, [&](const Face& face) { return face.bounds(region); });
    DECOMP_ASSERT(triangles.has_value());
    return written(cells, region, *triangles);
}

Result<part::Assembly> Complex::assemble(const std::vector<std::int32_t>& order,
                                         const Run& run) const {
    const Writable writable(*state_);
    const Cells& cells = writable.cells();
    if (Status sound = check_order(cells, order); !sound) {
        return fail(sound.error());
    }
    const Result<FaceTriangles> triangles =
        triangulate(cells, run, [](const Face&) { return true; });
    if (!triangles) {
        return fail(triangles.error());
    }
    part::Assembly assembly;
    assembly.parts.resize(order.size());
    for_each_index(run, order.size(), [&](std::size_t i) {
        assembly.parts[i] = written(cells, order[i], *triangles);
        assembly.parts[i].id = part::part_id(i);
    });
    std::vector<std::optional<Error>> faults(order.size());
    for_each_index(run, order.size(),
                   [&](std::size_t i) { faults[i] = fault_of(cells, assembly.parts[i]); });
    if (run.cancelled()) {
        return cancelled();
    }
    for (const std::optional<Error>& fault : faults) {
        if (fault) {
            return fail(*fault);
        }
    }
    renumber(assembly, cells, order);
    collect_interfaces(assembly);
    return assembly;
}

}  // namespace decomp::cut
