// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/file.h"
#include "decomp/mesh/measure.h"
#include "tests/support/shapes.h"

#include <Eigen/Geometry>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Programs of other slicers for shapes made in code, on a 227 x 148 x 150 mm bed with the origin
/// in its middle.
namespace tests {

/// Half a bumpy sphere on its flat side: the shape of a part cut from a statue.
inline TriMesh bumpy_dome(std::uint32_t around, std::uint32_t rings, double radius,
                          double amplitude, double waves) {
    TriMesh mesh;
    mesh.points.emplace_back(0, 0, radius);
    for (std::uint32_t r = 1; r <= rings; ++r) {
        const double polar = std::numbers::pi / 2 * r / rings;
        for (std::uint32_t a = 0; a < around; ++a) {
            const double turn = 2 * std::numbers::pi * a / around;
            const double reach = radius * (1 + amplitude * std::sin(waves * turn) *
                                                   std::sin(waves * polar) * std::sin(polar));
            mesh.points.emplace_back(reach * std::sin(polar) * std::cos(turn),
                                     reach * std::sin(polar) * std::sin(turn),
                                     r == rings ? 0 : reach * std::cos(polar));
        }
    }
    const auto centre = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.emplace_back(0, 0, 0);
    const auto at = [&](std::uint32_t ring, std::uint32_t a) {
        return 1 + (ring - 1) * around + a % around;
    };
    for (std::uint32_t a = 0; a < around; ++a) {
        mesh.triangles.push_back({0, at(1, a), at(1, a + 1)});
        for (std::uint32_t r = 1; r < rings; ++r) {
            mesh.triangles.push_back({at(r, a), at(r + 1, a), at(r + 1, a + 1)});
            mesh.triangles.push_back({at(r, a), at(r + 1, a + 1), at(r, a + 1)});
        }
        mesh.triangles.push_back({centre, at(rings, a + 1), at(rings, a)});
    }
    return mesh;
}

/// An L of 80 x 40 x 60 mm with legs of 20 mm.
inline TriMesh l_block() {
    const std::vector<std::array<double, 2>> corners = {{0, 0},   {80, 0},  {80, 20},
                                                        {20, 20}, {20, 60}, {0, 60}};
    TriMesh mesh;
    for (const double y : {0.0, 40.0}) {
        for (const auto& [x, z] : corners) {
            mesh.points.emplace_back(x, y, z);
        }
    }
    for (const auto& t :
         std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
        mesh.triangles.push_back(t);
        mesh.triangles.push_back({t[0] + 6, t[2] + 6, t[1] + 6});
    }
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        mesh.triangles.push_back({i, i + 6, j + 6});
        mesh.triangles.push_back({i, j + 6, j});
    }
    return mesh;
}

/// The mesh as slicers place it: middle of its bounds over the middle of the bed.
inline TriMesh centred(TriMesh mesh) {
    const Eigen::AlignedBox3d box = decomp::mesh::bounds(mesh);
    for (auto& point : mesh.points) {
        point -= Eigen::Vector3d(box.center().x(), box.center().y(), box.min().z());
    }
    return mesh;
}

inline std::string stl_of(const TriMesh& mesh) {
    std::string bytes(80, '\0');
    const auto put = [&](const void* value, std::size_t size) {
        bytes.append(static_cast<const char*>(value), size);
    };
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    put(&count, 4);
    for (const auto& triangle : mesh.triangles) {
        // True normals: a file whose first bytes are all below 128 is taken for text by
        // PrusaSlicer.
        const Eigen::Vector3d& a = mesh.points[triangle[0]];
        const Eigen::Vector3f normal = (mesh.points[triangle[1]] - a)
                                           .cross(mesh.points[triangle[2]] - a)
                                           .normalized()
                                           .cast<float>();
        put(normal.data(), 12);
        for (const std::uint32_t v : triangle) {
            const Eigen::Vector3f point = mesh.points[v].cast<float>();
            put(point.data(), 12);
        }
        bytes.append(2, '\0');
    }
    return bytes;
}

inline bool runs(const std::string& command) {
    return std::system((command + " > /dev/null 2>&1").c_str()) == 0;
}

/// Resources of Cura: $HEW_CURA_RESOURCES, an installed Cura, or the unpacked Debian package.
inline std::optional<std::string> cura_resources() {
    const char* told = std::getenv("HEW_CURA_RESOURCES");
    const std::string cache = std::string(HEW_ORACLE_CACHE) + "/cura";
    const std::vector<std::string> places = {told != nullptr ? told : "",
                                             "/usr/share/cura/resources",
                                             cache + "/usr/share/cura/resources"};
    for (int attempt = 0; attempt < 2; ++attempt) {
        for (const std::string& place : places) {
            if (!place.empty() &&
                std::filesystem::exists(place + "/definitions/fdmprinter.def.json")) {
                return place;
            }
        }
        if (attempt == 0 &&
            !runs(std::string(HEW_ORACLE_SCRIPTS) + "/cura_definitions.sh " + cache)) {
            break;
        }
    }
    return std::nullopt;
}

/// The program of PrusaSlicer for this mesh, or nothing where it is not installed.
inline std::optional<std::string> prusa_program(const std::string& name, const TriMesh& mesh) {
    if (!runs("command -v prusa-slicer")) {
        return std::nullopt;
    }
    const std::filesystem::path folder =
        std::filesystem::path(HEW_ORACLE_CACHE) / ("prusa-" + name);
    std::filesystem::create_directories(folder);
    static constexpr const char* kSettings =
        "bed_shape = -113.5x-74,113.5x-74,113.5x74,-113.5x74\nmax_print_height = 150\ngcode_flavor "
        "= sailfish\n"
        "nozzle_diameter = 0.4\nfilament_diameter = 1.75\ntemperature = "
        "210\nfirst_layer_temperature = 215\n"
        "bed_temperature = 60\nfirst_layer_bed_temperature = 60\nlayer_height = "
        "0.2\nfirst_layer_height = 0.2\n"
        "perimeters = 3\nfill_density = 15%\nfill_pattern = grid\ntop_solid_layers = "
        "4\nbottom_solid_layers = 4\n"
        "skirts = 1\nbrim_width = 0\nperimeter_speed = 45\nexternal_perimeter_speed = 30\n"
        "small_perimeter_speed = 20\ninfill_speed = 60\nsolid_infill_speed = "
        "50\ntop_solid_infill_speed = 40\n"
        "bridge_speed = 40\ngap_fill_speed = 30\ntravel_speed = 120\nfirst_layer_speed = 20\n"
        "retract_length = 1.3\nretract_speed = 40\nextrusion_width = "
        "0.45\nfirst_layer_extrusion_width = 0.45\n"
        "use_relative_e_distances = 0\nthumbnails = \n"
        "start_gcode = M73 P0\\nM140 S[first_layer_bed_temperature] T0\\nM104 "
        "S[first_layer_temperature] T0\\n"
        "M109 S[first_layer_bed_temperature] T0\\nM133 T0\\nG162 X Y F2500\\nG161 Z F1100\\nG92 "
        "Z-5\\nG1 Z0\\n"
        "G161 Z F100\\nM132 X Y Z A B\\nG92 E0\n"
        "end_gcode = M73 P100\\nG1 Z150 F1000\\nM104 S0 T0\\nM140 S0 T0\\nG162 X Y F2500\\nM18 X Y "
        "Z A B\n";
    const std::string base = folder.string();
    if (!decomp::write_file(folder / "part.stl", stl_of(mesh), decomp::Overwrite::Allow) ||
        !decomp::write_file(folder / "print.ini", kSettings, decomp::Overwrite::Allow) ||
        !runs("prusa-slicer --loglevel 1 --load " + base +
              "/print.ini --center 0,0 --export-gcode --output " + base + "/out.gcode " + base +
              "/part.stl")) {
        return std::nullopt;
    }
    auto text = decomp::read_file(folder / "out.gcode");
    return text ? std::optional(*text) : std::nullopt;
}

/// The program of CuraEngine for this mesh, or nothing where it or its definitions are missing.
inline std::optional<std::string> cura_program(const std::string& name, const TriMesh& mesh) {
    const auto resources = cura_resources();
    if (!runs("command -v CuraEngine") || !resources) {
        return std::nullopt;
    }
    // The engine reads leaf settings only; the formulas between them live in Cura's front end.
    static constexpr const char* kSettings[] = {"machine_width=227",
                                                "machine_depth=148",
                                                "machine_height=150",
                                                "machine_center_is_zero=true",
                                                "center_object=true",
                                                "mesh_position_x=0",
                                                "mesh_position_y=0",
                                                "mesh_position_z=0",
                                                "machine_heated_bed=true",
                                                "layer_height=0.2",
                                                "layer_height_0=0.2",
                                                "line_width=0.45",
                                                "wall_line_width=0.45",
                                                "wall_line_width_0=0.45",
                                                "wall_line_width_x=0.45",
                                                "skin_line_width=0.45",
                                                "infill_line_width=0.45",
                                                "skirt_brim_line_width=0.45",
                                                "initial_layer_line_width_factor=100",
                                                "wall_line_count=3",
                                                "wall_thickness=1.35",
                                                "top_layers=4",
                                                "bottom_layers=4",
                                                "initial_bottom_layers=4",
                                                "top_thickness=0.8",
                                                "bottom_thickness=0.8",
                                                "infill_sparse_density=15",
                                                "infill_pattern=grid",
                                                "infill_line_distance=6",
                                                "skin_no_small_gaps_heuristic=true",
                                                "speed_print=60",
                                                "speed_wall=45",
                                                "speed_wall_0=30",
                                                "speed_wall_x=45",
                                                "speed_infill=60",
                                                "speed_topbottom=50",
                                                "speed_travel=120",
                                                "speed_layer_0=20",
                                                "speed_print_layer_0=20",
                                                "speed_travel_layer_0=60",
                                                "skirt_brim_speed=20",
                                                "material_print_temperature=210",
                                                "material_print_temperature_layer_0=215",
                                                "material_initial_print_temperature=210",
                                                "material_final_print_temperature=210",
                                                "material_bed_temperature=60",
                                                "material_bed_temperature_layer_0=60",
                                                "material_diameter=1.75",
                                                "retraction_enable=true",
                                                "retraction_amount=1.3",
                                                "retraction_speed=40",
                                                "retraction_retract_speed=40",
                                                "retraction_prime_speed=40",
                                                "cool_min_layer_time=10",
                                                "cool_min_speed=10",
                                                "adhesion_type=skirt",
                                                "skirt_line_count=1",
                                                "roofing_layer_count=0",
                                                "support_enable=false"};
    const std::filesystem::path folder = std::filesystem::path(HEW_ORACLE_CACHE) / ("cura-" + name);
    std::filesystem::create_directories(folder);
    const std::string base = folder.string();
    std::string command = "CURA_ENGINE_SEARCH_PATH=" + *resources + "/definitions:" + *resources +
                          "/extruders CuraEngine slice -j " + *resources +
                          "/definitions/fdmprinter.def.json";
    for (const char* setting : kSettings) {
        command += std::string(" -s ") + setting;
    }
    command += " -e0 -s extruder_nr=0 -s machine_nozzle_size=0.4 -s material_diameter=1.75 -l " +
               base + "/part.stl -o " + base + "/out.gcode";
    if (!decomp::write_file(folder / "part.stl", stl_of(mesh), decomp::Overwrite::Allow) ||
        !runs(command)) {
        return std::nullopt;
    }
    auto text = decomp::read_file(folder / "out.gcode");
    return text ? std::optional(*text) : std::nullopt;
}

}  // namespace tests
