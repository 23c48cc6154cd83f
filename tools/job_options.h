// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/make.h"
#include "tools/verb.h"

#include <memory>
#include <string>

namespace tools {

/// Declares --unit, --scale, --up and --height of a model.
void add_model_options(CLI::App& app, std::string& unit, double& scale, std::string& up,
                       std::optional<double>& height_mm);

/// Declares --body, --deflection and --angle of a STEP or BREP model.
void add_solid_options(CLI::App& app, std::string& body, std::optional<double>& deflection_mm,
                       double& angle_deg);

/// Declares --step, --step-tol, --step-schema and --step-many.
void add_step_options(CLI::App& app, cam::job::StepWish& wish);

/// Declares --plan, --split, --merge and --plane. The edits stand in the options once
/// take_edits() has been called after parsing.
void add_hand_options(CLI::App& app, cam::job::JobOptions& options);

/// The edits of the command line in the order in which they stand there.
void take_edits(const CLI::App& app, cam::job::JobOptions& options);

/// Declares --machine, --material and --set.
void add_machine_options(CLI::App& app, std::string& machine, std::string& material,
                         std::vector<std::string>& settings, bool required);

/// What `make` and `decompose` have in common: declares their options, and makes the job up to
/// `extent`.
Action declare_job(CLI::App& app, const Common& common, cam::job::Extent extent);

/// The job's figures for --json.
[[nodiscard]] Json job_summary(const cam::job::JobFile& job);

}  // namespace tools
