// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/step_files.h"
#include "decomp/base/number.h"
#include "tools/job_options.h"
#include "tools/values.h"
#include "tools/verb.h"

#include <filesystem>
#include <memory>

namespace tools {

namespace {

struct Command {
    std::filesystem::path directory;
    cam::job::StepWish wish;
};

decomp::Result<Answer> export_job(const Command& command, const decomp::Run& run) {
    if (!command.wish.wanted) {
        return decomp::fail("usage.export", "export what?", command.directory.string(),
                            "add --step; STL and 3MF are in the job directory already");
    }
    const auto job = cam::job::export_step(command.directory, command.wish, run);
    if (!job) {
        return decomp::fail(job.error());
    }
    Answer answer;
    answer.json["directory"] = (command.directory / "step").string();
    answer.json["assembly"] = (command.directory / "step" / "assembly.step").string();
    answer.json["parts"] = Json::array();
    for (const auto& part : job->step_parts) {
        const std::string file = (command.directory / "step" / (part.id + ".step")).string();
        answer.json["parts"].push_back({{"id", part.id},
                                        {"file", file},
                                        {"bytes", part.bytes},
                                        {"faces", part.faces},
                                        {"planes", part.planes},
                                        {"cylinders", part.cylinders},
                                        {"cones", part.cones},
                                        {"tori", part.tori},
                                        {"removed_points", part.removed_points},
                                        {"decimation_mm", part.decimation_mm},
                                        {"sagitta_mm", part.sagitta_mm},
                                        {"volume_mm3", part.volume_mm3}});
        answer.text +=
            file + ": " + std::to_string(part.faces) + " faces (" + std::to_string(part.planes) +
            " planes, " + std::to_string(part.cylinders) + " cylinders, " +
            std::to_string(part.cones) + " cones, " + std::to_string(part.tori) + " tori), " +
            std::to_string(part.bytes / 1000) + " kB, " +
            (part.removed_points == 0
                 ? "nothing joined"
                 : "within " + decomp::decimal(part.decimation_mm, 4) + " mm of the part") +
            "\n";
    }
    answer.text += (command.directory / "step" / "assembly.step").string() + "\n";
    return answer;
}

}  // namespace

Action declare_export(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("job", command->directory, "a job directory")->required();
    add_step_options(app, command->wish);
    app.add_flag("--force", command->wish.many_faces, "as --step-many")->group("General");
    return [command](const decomp::Run& run) { return export_job(*command, run); };
}

}  // namespace tools
