// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/occt_detail.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace decomp::brep {

namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

/// Numbers the points of a triangulated solid. A point belongs to a vertex, to a place on an edge
/// or to the inside of a face; whoever asks for the same one gets the same number.
class Welder {
  public:
    explicit Welder(const TopoDS_Shape& solid) {
        TopExp::MapShapes(solid, TopAbs_VERTEX, vertices_);
        TopExp::MapShapes(solid, TopAbs_EDGE, edges_);
        vertex_point_.assign(static_cast<std::size_t>(vertices_.Extent()), kNone);
        edge_points_.resize(static_cast<std::size_t>(edges_.Extent()));
    }

    /// False where the mesher left no triangles.
    bool add(const TopoDS_Face& face) {
        TopLoc_Location place;
        const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, place);
        if (triangulation.IsNull()) {
            return false;
        }
        std::vector<std::uint32_t> number(static_cast<std::size_t>(triangulation->NbNodes()) + 1,
                                          kNone);
        for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
            number_edge(TopoDS::Edge(it.Current()), triangulation, place, number);
        }
        for (int node = 1; node <= triangulation->NbNodes(); ++node) {
            std::uint32_t& point = number[static_cast<std::size_t>(node)];
            point = point == kNone ? new_point(triangulation->Node(node), place) : point;
        }
        const bool reversed = face.Orientation() == TopAbs_REVERSED;
        for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
            std::array<int, 3> node{};
            triangulation->Triangle(i).Get(node[0], node[1], node[2]);
            mesh::Triangle triangle{number[static_cast<std::size_t>(node[0])],
                                    number[static_cast<std::size_t>(node[1])],
                                    number[static_cast<std::size_t>(node[2])]};
            if (reversed) {
                std::swap(triangle[1], triangle[2]);
            }
            // A triangle at a pole has two corners in one vertex.
            if (triangle[0] != triangle[1] && triangle[1] != triangle[2] &&
                triangle[2] != triangle[0]) {
                mesh_.triangles.push_back(triangle);
            }
        }
        return true;
    }

    [[nodiscard]] mesh::TriMesh take() { return std::move(mesh_); }

  private:
    std::uint32_t new_point(const gp_Pnt& node, const TopLoc_Location& place) {
        const gp_Pnt p = node.Transformed(place.Transformation());
        mesh_.points.emplace_back(p.X(), p.Y(), p.Z());
        return static_cast<std::uint32_t>(mesh_.points.size() - 1);
    }

    std::uint32_t vertex_point(const TopoDS_Vertex& vertex) {
        const int index = vertex.IsNull() ? 0 : vertices_.FindIndex(vertex);
        if (index == 0) {
            return kNone;
        }
        std::uint32_t& point = vertex_point_[static_cast<std::size_t>(index) - 1];
        if (point == kNone) {
            const gp_Pnt p = BRep_Tool::Pnt(vertex);
            mesh_.points.emplace_back(p.X(), p.Y(), p.Z());
            point = static_cast<std::uint32_t>(mesh_.points.size() - 1);
        }
        return point;
    }

    void number_edge(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & triangulation,
                     const TopLoc_Location& place, std::vector<std::uint32_t>& number) {
        // Of a seam the kernel gives the side that belongs to the edge's orientation.
        const Handle(Poly_PolygonOnTriangulation) polygon =
            BRep_Tool::PolygonOnTriangulation(edge, triangulation, place);
        const int index = edges_.FindIndex(edge);
        if (polygon.IsNull() || index == 0) {
            return;
        }
        TopoDS_Vertex first;
        TopoDS_Vertex last;
        TopExp::Vertices(edge, first, last);
        const auto count = static_cast<std::size_t>(polygon->NbNodes());
        const bool point_like = BRep_Tool::Degenerated(edge);
        auto& known = edge_points_[static_cast<std::size_t>(index) - 1];
        known.resize(std::max(known.size(), count), kNone);
        for (std::size_t k = 0; k < count; ++k) {
            const int node = polygon->Node(static_cast<int>(k) + 1);
            std::uint32_t point = kNone;
            if (point_like || k == 0) {
                point = vertex_point(first);
            } else if (k + 1 == count) {
                point = vertex_point(last);
            }
            if (point == kNone) {
                point = known[k] == kNone ? new_point(triangulation->Node(node), place) : known[k];
            }
            known[k] = point;
            number[static_cast<std::size_t>(node)] = point;
        }
    }

    TopTools_IndexedMapOfShape vertices_;
    TopTools_IndexedMapOfShape edges_;
    std::vector<std::uint32_t> vertex_point_;
    std::vector<std::vector<std::uint32_t>> edge_points_;
    mesh::TriMesh mesh_;
};

}  // namespace

Result<mesh::TriMesh> triangles_of(const TopoDS_Shape& solid, double deflection_mm, double angle,
                                   const std::string& where) {
    BRepTools::Clean(solid);
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection_mm;
    parameters.Angle = angle;
    parameters.Relative = false;
    parameters.InParallel = false;
    parameters.AllowQualityDecrease = true;
    const BRepMesh_IncrementalMesh mesher(solid, parameters);
    Welder welder(solid);
    int face = 0;
    for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
        ++face;
        if (!welder.add(TopoDS::Face(it.Current()))) {
            return fail("brep.not_meshed",
                        "face " + std::to_string(face) + " cannot be cut into triangles", where,
                        "heal the solid in a CAD program, or export it as STL there");
        }
    }
    return welder.take();
}

BodyFigures figures_of(const TopoDS_Shape& solid) {
    BodyFigures figures;
    figures.valid = BRepCheck_Analyzer(solid).IsValid();
    figures.closed = true;
    for (TopExp_Explorer it(solid, TopAbs_SHELL); it.More(); it.Next()) {
        figures.closed = figures.closed && BRep_Tool::IsClosed(it.Current());
    }
    GProp_GProps volume;
    BRepGProp::VolumeProperties(solid, volume);
    figures.volume_mm3 = volume.Mass();
    GProp_GProps area;
    BRepGProp::SurfaceProperties(solid, area);
    figures.area_mm2 = area.Mass();
    Bnd_Box box;
    BRepBndLib::AddOptimal(solid, box, false, false);
    if (!box.IsVoid()) {
        box.SetGap(0);
        box.Get(figures.min_mm.x(), figures.min_mm.y(), figures.min_mm.z(), figures.max_mm.x(),
                figures.max_mm.y(), figures.max_mm.z());
    }
    for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
        const BRepAdaptor_Surface surface(TopoDS::Face(it.Current()), false);
        ++figures.faces;
        if (surface.GetType() == GeomAbs_Plane) {
            ++figures.planes;
        } else if (surface.GetType() == GeomAbs_Cylinder) {
            ++figures.cylinders;
            figures.cylinder_radii_mm.push_back(surface.Cylinder().Radius());
        } else if (surface.GetType() == GeomAbs_Cone) {
            ++figures.cones;
        }
    }
    std::sort(figures.cylinder_radii_mm.begin(), figures.cylinder_radii_mm.end());
    return figures;
}

}  // namespace decomp::brep
