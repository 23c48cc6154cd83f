// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/job/job_file.h"
#include "decomp/base/run.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cam::job {

/// Collects what a stage reads, and hashes it. Every field is written with its name and length, so
/// that no two different lists of fields give the same text.
class StageKey {
  public:
    /// @param revision raised when the stage's own code gives other results for the same input
    StageKey(std::string_view stage, int revision);

    StageKey& add(std::string_view field, std::string_view value);
    StageKey& add(std::string_view field, double value);
    StageKey& add(std::string_view field, const Eigen::Matrix4d& value);

    [[nodiscard]] std::string hash() const;

  private:
    std::string text_;
};

/// A file that a stage made, still in memory.
struct FileBytes {
    std::string path;  ///< relative to the job directory
    std::string bytes;
};

struct StageTiming {
    std::string name;
    bool kept = false;
    double wall_s = 0;
    double cpu_s = 0;
};

/// Exclusive use of a job directory by one process, until destroyed. Leaves no file behind.
class DirectoryLock {
  public:
    /// @error job.busy another run works here; file.unwritable
    [[nodiscard]] static decomp::Result<DirectoryLock> take(const std::filesystem::path& directory);

    DirectoryLock(DirectoryLock&& other) noexcept;
    DirectoryLock& operator=(DirectoryLock&&) = delete;
    DirectoryLock(const DirectoryLock&) = delete;
    DirectoryLock& operator=(const DirectoryLock&) = delete;
    ~DirectoryLock();

  private:
    explicit DirectoryLock(int descriptor) : descriptor_(descriptor) {}

    int descriptor_ = -1;
};

/// Runs stages in a job directory: those whose key and outputs still hold are kept, the others are
/// made, written atomically and recorded in job.json at once, so that a run killed at any moment
/// continues where it stood.
class StageRunner {
  public:
    /// @param job the directory's earlier job, or an empty one; updated in place
    StageRunner(std::filesystem::path directory, JobFile& job, const decomp::Run& run);

    /// Makes the stage's files and updates the job's facts; called only when the stage is not done.
    using Body = std::function<decomp::Result<std::vector<FileBytes>>(const decomp::Run&)>;

    /// @param weight share of the whole run's progress
    /// @error what `body` returns; file.unwritable; run.cancelled
    [[nodiscard]] decomp::Status run(const std::string& name, const StageKey& key, double weight,
                                     const Body& body);

    /// Drops the stages of an earlier run which this run did not visit, removes their files, and
    /// writes the job as finished. @error file.unwritable
    [[nodiscard]] decomp::Status finish();

    /// Counts the stages of earlier runs as visited: this run has made one stage alone.
    void keep_others();

    /// Is the stage recorded under this key with all its outputs intact? Cost: reading the outputs.
    [[nodiscard]] bool is_done(const std::string& name, const StageKey& key) const;

    /// SHA-256 of an output of a finished stage; empty when no stage has it.
    [[nodiscard]] std::string hash_of(const std::string& path) const;

    /// All weights of the stages to come, for a progress that ends at 1.
    void expect(double total_weight) { total_weight_ = total_weight; }

    [[nodiscard]] const std::vector<StageTiming>& timings() const { return timings_; }

  private:
    [[nodiscard]] decomp::Status write_job();
    void replace_record(StageRecord finished);

    std::filesystem::path directory_;
    JobFile& job_;
    const decomp::Run& run_;
    std::vector<std::string> visited_;
    std::vector<StageTiming> timings_;
    double done_weight_ = 0;
    double total_weight_ = 1;
};

/// Removes temporary files which a killed run left in the directory and its folders.
void remove_leftovers(const std::filesystem::path& directory);

}  // namespace cam::job
