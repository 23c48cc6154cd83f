// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/occt_detail.h"

#include <BRep_Builder.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <ShapeFix_Wire.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

#include <cmath>
#include <numbers>

namespace decomp::brep {

namespace {

gp_Pnt point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

gp_Dir direction(const Eigen::Vector3d& d) { return {d.x(), d.y(), d.z()}; }

Handle(Geom_Curve) curve_of(const solid::Curve& curve) {
    if (const auto* line = std::get_if<solid::LineCurve>(&curve)) {
        return new Geom_Line(point(line->origin), direction(line->direction));
    }
    const auto& ellipse = std::get<solid::EllipseCurve>(curve);
    const gp_Ax2 place(point(ellipse.centre), direction(ellipse.major.cross(ellipse.minor)),
                       direction(ellipse.major));
    if (ellipse.circle) {
        return new Geom_Circle(place, ellipse.major.norm());
    }
    return new Geom_Ellipse(place, ellipse.major.norm(), ellipse.minor.norm());
}

Handle(Geom_Surface) surface_of(const solid::Surface& surface) {
    if (const auto* plane = std::get_if<solid::PlaneSurface>(&surface)) {
        return new Geom_Plane(point(plane->normal * plane->offset_mm), direction(plane->normal));
    }
    if (const auto* cylinder = std::get_if<solid::CylinderSurface>(&surface)) {
        return new Geom_CylindricalSurface(
            gp_Ax3(point(cylinder->origin), direction(cylinder->axis),
                   direction(solid::reference_direction(cylinder->axis))),
            cylinder->radius_mm);
    }
    const auto& cone = std::get<solid::ConeSurface>(surface);
    return new Geom_ConicalSurface(gp_Ax3(point(cone.apex), direction(cone.axis),
                                          direction(solid::reference_direction(cone.axis))),
                                   cone.half_angle, 0);
}

/// Makes the kernel's shape of a solid: every vertex and every edge once.
class ShapeMaker {
  public:
    explicit ShapeMaker(const solid::Solid& solid) : solid_(solid) {}

    TopoDS_Shape make() {
        for (const Eigen::Vector3d& p : solid_.vertices) {
            vertices_.emplace_back();
            builder_.MakeVertex(vertices_.back(), point(p), solid_.tolerance_mm);
        }
        for (const solid::Edge& edge : solid_.edges) {
            edges_.push_back(make_edge(edge));
        }
        for (const solid::Face& face : solid_.faces) {
            faces_.push_back(make_face(face));
        }
        std::vector<TopoDS_Solid> solids;
        for (std::size_t s = 0; s < solid_.shells.size(); ++s) {
            if (solid_.cavity_of[s] >= 0) {
                continue;
            }
            TopoDS_Solid made;
            builder_.MakeSolid(made);
            builder_.Add(made, make_shell(s));
            for (std::size_t inner = 0; inner < solid_.shells.size(); ++inner) {
                if (solid_.cavity_of[inner] == static_cast<std::int32_t>(s)) {
                    builder_.Add(made, make_shell(inner));
                }
            }
            solids.push_back(made);
        }
        if (solids.size() == 1) {
            return solids[0];
        }
        TopoDS_Compound all;
        builder_.MakeCompound(all);
        for (const TopoDS_Solid& one : solids) {
            builder_.Add(all, one);
        }
        return all;
    }

  private:
    [[nodiscard]] TopoDS_Edge make_edge(const solid::Edge& edge) const {
        TopoDS_Edge made;
        builder_.MakeEdge(made, curve_of(edge.curve), solid_.tolerance_mm);
        builder_.Add(made, vertices_[static_cast<std::size_t>(edge.from)].Oriented(TopAbs_FORWARD));
        builder_.Add(made, vertices_[static_cast<std::size_t>(edge.to)].Oriented(TopAbs_REVERSED));
        double start = edge.t0;
        if (!std::holds_alternative<solid::LineCurve>(edge.curve)) {
            start -= 2 * std::numbers::pi * std::floor(start / (2 * std::numbers::pi));
        }
        builder_.Range(made, start, start + edge.t1 - edge.t0);
        return made;
    }

    [[nodiscard]] TopoDS_Face make_face(const solid::Face& face) const {
        TopoDS_Face made;
        builder_.MakeFace(made, surface_of(face.surface), solid_.tolerance_mm);
        const bool curved = !std::holds_alternative<solid::PlaneSurface>(face.surface);
        for (const solid::Loop& loop : face.loops) {
            TopoDS_Wire wire;
            builder_.MakeWire(wire);
            // Loops run round the outside; on a surface that looks inward they run backward.
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const solid::EdgeUse& use = face.outward ? loop[i] : loop[loop.size() - 1 - i];
                const bool reversed = use.reversed == face.outward;
                builder_.Add(wire, edges_[static_cast<std::size_t>(use.edge)].Oriented(
                                       reversed ? TopAbs_REVERSED : TopAbs_FORWARD));
            }
            wire.Closed(true);
            if (curved) {
                const Handle(ShapeFix_Wire) fix =
                    new ShapeFix_Wire(wire, made, solid_.tolerance_mm);
                fix->FixEdgeCurvesMode() = 1;
                fix->FixEdgeCurves();
                fix->FixShifted();
                wire = fix->Wire();
            }
            builder_.Add(made, wire);
        }
        return made;
    }

    [[nodiscard]] TopoDS_Shell make_shell(std::size_t number) const {
        TopoDS_Shell shell;
        builder_.MakeShell(shell);
        for (const std::int32_t f : solid_.shells[number]) {
            const auto index = static_cast<std::size_t>(f);
            builder_.Add(shell,
                         faces_[index].Oriented(solid_.faces[index].outward ? TopAbs_FORWARD
                                                                            : TopAbs_REVERSED));
        }
        shell.Closed(true);
        return shell;
    }

    const solid::Solid& solid_;
    BRep_Builder builder_;
    std::vector<TopoDS_Vertex> vertices_;
    std::vector<TopoDS_Edge> edges_;
    std::vector<TopoDS_Face> faces_;
};

}  // namespace

TopoDS_Shape shape_of(const solid::Solid& solid) { return ShapeMaker(solid).make(); }

}  // namespace decomp::brep
