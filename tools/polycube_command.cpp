// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/lone_part.h"
#include "decomp/base/file.h"
#include "decomp/base/number.h"
#include "decomp/io/read_tets.h"
#include "decomp/io/write_tets.h"
#include "decomp/labels/label_file.h"
#include "decomp/polycube/check.h"
#include "decomp/polycube/generate.h"
#include "decomp/repair/repair.h"
#include "decomp/tets/boundary.h"
#include "decomp/tets/pair.h"
#include "tools/job_options.h"
#include "tools/polycube_picture.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace tools {

namespace {

namespace fs = std::filesystem;
namespace io = decomp::io;
namespace labels = decomp::labels;
namespace polycube = decomp::polycube;
namespace tets = decomp::tets;
using decomp::fail;
using decomp::Result;
using decomp::Run;
using decomp::Status;

struct Command {
    cam::job::MeshRequest mesh;
    fs::path out;
    std::vector<fs::path> check;
    double compactness = 5;
    int target_parts = 0;
    int proxy_triangles = 3500;
    int starts = 5;
    std::string repair = "constructive";
    bool plain = false;
    bool keep_orientation = false;
    bool force = false;
};

struct ReadPair {
    tets::Pair pair;
    labels::Labeling labels;  ///< empty: none beside the pair
};

Json report_json(const polycube::PairReport& r) {
    return {{"tier", r.tier},
            {"tets", r.tets},
            {"facets", r.facets},
            {"flips", r.flips},
            {"flipped_percent", 100 * r.flipped_share},
            {"flat_in_shape", r.flat_in_shape},
            {"off_axis_facets", r.off_axis_facets},
            {"backward_facets", r.backward_facets},
            {"charts", r.charts},
            {"corners", r.corners},
            {"poor_charts", r.poor_charts},
            {"opposite_boundaries", r.opposite_boundaries},
            {"bad_corners", r.bad_corners},
            {"overlaps", r.overlaps},
            {"identity", r.identity}};
}

std::string report_text(const polycube::PairReport& r) {
    return "tier " + r.tier + ": " + std::to_string(r.tets) + " tets, " + std::to_string(r.flips) +
           " flipped (" + decomp::decimal(100 * r.flipped_share, 4) + " % of the volume), " +
           std::to_string(r.charts) + " charts, " + std::to_string(r.corners) +
           " corners; labels " + (r.labels_valid() ? "valid" : "not valid") +
           (r.overlaps ? "; overlaps itself" : "") + "\n";
}

/// A directory that `hew polycube` wrote, or the files of the shape and of the polycube.
Result<ReadPair> read_pair(const std::vector<fs::path>& paths) {
    const bool directory = paths.size() == 1;
    if (directory && !fs::is_directory(paths[0])) {
        return fail("usage.pair", "--check wants a directory or two files of tets",
                    paths[0].string(), "hew polycube --check shape.mesh polycube.mesh");
    }
    auto shape = io::read_tets(directory ? paths[0] / "shape.mesh" : paths[0], {});
    if (!shape) {
        return fail(shape.error());
    }
    auto cube = io::read_tets(directory ? paths[0] / "polycube.mesh" : paths[1], {});
    if (!cube) {
        return fail(cube.error());
    }
    auto pair = tets::pair_of(std::move(*shape), std::move(*cube));
    if (!pair) {
        return fail(pair.error());
    }
    ReadPair out{std::move(*pair), {}};
    if (directory && fs::exists(paths[0] / "labels.txt")) {
        auto known =
            labels::read_labels(paths[0] / "labels.txt", tets::boundary_of(out.pair.tets).size());
        if (!known) {
            return fail(known.error());
        }
        out.labels = std::move(*known);
    }
    return out;
}

Result<Answer> check(const Command& command) {
    const auto read = read_pair(command.check);
    if (!read) {
        return fail(read.error());
    }
    const polycube::PairReport report = polycube::check_pair(read->pair, read->labels);
    Answer answer;
    answer.json = report_json(report);
    answer.text = report_text(report);
    return answer;
}

Json figures_json(const polycube::Polycube& made) {
    const polycube::Figures& f = made.figures;
    Json json = {{"start", f.start},
                 {"tried", f.tried},
                 {"proxy_triangles", f.proxy_triangles},
                 {"proxy_distance_mm", f.proxy_distance_mm},
                 {"charts", f.charts},
                 {"corners", f.corners},
                 {"turning_points", f.turning_points},
                 {"valid_labels", f.valid_labels},
                 {"fidelity", f.fidelity},
                 {"tets", f.tets},
                 {"flips", f.flips},
                 {"folds", f.folds},
                 {"flipped_percent", 100 * f.flipped_share},
                 {"symmetric_dirichlet", f.symmetric_dirichlet},
                 {"cells", f.cells},
                 {"fragment_percent", 100 * f.fragment_share},
                 {"score", f.score}};
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            rotation.push_back(made.rotation(row, column));
        }
    }
    json["polycube_from_model"] = rotation;
    json["planes_mm"] = made.lattice.planes;
    return json;
}

Status write_pair(const Command& command, const polycube::Polycube& made) {
    const auto overwrite = command.force ? decomp::Overwrite::Allow : decomp::Overwrite::Refuse;
    std::vector<int> references;
    for (const labels::AxisLabel label : made.labels) {
        references.push_back(static_cast<int>(label));
    }
    const auto& pair = made.pair;
    const std::vector<std::pair<const char*, std::string>> files{
        {"shape.mesh", io::medit_bytes(pair.shape, pair.tets, references)},
        {"polycube.mesh", io::medit_bytes(pair.polycube, pair.tets, references)},
        {"shape.vtk", io::vtk_bytes(pair.shape, pair.tets)},
        {"polycube.vtk", io::vtk_bytes(pair.polycube, pair.tets)},
        {"labels.txt", labels::label_text(made.labels)}};
    for (const auto& [name, bytes] : files) {
        if (Status status = decomp::write_file(command.out / name, bytes, overwrite); !status) {
            return status;
        }
    }
    return {};
}

Result<Answer> generate(const Command& command, Run& run) {
    const auto soup = cam::job::read_drawable(command.mesh, run);
    if (!soup) {
        return fail(soup.error());
    }
    const auto solid = decomp::repair::repair(*soup, {}, run);
    if (!solid) {
        return fail(solid.error());
    }
    polycube::GenerateOptions options;
    options.compactness = command.compactness;
    options.target_parts = command.target_parts;
    options.proxy_triangles = command.proxy_triangles;
    options.starts = command.starts;
    options.deformed_starts = !command.plain;
    options.repair = command.repair == "deletion" ? labels::RepairMode::Deletion
                     : command.repair == "none"   ? labels::RepairMode::None
                                                  : labels::RepairMode::Constructive;
    if (command.keep_orientation) {
        options.rotation = Eigen::Matrix3d::Identity();
    }
    const auto made = polycube::generate(solid->mesh, options, {}, run);
    if (!made) {
        return fail(made.error());
    }
    std::error_code fault;
    fs::create_directories(command.out, fault);
    if (fault) {
        return fail("file.unwritable", "the directory cannot be made", command.out.string());
    }
    if (Status status = write_pair(command, *made); !status) {
        return fail(status.error());
    }
    // The tier is that of the files, not of their maker.
    const auto written = read_pair({command.out});
    if (!written) {
        return fail(written.error());
    }
    const polycube::PairReport report = polycube::check_pair(written->pair, written->labels);
    const auto png = polycube_picture(*made, run);
    if (!png) {
        return fail(png.error());
    }
    Answer answer;
    answer.json["schema"] = "hew.polycube/1";
    answer.json["tier"] = report.tier;
    answer.json["made"] = figures_json(*made);
    answer.json["checked"] = report_json(report);
    const auto overwrite = command.force ? decomp::Overwrite::Allow : decomp::Overwrite::Refuse;
    for (const auto& [name, bytes] :
         {std::pair<const char*, std::string>{"polycube.png", *png},
          std::pair<const char*, std::string>{"polycube.json", answer.json.dump(2) + "\n"}}) {
        if (Status status = decomp::write_file(command.out / name, bytes, overwrite); !status) {
            return fail(status.error());
        }
    }
    answer.text = report_text(report) + std::to_string(made->figures.cells) + " blocks, by '" +
                  made->figures.start + "'; " + (command.out / "polycube.png").string() + "\n";
    return answer;
}

Result<Answer> run_polycube(const Command& command, const Run& outer) {
    Run run = outer;
    if (!command.check.empty()) {
        return check(command);
    }
    if (command.mesh.path.empty() || command.out.empty()) {
        return fail("usage.polycube", "a model and -o, or --check and a pair, are needed", {},
                    "hew polycube statue.stl -o pair/");
    }
    return generate(command, run);
}

}  // namespace

Action declare_polycube(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("model", command->mesh.path, "the model");
    app.add_option("-o,--out", command->out,
                   "directory for the pair, its labels, figures, picture");
    app.add_option("--check", command->check,
                   "check a pair instead: a directory, or the files of shape and polycube")
        ->expected(1, 2);
    app.add_option("--compactness", command->compactness,
                   "1 to 10: fewer blocks the higher; below 1: more detail than the normals hold")
        ->check(CLI::Range(0.01, 1000.0))
        ->capture_default_str();
    app.add_option("--target-parts", command->target_parts,
                   "search the compactness that gives about so many blocks")
        ->check(CLI::Range(1, 1000));
    app.add_option("--proxy", command->proxy_triangles,
                   "triangles of the coarse surface that is labelled; 0: from the local thickness")
        ->check(CLI::Range(0, 50000))
        ->capture_default_str();
    app.add_option("--starts", command->starts, "labelings that compete, at most")
        ->check(CLI::Range(1, 5))
        ->capture_default_str();
    app.add_flag("--plain", command->plain, "no labelings of deformed normals");
    app.add_option("--label-repair", command->repair, "what is done about impossible labels")
        ->check(CLI::IsMember({"constructive", "deletion", "none"}))
        ->capture_default_str();
    app.add_flag("--keep-orientation", command->keep_orientation,
                 "the polycube's axes are the model's");
    add_model_options(app, command->mesh.unit, command->mesh.scale, command->mesh.up,
                      command->mesh.height_mm);
    app.add_flag("--force", command->force, "overwrite")->group("General");
    return [command](const Run& run) { return run_polycube(*command, run); };
}

}  // namespace tools
