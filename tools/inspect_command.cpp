// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/file.h"
#include "decomp/base/number.h"
#include "decomp/brep/read_brep.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/intersect.h"
#include "decomp/repair/repair.h"
#include "tools/job_options.h"
#include "tools/verb.h"

#include <filesystem>
#include <memory>
#include <numbers>

namespace tools {

namespace {

constexpr std::size_t kIntersectionsCounted = 10000;

struct Command {
    std::filesystem::path model;
    decomp::io::ReadOptions read;
    double angle_deg = 20;
};

/// What the geometry kernel says of the solids of a STEP or BREP file.
void describe_bodies(const std::vector<decomp::brep::Body>& bodies, Answer& answer) {
    answer.json["bodies"] = Json::array();
    for (const decomp::brep::Body& body : bodies) {
        const decomp::brep::BodyFigures& figures = body.figures;
        Json colour = nullptr;
        if (body.colour) {
            colour = {(*body.colour)[0], (*body.colour)[1], (*body.colour)[2]};
        }
        answer.json["bodies"].push_back(
            {{"name", body.name},
             {"colour", colour},
             {"valid", figures.valid},
             {"closed", figures.closed},
             {"volume_mm3", figures.volume_mm3},
             {"area_mm2", figures.area_mm2},
             {"min_mm", {figures.min_mm.x(), figures.min_mm.y(), figures.min_mm.z()}},
             {"max_mm", {figures.max_mm.x(), figures.max_mm.y(), figures.max_mm.z()}},
             {"faces", figures.faces},
             {"planes", figures.planes},
             {"cylinders", figures.cylinders},
             {"cones", figures.cones},
             {"cylinder_radii_mm", figures.cylinder_radii_mm}});
        answer.text += "body '" + body.name + "': " + std::to_string(figures.faces) + " faces (" +
                       std::to_string(figures.planes) + " planes, " +
                       std::to_string(figures.cylinders) + " cylinders, " +
                       std::to_string(figures.cones) + " cones), " +
                       decomp::decimal(figures.volume_mm3 / 1000, 3) + " cm3, " +
                       (figures.valid && figures.closed ? "valid" : "NOT valid") + "\n";
    }
}

/// Appends the bodies where the file has any. The file is read once more: only this verb wants both
/// the triangles and the exact figures.
decomp::Status add_bodies(const Command& command, const decomp::Run& run, Answer& answer) {
    const auto bytes = decomp::read_file(command.model);
    if (!bytes) {
        return decomp::fail(bytes.error());
    }
    if (!decomp::brep::kind_of(*bytes)) {
        return {};
    }
    const auto bodies = decomp::brep::read_brep(*bytes, command.model.string(),
                                                {.deflection_mm = command.read.deflection_mm,
                                                 .angle = command.read.angle,
                                                 .body = command.read.body,
                                                 .measured = true},
                                                run);
    if (!bodies) {
        return decomp::fail(bodies.error());
    }
    describe_bodies(*bodies, answer);
    return {};
}

Json topology_json(const decomp::mesh::TopologyReport& topology) {
    return {{"closed", topology.closed()},
            {"manifold", topology.manifold()},
            {"components", topology.components},
            {"euler_characteristic", topology.euler_characteristic},
            {"border_edges", topology.border_edges},
            {"non_manifold_edges", topology.non_manifold_edges},
            {"non_manifold_vertices", topology.non_manifold_vertices},
            {"misoriented_edges", topology.misoriented_edges},
            {"degenerate_triangles", topology.degenerate_triangles}};
}

std::string counted(std::size_t count, const std::string& what) {
    return count == 0 ? std::string() : "  " + std::to_string(count) + " " + what + "\n";
}

std::string text_of(const decomp::mesh::TriMesh& mesh, const decomp::mesh::TopologyReport& topology,
                    std::size_t intersections) {
    const Eigen::AlignedBox3d box = decomp::mesh::bounds(mesh);
    const Eigen::Vector3d size = box.sizes();
    std::string text = std::to_string(mesh.triangles.size()) + " triangles, " +
                       std::to_string(mesh.points.size()) + " points, " +
                       std::to_string(topology.components) +
                       (topology.components == 1 ? " piece\n" : " pieces\n");
    text += decomp::decimal(size.x(), 3) + " x " + decomp::decimal(size.y(), 3) + " x " +
            decomp::decimal(size.z(), 3) + " mm, " +
            decomp::decimal(decomp::mesh::volume_mm3(mesh) / 1000, 3) + " cm3, " +
            decomp::decimal(decomp::mesh::area_mm2(mesh) / 100, 3) + " cm2\n";
    text += topology.manifold() && intersections == 0 ? "a sound solid\n" : "not a sound solid:\n";
    return text + counted(topology.border_edges, "open edges") +
           counted(topology.non_manifold_edges, "edges with more than two triangles") +
           counted(topology.non_manifold_vertices, "points where surfaces merely touch") +
           counted(topology.misoriented_edges, "edges between triangles of opposite sense") +
           counted(topology.degenerate_triangles, "triangles without area") +
           counted(intersections, "pairs of triangles that cross");
}

decomp::Result<Answer> inspect(Command command, const decomp::Run& run) {
    command.read.angle = command.angle_deg * std::numbers::pi / 180;
    const auto mesh = decomp::io::read_mesh(command.model, command.read, run);
    if (!mesh) {
        return decomp::fail(mesh.error());
    }
    const auto topology = decomp::mesh::check_topology(*mesh);
    const std::size_t intersections =
        decomp::repair::self_intersections(*mesh, kIntersectionsCounted).size();
    const auto repaired = decomp::repair::repair(*mesh, {}, run);
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    const Eigen::AlignedBox3d box = decomp::mesh::bounds(*mesh);
    Answer answer;
    answer.json["file"] = command.model.string();
    answer.json["triangles"] = mesh->triangles.size();
    answer.json["points"] = mesh->points.size();
    answer.json["min_mm"] = {box.min().x(), box.min().y(), box.min().z()};
    answer.json["max_mm"] = {box.max().x(), box.max().y(), box.max().z()};
    answer.json["volume_mm3"] = decomp::mesh::volume_mm3(*mesh);
    answer.json["area_mm2"] = decomp::mesh::area_mm2(*mesh);
    answer.json["topology"] = topology_json(topology);
    answer.json["crossing_pairs"] = intersections;
    answer.text = text_of(*mesh, topology, intersections);
    if (const auto added = add_bodies(command, run, answer); !added) {
        return decomp::fail(added.error());
    }
    if (!repaired) {
        answer.json["repair"] = {{"possible", false},
                                 {"code", repaired.error().code},
                                 {"message", repaired.error().message}};
        answer.text += "repair is not possible: " + repaired.error().text() + "\n";
        return answer;
    }
    const auto& report = repaired->report;
    answer.json["repair"] = {{"possible", true},
                             {"status", decomp::repair::name_of(report.status)},
                             {"changes", report.changes},
                             {"volume_mm3", report.volume_after_mm3},
                             {"hausdorff_mm", report.hausdorff_mm}};
    answer.text += "repair: " + std::string(decomp::repair::name_of(report.status)) + "\n";
    for (const std::string& change : report.changes) {
        answer.text += "  " + change + "\n";
    }
    return answer;
}

}  // namespace

Action declare_inspect(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("model", command->model, "STL, OBJ, OFF, PLY, 3MF, Medit .mesh, STEP or BREP")
        ->required();
    app.add_option("--unit", command->read.unit, "length unit of the file: mm, cm, m, in")
        ->group("Model");
    app.add_option("--scale", command->read.scale, "factor on all lengths")
        ->check(CLI::PositiveNumber)
        ->group("Model");
    add_solid_options(app, command->read.body, command->read.deflection_mm, command->angle_deg);
    return [command](const decomp::Run& run) { return inspect(*command, run); };
}

}  // namespace tools
