// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/read_mesh.h"

#include "decomp/base/file.h"
#include "decomp/brep/read_brep.h"
#include "decomp/io/formats.h"
#include "decomp/io/text_scanner.h"

#include <array>
#include <cmath>

namespace decomp::io {

namespace {

struct Unit {
    std::string_view name;
    double length_mm;
};

constexpr std::array<Unit, 6> kUnits{
    {{"um", 0.001}, {"mm", 1.0}, {"cm", 10.0}, {"m", 1000.0}, {"in", 25.4}, {"ft", 304.8}}};

/// Coordinates beyond this are a slip of the unit, and would overflow in products.
constexpr double kFarthestMm = 1e9;

/// All bodies as one mesh, in mm.
Result<mesh::TriMesh> parse_solids(std::string_view bytes, std::string_view name,
                                   const ReadOptions& options, const Run& run) {
    const auto bodies = brep::read_brep(
        bytes, name,
        {.deflection_mm = options.deflection_mm, .angle = options.angle, .body = options.body},
        run);
    if (!bodies) {
        return fail(bodies.error());
    }
    mesh::TriMesh mesh;
    for (const brep::Body& body : *bodies) {
        const auto shift = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.insert(mesh.points.end(), body.mesh.points.begin(), body.mesh.points.end());
        for (const mesh::Triangle& t : body.mesh.triangles) {
            mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
        }
    }
    return mesh;
}

/// Options that speak of bodies and chords must not be passed over in silence.
Status check_options(Format format, std::string_view name, const ReadOptions& options) {
    if (format == Format::Step && !options.unit.empty()) {
        return fail("io.unit", "a STEP file states its own unit", std::string(name),
                    "leave the unit out; a scale changes the size");
    }
    const bool solids = format == Format::Step || format == Format::Brep;
    if (!solids && (!options.body.empty() || options.deflection_mm)) {
        return fail("io.not_a_solid_model",
                    "a body or a deflection is chosen, but only STEP and BREP files have them",
                    std::string(name), "leave the option out");
    }
    return {};
}

Result<ScaledMesh> parse(Format format, std::string_view bytes, std::string_view name,
                         const ReadOptions& options, const Run& run) {
    const auto without_unit = [](Result<mesh::TriMesh> mesh) {
        return std::move(mesh).map([](mesh::TriMesh&& parsed) {
            return ScaledMesh{std::move(parsed), 1.0};
        });
    };
    switch (format) {
        case Format::StlBinary:
            return without_unit(parse_stl_binary(bytes, name));
        case Format::StlAscii:
            return without_unit(parse_stl_ascii(bytes, name));
        case Format::Obj:
            return without_unit(parse_obj(bytes, name));
        case Format::Off:
            return without_unit(parse_off(bytes, name));
        case Format::Medit:
            return without_unit(parse_medit(bytes, name));
        case Format::Threemf:
            return parse_3mf(bytes, name);
        case Format::Step:
        case Format::Brep:
            return without_unit(parse_solids(bytes, name, options, run));
        case Format::Ply:
            break;
    }
    return parse_ply(bytes, name, {}).map([](PlyContents&& ply) {
        return ScaledMesh{std::move(ply.mesh), 1.0};
    });
}

}  // namespace

Result<double> length_of(const ReadOptions& options, double unit_of_file_mm) {
    if (!std::isfinite(options.scale) || options.scale <= 0) {
        return fail("io.scale", "a scale must be a finite number above 0", "scale");
    }
    if (options.unit.empty()) {
        return options.scale * unit_of_file_mm;
    }
    for (const Unit& unit : kUnits) {
        if (unit.name == options.unit) {
            return options.scale * unit.length_mm;
        }
    }
    return fail("io.unit", "there is no unit '" + options.unit + "'", "unit",
                "use um, mm, cm, m, in or ft");
}

Status scale_points(std::vector<Eigen::Vector3d>& points, double factor, std::string_view name) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] *= factor;
        if (!(points[i].cwiseAbs().maxCoeff() <= kFarthestMm)) {
            return fail("io.too_large",
                        "point " + std::to_string(i) + " lies more than 1000 km from the origin",
                        std::string(name), "check the unit and the scale");
        }
    }
    return {};
}

Result<mesh::TriMesh> parse_mesh(std::string_view bytes, std::string_view name,
                                 const ReadOptions& options, const Run& run) {
    const Result<Format> format = detect_format(bytes, name);
    if (!format) {
        return fail(format.error());
    }
    if (const Status fitting = check_options(*format, name, options); !fitting) {
        return fail(fitting.error());
    }
    Result<ScaledMesh> parsed = parse(*format, bytes, name, options, run);
    if (!parsed) {
        return fail(parsed.error());
    }
    if (run.cancelled()) {
        return cancelled();
    }
    const Result<double> length = length_of(options, parsed->unit_mm);
    if (!length) {
        return fail(length.error());
    }
    mesh::TriMesh mesh = std::move(parsed->mesh);
    if (mesh.triangles.empty()) {
        return fail("io.empty", "the file holds no triangle", std::string(name),
                    "check that the export was complete");
    }
    drop_unused_points(mesh);
    if (Status status = scale_points(mesh.points, *length, name); !status) {
        return fail(status.error());
    }
    return mesh;
}

Result<mesh::TriMesh> read_mesh(const std::filesystem::path& path, const ReadOptions& options,
                                const Run& run) {
    const Result<std::string> bytes = read_file(path);
    if (!bytes) {
        return fail(bytes.error());
    }
    return parse_mesh(*bytes, path.string(), options, run);
}

}  // namespace decomp::io
