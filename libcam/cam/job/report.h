// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/job_file.h"
#include "cam/job/stage.h"

#include <string>
#include <vector>

namespace cam::job {

struct Totals {
    std::size_t parts = 0;
    std::size_t plates = 0;
    double seconds = 0;
    double filament_mm = 0;
    double filament_g = 0;
    double cost = 0;
    bool passed = false;  ///< there are programs, and every one is proved
};

[[nodiscard]] Totals totals_of(const JobFile& job);

/// report.json, "hew.report/1": what came out, with figures rounded for people. Depends on the job
/// alone.
[[nodiscard]] std::string report_json(const JobFile& job);

/// timings.json: seconds per stage and the peak of memory; differs from run to run, therefore
/// apart.
[[nodiscard]] std::string timings_json(const std::vector<StageTiming>& timings);

}  // namespace cam::job
