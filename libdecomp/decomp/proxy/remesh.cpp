// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/proxy/remesh.h"

#include "decomp/proxy/thickness.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <numeric>
#include <vector>

namespace decomp::proxy {

namespace {

namespace processing = CGAL::Polygon_mesh_processing;
namespace collapse = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using EdgeFlags = Surface::Property_map<Surface::Edge_index, bool>;

constexpr unsigned kRemeshPasses = 4;
constexpr unsigned kRelaxationSteps = 2;
constexpr double kTunnelEdge = 0.5;  // of the edge length
constexpr int kTunnelRings = 3;
constexpr double kLeastChain = 4;  // edge lengths: shorter chains of sharp edges are noise

bool fill(Surface& surface, const mesh::TriMesh& mesh) {
    std::vector<Surface::Vertex_index> vertices;
    vertices.reserve(mesh.points.size());
    for (const auto& p : mesh.points) {
        vertices.push_back(surface.add_vertex({p.x(), p.y(), p.z()}));
    }
    for (const auto& t : mesh.triangles) {
        if (surface.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) ==
            Surface::null_face()) {
            return false;
        }
    }
    return true;
}

mesh::TriMesh read_back(Surface& surface) {
    surface.collect_garbage();
    mesh::TriMesh out;
    out.points.reserve(surface.number_of_vertices());
    out.triangles.reserve(surface.number_of_faces());
    for (const auto vertex : surface.vertices()) {
        const auto& p = surface.point(vertex);
        out.points.emplace_back(p.x(), p.y(), p.z());
    }
    for (const auto face : surface.faces()) {
        mesh::Triangle triangle{};
        auto halfedge = surface.halfedge(face);
        for (auto& corner : triangle) {
            corner = static_cast<std::uint32_t>(surface.target(halfedge));
            halfedge = surface.next(halfedge);
        }
        out.triangles.push_back(triangle);
    }
    return out;
}

double length(const Surface& surface, Surface::Edge_index edge) {
    const auto halfedge = surface.halfedge(edge);
    return std::sqrt(CGAL::squared_distance(surface.point(surface.source(halfedge)),
                                            surface.point(surface.target(halfedge))));
}

/// Takes the flag from chains (edges connected by their ends) that are shorter in total.
void drop_short_chains(const Surface& surface, EdgeFlags& sharp, double least_mm) {
    std::vector<std::uint32_t> parent(surface.number_of_vertices());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) {
            i = parent[i] = parent[parent[i]];
        }
        return i;
    };
    const auto end = [&](Surface::Edge_index edge, unsigned side) {
        return static_cast<std::uint32_t>(surface.vertex(edge, side));
    };
    for (const auto edge : surface.edges()) {
        if (sharp[edge]) {
            parent[root(end(edge, 0))] = root(end(edge, 1));
        }
    }
    std::vector<double> total(surface.number_of_vertices(), 0);
    for (const auto edge : surface.edges()) {
        if (sharp[edge]) {
            total[root(end(edge, 0))] += length(surface, edge);
        }
    }
    for (const auto edge : surface.edges()) {
        sharp[edge] = sharp[edge] && total[root(end(edge, 0))] >= least_mm;
    }
}

/// The marked faces and those that share an edge with one.
std::vector<bool> grown_by_a_ring(const Surface& surface, const std::vector<bool>& marked) {
    std::vector<bool> grown = marked;
    for (const auto face : surface.faces()) {
        for (const auto other : surface.faces_around_face(surface.halfedge(face))) {
            if (other != Surface::null_face() && marked[other]) {
                grown[face] = true;
            }
        }
    }
    return grown;
}

/// Faces that neither line a tunnel narrower than that nor lie within some rings of such.
std::vector<Surface::Face_index> away_from_tunnels(Surface& surface, double narrow_mm) {
    const std::vector<double> widths = tunnel_widths_mm(read_back(surface), 1);
    std::vector<bool> fine(surface.number_of_faces(), false);
    for (std::size_t f = 0; f < widths.size(); ++f) {
        fine[f] = widths[f] < narrow_mm;
    }
    for (int ring = 0; ring < kTunnelRings; ++ring) {
        fine = grown_by_a_ring(surface, fine);
    }
    std::vector<Surface::Face_index> coarse;
    for (const auto face : surface.faces()) {
        if (!fine[face]) {
            coarse.push_back(face);
        }
    }
    return coarse;
}

}  // namespace

std::optional<mesh::TriMesh> collapsed(const mesh::TriMesh& mesh, std::size_t triangles) {
    try {
        Surface surface;
        if (!fill(surface, mesh)) {
            return std::nullopt;
        }
        collapse::edge_collapse(surface, collapse::Count_stop_predicate<Surface>(triangles * 3 / 2),
                                CGAL::parameters::get_cost(collapse::LindstromTurk_cost<Surface>())
                                    .get_placement(collapse::LindstromTurk_placement<Surface>())
                                    .filter(collapse::Bounded_normal_change_filter<>()));
        return read_back(surface);
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

std::optional<mesh::TriMesh> remeshed(const mesh::TriMesh& mesh, const RemeshOptions& options) {
    try {
        Surface surface;
        if (!fill(surface, mesh)) {
            return std::nullopt;
        }
        EdgeFlags sharp =
            surface.add_property_map<Surface::Edge_index, bool>("e:sharp", false).first;
        processing::detect_sharp_edges(surface, options.sharp_angle_deg, sharp);
        drop_short_chains(surface, sharp, kLeastChain * options.edge_mm);
        const auto mesh_evenly = [&](const auto& faces, double edge_mm) {
            processing::isotropic_remeshing(faces, edge_mm, surface,
                                            CGAL::parameters::number_of_iterations(kRemeshPasses)
                                                .number_of_relaxation_steps(kRelaxationSteps)
                                                .edge_is_constrained_map(sharp));
        };
        if (options.fine_tunnels) {
            mesh_evenly(surface.faces(), kTunnelEdge * options.edge_mm);
            surface.collect_garbage();
            mesh_evenly(away_from_tunnels(surface, kNarrowEdges * options.edge_mm),
                        options.edge_mm);
        } else {
            mesh_evenly(surface.faces(), options.edge_mm);
        }
        return read_back(surface);
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace decomp::proxy
