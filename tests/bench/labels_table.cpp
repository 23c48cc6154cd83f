// SPDX-License-Identifier: GPL-3.0-or-later
// Labels of real models as a table: one row for each model given, or for all of HEW_MODELS.
//   labels_table [--triangles N] [--compactness C,C,...] [--smoothing N] [--repair none|deletion]
//                [--input N] [--labels DIR] [--handles] [MODEL...]
// Compactness 0 is that of the paper's Table 1 (5 for other models). Columns !c !b !k: invalid
// charts, opposite boundaries, bad corners. Seconds are CPU.
#include "decomp/io/read_mesh.h"
#include "decomp/labels/label.h"
#include "decomp/labels/label_file.h"
#include "decomp/labels/report.h"
#include "decomp/proxy/proxy.h"
#include "decomp/repair/repair.h"
#include "tests/support/handles.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

namespace {

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Options {
    decomp::proxy::ProxyOptions proxy;
    std::vector<double> compactness{5};
    decomp::labels::LabelOptions label;
    std::vector<std::string> models;
    std::string labels_dir;
    bool handles = false;
    int input_triangles = 0;  // above 0: the model is first remeshed to about so many
};

/// Compactness of Table 1 of the paper.
double paper_compactness(const std::string& name) {
    const std::vector<std::pair<std::string, double>> table{
        {"angel", 5}, {"duck", 5},     {"moai", 3},  {"fandisk", 4},
        {"BU", 9},    {"maxplank", 7}, {"3holes", 3}};
    for (const auto& [part, c] : table) {
        if (name.find(part) != std::string::npos) {
            return c;
        }
    }
    return 5;
}

void write_obj(const std::string& path, const decomp::mesh::TriMesh& mesh) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    for (const auto& p : mesh.points) {
        std::fprintf(file, "v %.12g %.12g %.12g\n", p.x(), p.y(), p.z());
    }
    for (const auto& t : mesh.triangles) {
        std::fprintf(file, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    std::fclose(file);
}

void row(const std::string& name, const decomp::mesh::TriMesh& mesh, const Options& options) {
    decomp::Run run;
    const auto repaired = decomp::repair::repair(mesh, {}, run);
    if (!repaired) {
        std::printf("%-16s %s\n", name.c_str(), repaired.error().text().c_str());
        return;
    }
    run.log_sink = [](const decomp::LogEvent& event) { std::printf("# %s\n", event.text.c_str()); };
    decomp::mesh::TriMesh input = repaired->mesh;
    if (options.input_triangles > 0) {
        const auto coarser =
            decomp::proxy::make_proxy(input, {.triangles = options.input_triangles}, run);
        if (coarser) {
            input = coarser->surface;
        }
    }
    const double start = cpu_seconds();
    const auto proxy = decomp::proxy::make_proxy(input, options.proxy, run);
    const double made = cpu_seconds();
    if (!proxy) {
        std::printf("%-16s %s\n", name.c_str(), proxy.error().text().c_str());
        return;
    }
    for (const double given : options.compactness) {
        decomp::labels::LabelOptions label = options.label;
        label.compactness = given > 0 ? given : paper_compactness(name);
        const double from = cpu_seconds();
        const auto labels = decomp::labels::label(proxy->surface, {}, label, run);
        const double to = cpu_seconds();
        if (!labels) {
            std::printf("%-16s %s\n", name.c_str(), labels.error().text().c_str());
            return;
        }
        const auto is = decomp::labels::report(proxy->surface, *labels);
        std::printf(
            "%-16s %7zu %6zu%c %7.4f %5.1f %4d %4d %3d  %2d %2d %2d  %.3f %s  %5.2f %5.2f\n",
            name.c_str(), input.triangles.size(), proxy->surface.triangles.size(),
            proxy->wrapped ? 'w' : ' ', proxy->volume_share - 1, label.compactness, is.charts,
            is.corners, is.turning_points, is.invalid_charts, is.opposite_boundaries,
            is.bad_corners, is.fidelity,
            is.impossible ? "never"
            : is.valid()  ? "valid"
                          : "-----",
            made - start, to - from);
        std::fflush(stdout);
        if (!options.labels_dir.empty()) {
            const std::string base = options.labels_dir + "/" + name;
            write_obj(base + ".obj", proxy->surface);
            (void)decomp::labels::write_labels(base + ".txt", *labels, decomp::Overwrite::Allow);
        }
    }
}

void row(const std::string& path, const Options& options) {
    const std::string name = std::filesystem::path(path).stem().string();
    const auto read = decomp::io::read_mesh(path, {}, decomp::Run{});
    if (!read) {
        std::printf("%-16s %s\n", name.c_str(), read.error().text().c_str());
        return;
    }
    row(name, *read, options);
}

std::vector<std::string> all_models() {
    std::vector<std::string> found;
    if (const char* models = std::getenv("HEW_MODELS")) {
        for (const char* folder : {"paper", "real"}) {
            std::vector<std::string> here;
            for (const auto& entry :
                 std::filesystem::directory_iterator(std::filesystem::path(models) / folder)) {
                here.push_back(entry.path().string());
            }
            std::sort(here.begin(), here.end());
            found.insert(found.end(), here.begin(), here.end());
        }
    }
    return found;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const char* value = i + 1 < argc ? argv[i + 1] : "0";
        if (word == "--handles") {
            options.handles = true;
            continue;
        }
        if (word == "--triangles") {
            options.proxy.triangles = std::atoi(value);
        } else if (word == "--compactness") {
            options.compactness.clear();
            for (std::string list = value; !list.empty();) {
                const std::size_t comma = std::min(list.find(','), list.size());
                options.compactness.push_back(std::atof(list.substr(0, comma).c_str()));
                list.erase(0, comma + 1);
            }
        } else if (word == "--input") {
            options.input_triangles = std::atoi(value);
        } else if (word == "--sharp") {
            options.proxy.sharp_angle_deg = std::atof(value);
        } else if (word == "--smoothing") {
            options.label.smoothing = std::atoi(value);
        } else if (word == "--repair") {
            const std::string mode = value;
            options.label.repair = mode == "none"       ? decomp::labels::RepairMode::None
                                   : mode == "deletion" ? decomp::labels::RepairMode::Deletion
                                                        : decomp::labels::RepairMode::Constructive;
        } else if (word == "--labels") {
            options.labels_dir = value;
        } else {
            options.models.push_back(word);
            continue;
        }
        ++i;
    }
    if (options.models.empty() && !options.handles) {
        options.models = all_models();
    }
    std::printf(
        "model              input  proxy  volume     c  chr  cor  tp  !c !b !k  fidel        proxy "
        "label\n");
    for (const std::string& model : options.models) {
        row(model, options);
    }
    if (options.handles) {
        for (const auto& shape : tests::handle_shapes()) {
            row(shape.name, shape.mesh, options);
        }
    }
    return 0;
}
