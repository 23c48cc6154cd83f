// SPDX-License-Identifier: GPL-3.0-or-later
// What slicing alone takes, without repair and proof: hew_slice_cpu PART.stl MACHINE OUT.gcode
// [KEY=VALUE …] Prints CPU seconds of reading, planning and writing, and the peak of memory.
#include "cam/fdm/plan_part.h"
#include "cam/fdm/plate_layers.h"
#include "cam/post/post_fdm.h"
#include "cam/profile/read_profile.h"
#include "decomp/base/file.h"
#include "decomp/io/read_mesh.h"
#include "decomp/mesh/measure.h"

#include <sys/resource.h>

#include <cstdio>
#include <string>
#include <vector>

namespace {

double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

long peak_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

int failed(const decomp::Error& error) {
    std::fprintf(stderr, "%s\n", error.text().c_str());
    return 1;
}

}  // namespace

int main(int count, char** words) {
    if (count < 4) {
        std::fprintf(stderr, "hew_slice_cpu PART.stl MACHINE OUT.gcode [KEY=VALUE …]\n");
        return 2;
    }
    decomp::Run run;
    run.jobs = 2;
    const auto setup = cam::profile::read_fdm_setup(
        words[2], {}, std::vector<std::string>(words + 4, words + count));
    if (!setup) {
        return failed(setup.error());
    }
    const double start = cpu_seconds();
    auto mesh = decomp::io::read_mesh(words[1], {}, run);
    if (!mesh) {
        return failed(mesh.error());
    }
    const auto box = decomp::mesh::bounds(*mesh);
    for (auto& p : mesh->points) {
        p -= Eigen::Vector3d(box.center().x(), box.center().y(), box.min().z());
    }
    const double read = cpu_seconds();
    const auto part = cam::fdm::plan_part(*mesh, *setup, run);
    if (!part) {
        return failed(part.error());
    }
    const auto& chamber = setup->machine.chamber;
    const Eigen::Vector2d middle = (0.5 * (chamber.min_mm + chamber.max_mm)).head<2>();
    const auto plate = cam::fdm::merge_layers({{&*part, middle}}, *setup);
    const double planned = cpu_seconds();
    const auto program = cam::post::post_fdm(plate, *setup, {.title = "bench"}, run);
    if (!program) {
        return failed(program.error());
    }
    const auto written = decomp::write_file(words[3], program->text, decomp::Overwrite::Allow);
    if (!written) {
        return failed(written.error());
    }
    std::printf("read %.2f plan %.2f write %.2f all %.2f CPU-s, peak %ld MB\n", read - start,
                planned - read, cpu_seconds() - planned, cpu_seconds() - start, peak_mb());
    return 0;
}
