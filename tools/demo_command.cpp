// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/file.h"
#include "decomp/io/write_mesh.h"
#include "decomp/mesh/measure.h"
#include "tools/demo_statue.h"
#include "tools/verb.h"

#include <filesystem>
#include <memory>

namespace tools {

namespace {

struct Command {
    std::filesystem::path out;
    double cell_mm = 5;
    bool force = false;
};

decomp::Result<Answer> write_statue(const Command& command) {
    const decomp::mesh::TriMesh statue = demo_statue(command.cell_mm);
    const auto written =
        decomp::write_file(command.out, decomp::io::stl_bytes(statue),
                           command.force ? decomp::Overwrite::Allow : decomp::Overwrite::Refuse);
    if (!written) {
        return decomp::fail(written.error());
    }
    const Eigen::Vector3d size = decomp::mesh::bounds(statue).sizes();
    Answer answer;
    answer.json = {{"file", command.out.string()},
                   {"triangles", statue.triangles.size()},
                   {"extent_mm", {size.x(), size.y(), size.z()}}};
    answer.text =
        command.out.string() + ": " + std::to_string(statue.triangles.size()) + " triangles\n";
    return answer;
}

}  // namespace

Action declare_demo(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("out", command->out, "STL file to write")->required();
    app.add_option("--cell", command->cell_mm, "detail, mm")
        ->check(CLI::Range(1.0, 20.0))
        ->capture_default_str();
    app.add_flag("--force", command->force, "overwrite")->group("General");
    return [command](const decomp::Run&) { return write_statue(*command); };
}

}  // namespace tools
