// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/make.h"
#include "cam/job/plate_program.h"
#include "cam/job/stage.h"
#include "cam/profile/read_profile.h"
#include "decomp/part/part.h"
#include "decomp/pipeline/decompose.h"
#include "decomp/plan/edit.h"
#include "decomp/plan/plan.h"

#include <memory>
#include <string>
#include <vector>

namespace cam::job {

/// How a person wants the shape cut, as read from the options.
struct ByHand {
    std::shared_ptr<const decomp::plan::Plan> plan;  ///< null: search
    std::vector<decomp::plan::Edit> edits;
};

/// The stages of one run, each a key (what it reads) and a body (what it makes). Every body reads
/// what earlier stages wrote, never what they held in memory: a resumed run and a clean one take
/// the same path.
class Maker {
  public:
    Maker(const MakeRequest& request, profile::FdmSetup setup, std::string model_bytes,
          ByHand by_hand, JobFile& job, decomp::Run run);

    /// Runs all stages of the extent and finishes the job.
    [[nodiscard]] decomp::Status make_all();

    /// Names of the leading stages that would be kept; `complete` tells whether that is all of
    /// them.
    [[nodiscard]] std::vector<std::string> kept_stages(bool& complete) const;

    [[nodiscard]] const std::vector<StageTiming>& timings() const { return stages_.timings(); }

  private:
    using Files = decomp::Result<std::vector<FileBytes>>;

    [[nodiscard]] StageKey model_key() const;
    [[nodiscard]] StageKey parts_key() const;
    [[nodiscard]] StageKey arrange_key() const;
    [[nodiscard]] StageKey program_key(const PlateFacts& plate) const;
    [[nodiscard]] StageKey proof_key(const PlateFacts& plate) const;
    [[nodiscard]] StageKey convert_key(const PlateFacts& plate) const;
    [[nodiscard]] StageKey pictures_key() const;
    [[nodiscard]] StageKey assembly_key() const;
    [[nodiscard]] StageKey report_key() const;

    /// The machine as the judge sees it: its chamber is no larger than the job wants its parts.
    [[nodiscard]] profile::FdmMachine judged_machine() const;

    /// Whether a polycube is to be made from the model.
    [[nodiscard]] bool makes_polycube() const;

    /// The polycube that the job names; made from the model when it wants boxes or the paper's way
    /// without naming one, or when a plan was made so and parts are to be split in it; else null.
    /// @error those of io, tets and polycube; job.polycube
    [[nodiscard]] decomp::Result<std::shared_ptr<const decomp::pipeline::PolycubeMap>> map_for(
        const decomp::mesh::TriMesh& model, decomp::Run& run) const;

    [[nodiscard]] Files make_model(decomp::Run& run);
    [[nodiscard]] Files make_parts(decomp::Run& run);
    [[nodiscard]] Files arrange(decomp::Run& run);
    [[nodiscard]] Files make_program(PlateFacts& plate, decomp::Run& run) const;
    [[nodiscard]] Files prove(PlateFacts& plate, decomp::Run& run) const;
    [[nodiscard]] Files convert_program(PlateFacts& plate, decomp::Run& run) const;
    [[nodiscard]] Files make_pictures(decomp::Run& run) const;
    [[nodiscard]] Files make_assembly(decomp::Run& run) const;

    [[nodiscard]] decomp::Status make_plate(std::size_t index);
    void add_parts(StageKey& key) const;
    void add_plate(StageKey& key, const PlateFacts& plate) const;

    const MakeRequest& request_;
    profile::FdmSetup setup_;
    std::string model_bytes_;
    ByHand by_hand_;
    std::vector<std::string> polycube_hashes_;
    JobFile& job_;
    decomp::Run run_;
    StageRunner stages_;
};

/// Raised with every change of what a program looks like, so that older jobs are made anew.
inline constexpr int kModelRevision = 1;
inline constexpr int kPartsRevision = 4;
inline constexpr int kArrangeRevision = 1;
inline constexpr int kProgramRevision = 1;
inline constexpr int kPicturesRevision = 1;

/// Where a part stands in its pose: on cut plane k ("plane 3"), or on the side of the model that
/// then points down
/// ("-z"), or "flat" on a face in another direction.
[[nodiscard]] std::string base_of(
    const decomp::part::Part& part,
    const decomp::Pose<decomp::PartBedFrame, decomp::ModelFrame>& pose);

/// Reads one part of a job. @error those of io; job.changed (the file is not the one that the job
/// wrote)
[[nodiscard]] decomp::Result<decomp::part::Part> read_job_part(
    const std::filesystem::path& directory, const JobFile& job, const std::string& id);

}  // namespace cam::job
