// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exit_code.h"

#include <array>
#include <string_view>

namespace tools {

namespace {

struct Row {
    std::string_view code;  ///< a whole code, or a room with its dot
    int exit;
};

constexpr std::array kRows{
    Row{"run.cancelled", kCancelled},
    Row{"usage.", kUsage},
    Row{"file.not_found", kBadInput},
    Row{"file.unreadable", kBadInput},
    Row{"file.", kInputOutput},
    Row{"io.up", kUsage},
    Row{"io.unit", kUsage},
    Row{"io.scale", kUsage},
    Row{"io.", kBadInput},
    Row{"brep.", kBadInput},
    Row{"brep.kernel", kInternal},
    Row{"brep.no_such_body", kUsage},
    Row{"brep.schema", kUsage},
    Row{"brep.not_written", kInternal},
    Row{"solid.", kBadInput},
    Row{"solid.too_many_faces", kInfeasible},
    Row{"job.step_unsound", kInfeasible},
    Row{"mesh.", kBadInput},
    Row{"repair.", kBadInput},
    Row{"profile.not_found", kUsage},
    Row{"profile.", kBadInput},
    Row{"tets.connectivity", kBadInput},
    Row{"tets.empty", kBadInput},
    Row{"labels.", kBadInput},
    Row{"polycube.options", kUsage},
    Row{"cut.not_a_volume", kBadInput},
    Row{"decompose.", kInfeasible},
    Row{"plan.", kBadInput},
    Row{"plan.edit", kUsage},
    Row{"plan.no_such_part", kUsage},
    Row{"plan.no_polycube", kUsage},
    Row{"plan.cut_misses", kInfeasible},
    Row{"plan.not_neighbours", kInfeasible},
    Row{"plan.does_not_fit", kInfeasible},
    Row{"sections.", kInfeasible},
    Row{"orient.", kInfeasible},
    Row{"plate.", kInfeasible},
    Row{"fdm.", kInfeasible},
    Row{"mill.", kInfeasible},
    Row{"mill.no_cutter", kUsage},
    Row{"post.", kInfeasible},
    Row{"proof.unreadable", kBadInput},
    Row{"proof.bad_part", kBadInput},
    Row{"proof.", kProofFailed},
    Row{"post.converter_missing", kInputOutput},
    Row{"post.converter_failed", kInputOutput},
    Row{"post.converter_timeout", kInputOutput},
    Row{"post.no_converter", kInputOutput},
    Row{"render.view", kUsage},
    Row{"render.size", kUsage},
    Row{"render.layer", kUsage},
    Row{"render.empty", kBadInput},
    Row{"check.axis", kUsage},
    Row{"check.raster_too_large", kUsage},
    Row{"check.", kInfeasible},
    Row{"protocol.", kDevice},
    Row{"transport.", kDevice},
    Row{"transport.bad_name", kUsage},
    Row{"stream.", kBadInput},
    Row{"stream.bounds", kProofFailed},
    Row{"stream.feed", kProofFailed},
    Row{"stream.spindle", kProofFailed},
    Row{"stream.temperature", kProofFailed},
    Row{"stream.unknown_code", kProofFailed},
    Row{"stream.no_proof", kProofFailed},
    Row{"stream.card_only", kInfeasible},
    Row{"stream.missing_axis", kInfeasible},
    Row{"stream.identity", kDevice},
    Row{"stream.machine_busy", kDevice},
    Row{"stream.not_homed", kDevice},
    Row{"stream.journal_exists", kInputOutput},
    Row{"job.not_empty", kInputOutput},
    Row{"job.other_model", kInputOutput},
    Row{"job.busy", kInputOutput},
    Row{"job.plan_changed", kInputOutput},
    Row{"job.plan_in_job", kUsage},
    Row{"job.no_such_part", kUsage},
    Row{"job.part_does_not_fit", kInfeasible},
    Row{"job.part_too_large", kInfeasible},
    Row{"job.", kBadInput},
};

}  // namespace

int exit_code(const decomp::Error& error) {
    const Row* best = nullptr;
    for (const Row& row : kRows) {
        const bool matches =
            row.code.back() == '.' ? error.code.starts_with(row.code) : error.code == row.code;
        if (matches && (best == nullptr || row.code.size() > best->code.size())) {
            best = &row;
        }
    }
    return best == nullptr ? kInternal : best->exit;
}

}  // namespace tools
