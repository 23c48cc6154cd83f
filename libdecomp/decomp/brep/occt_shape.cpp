// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/occt_detail.h"

#include <BRep_Builder.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <ShapeFix_Wire.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

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

/// Where a curved surface is laid out from: a point off its axis, at angle 0.
gp_Ax3 place_of(const Eigen::Vector3d& on_axis, const Eigen::Vector3d& axis,
                const Eigen::Vector3d& start) {
    const Eigen::Vector3d d = start - on_axis;
    const Eigen::Vector3d out = d - axis * axis.dot(d);
    return {point(on_axis), direction(axis),
            direction(out.norm() > 0 ? out : solid::reference_direction(axis))};
}

/// @param start where the face's angle about the axis begins
Handle(Geom_Surface) surface_of(const solid::Surface& surface, const Eigen::Vector3d& start) {
    if (const auto* plane = std::get_if<solid::PlaneSurface>(&surface)) {
        return new Geom_Plane(point(plane->normal * plane->offset_mm), direction(plane->normal));
    }
    if (const auto* cylinder = std::get_if<solid::CylinderSurface>(&surface)) {
        return new Geom_CylindricalSurface(place_of(cylinder->origin, cylinder->axis, start),
                                           cylinder->radius_mm);
    }
    // From there and not from the apex, which may be far away.
    if (const auto* torus = std::get_if<solid::TorusSurface>(&surface)) {
        return new Geom_ToroidalSurface(place_of(torus->centre, torus->axis, start),
                                        torus->major_mm, torus->minor_mm);
    }
    const auto& cone = std::get<solid::ConeSurface>(surface);
    const double height = cone.axis.dot(start - cone.apex);
    return new Geom_ConicalSurface(place_of(cone.apex + height * cone.axis, cone.axis, start),
                                   cone.half_angle, height * std::tan(cone.half_angle));
}

/// Half a turn about the axis away from p.
Eigen::Vector3d opposite(const solid::Surface& surface, const Eigen::Vector3d& p) {
    if (const auto* cylinder = std::get_if<solid::CylinderSurface>(&surface)) {
        const Eigen::Vector3d d = p - cylinder->origin;
        return cylinder->origin + 2 * cylinder->axis * cylinder->axis.dot(d) - d;
    }
    if (const auto* cone = std::get_if<solid::ConeSurface>(&surface)) {
        const Eigen::Vector3d d = p - cone->apex;
        return cone->apex + 2 * cone->axis * cone->axis.dot(d) - d;
    }
    if (const auto* torus = std::get_if<solid::TorusSurface>(&surface)) {
        const Eigen::Vector3d d = p - torus->centre;
        return torus->centre + 2 * torus->axis * torus->axis.dot(d) - d;
    }
    return p;
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

    [[nodiscard]] Eigen::Vector3d point_of(std::int32_t edge, double share) const {
        const solid::Edge& of = solid_.edges[static_cast<std::size_t>(edge)];
        return solid::point_at(of.curve, of.t0 + share * (of.t1 - of.t0));
    }

    /// Where a curved face shall have angle 0: on its seam, or opposite to its middle. The kernel's
    /// mesher leaves cones without triangles that go past a full turn.
    [[nodiscard]] Eigen::Vector3d start_of(const solid::Face& face) const {
        const solid::Loop& outer = face.loops.at(0);
        std::vector<std::int32_t> seen;
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const solid::EdgeUse& use : outer) {
            if (std::find(seen.begin(), seen.end(), use.edge) != seen.end()) {
                return point_of(use.edge, 0);
            }
            seen.push_back(use.edge);
            middle += (point_of(use.edge, 0.25) + point_of(use.edge, 0.75)) /
                      (2 * static_cast<double>(outer.size()));
        }
        return opposite(face.surface, middle);
    }

    [[nodiscard]] TopoDS_Face make_face(const solid::Face& face) const {
        TopoDS_Face made;
        builder_.MakeFace(made, surface_of(face.surface, start_of(face)), solid_.tolerance_mm);
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
                fix->FixDegenerated();  // the apex of a cone
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
