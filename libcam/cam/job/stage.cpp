// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/stage.h"

#include "decomp/base/file.h"
#include "decomp/base/hash.h"
#include "decomp/base/number.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <set>

namespace cam::job {

namespace fs = std::filesystem;
using decomp::Run;

namespace {

double cpu_seconds() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + double(t.tv_usec) / 1000000;
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

bool has_hash(const fs::path& path, const std::string& sha256) {
    const auto bytes = decomp::read_file(path);
    return bytes && decomp::sha256_hex(*bytes) == sha256;
}

void remove_file(const fs::path& path) {
    std::error_code ignored;
    fs::remove(path, ignored);
}

}  // namespace

StageKey::StageKey(std::string_view stage, int revision) {
    add("stage", stage);
    add("revision", std::to_string(revision));
}

StageKey& StageKey::add(std::string_view field, std::string_view value) {
    text_ += field;
    text_ += ' ' + std::to_string(value.size()) + ' ';
    text_ += value;
    text_ += '\n';
    return *this;
}

StageKey& StageKey::add(std::string_view field, double value) {
    return add(field, std::string_view(decomp::shortest(value)));
}

StageKey& StageKey::add(std::string_view field, const Eigen::Matrix4d& value) {
    for (Eigen::Index i = 0; i < 16; ++i) {
        add(field, value(i / 4, i % 4));
    }
    return *this;
}

std::string StageKey::hash() const { return decomp::sha256_hex(text_); }

decomp::Result<DirectoryLock> DirectoryLock::take(const fs::path& directory) {
    const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
        return decomp::fail("file.unwritable", "cannot open the folder", directory.string());
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        ::close(descriptor);
        return decomp::fail("job.busy", "another run works in this directory", directory.string(),
                            "wait until it has ended, or choose another directory");
    }
    return DirectoryLock(descriptor);
}

DirectoryLock::DirectoryLock(DirectoryLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

DirectoryLock::~DirectoryLock() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

StageRunner::StageRunner(fs::path directory, JobFile& job, const Run& run)
    : directory_(std::move(directory)), job_(job), run_(run) {}

bool StageRunner::is_done(const std::string& name, const StageKey& key) const {
    const StageRecord* record = job_.stage(name);
    return record != nullptr && record->key == key.hash() &&
           std::all_of(record->outputs.begin(), record->outputs.end(),
                       [&](const OutputFile& output) {
                           return has_hash(directory_ / output.path, output.sha256);
                       });
}

std::string StageRunner::hash_of(const std::string& path) const {
    for (const StageRecord& stage : job_.stages) {
        for (const OutputFile& output : stage.outputs) {
            if (output.path == path) {
                return output.sha256;
            }
        }
    }
    return {};
}

decomp::Status StageRunner::run(const std::string& name, const StageKey& key, double weight,
                                const Body& body) {
    if (run_.cancelled()) {
        return decomp::cancelled();
    }
    const auto wall_start = std::chrono::steady_clock::now();
    const double cpu_start = cpu_seconds();
    const double from = done_weight_ / total_weight_;
    done_weight_ = std::min(done_weight_ + weight, total_weight_);
    const double to = done_weight_ / total_weight_;
    run_.progress(name, from);

    const bool kept = is_done(name, key);
    if (!kept) {
        Run inner = run_;
        inner.progress_sink = [&](const decomp::Progress& progress) {
            run_.progress(name, from + (to - from) * std::clamp(progress.fraction, 0.0, 1.0));
        };
        auto files = body(inner);
        if (!files) {
            return decomp::fail(std::move(files.error()));
        }
        if (run_.cancelled()) {
            return decomp::cancelled();
        }
        StageRecord finished{name, key.hash(), {}};
        for (const FileBytes& file : *files) {
            std::error_code ignored;
            fs::create_directories((directory_ / file.path).parent_path(), ignored);
            auto written =
                decomp::write_file(directory_ / file.path, file.bytes, decomp::Overwrite::Allow);
            if (!written) {
                return written;
            }
            finished.outputs.push_back({file.path, decomp::sha256_hex(file.bytes)});
        }
        replace_record(std::move(finished));
        if (auto written = write_job(); !written) {
            return written;
        }
    }
    visited_.push_back(name);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_start;
    timings_.push_back({name, kept, wall.count(), cpu_seconds() - cpu_start});
    run_.log(decomp::LogLevel::Debug,
             name + (kept ? ": kept" : ": made in " + decomp::fixed(wall.count(), 2) + " s"));
    run_.progress(name, to);
    return {};
}

void StageRunner::replace_record(StageRecord finished) {
    const auto same =
        std::find_if(job_.stages.begin(), job_.stages.end(),
                     [&](const StageRecord& stage) { return stage.name == finished.name; });
    if (same == job_.stages.end()) {
        job_.stages.push_back(std::move(finished));
        return;
    }
    for (const OutputFile& old : same->outputs) {
        const bool wanted =
            std::any_of(finished.outputs.begin(), finished.outputs.end(),
                        [&](const OutputFile& output) { return output.path == old.path; });
        if (!wanted) {
            remove_file(directory_ / old.path);
        }
    }
    *same = std::move(finished);
}

decomp::Status StageRunner::write_job() {
    job_.finished = false;
    return decomp::write_file(directory_ / "job.json", job_json(job_), decomp::Overwrite::Allow);
}

void StageRunner::keep_others() {
    visited_.clear();
    for (const StageRecord& stage : job_.stages) {
        visited_.push_back(stage.name);
    }
}

decomp::Status StageRunner::finish() {
    std::vector<StageRecord> ordered;
    std::set<std::string> wanted;
    for (const std::string& name : visited_) {
        const StageRecord* stage = job_.stage(name);
        ordered.push_back(*stage);
        for (const OutputFile& output : stage->outputs) {
            wanted.insert(output.path);
        }
    }
    for (const StageRecord& stage : job_.stages) {
        for (const OutputFile& output : stage.outputs) {
            if (wanted.count(output.path) == 0) {
                remove_file(directory_ / output.path);
            }
        }
    }
    job_.stages = std::move(ordered);
    job_.finished = true;
    run_.progress(visited_.empty() ? "finish" : visited_.back(), 1);
    return decomp::write_file(directory_ / "job.json", job_json(job_), decomp::Overwrite::Allow);
}

void remove_leftovers(const fs::path& directory) {
    std::error_code error;
    std::vector<fs::path> leftovers;
    for (fs::recursive_directory_iterator it(directory, error), end; !error && it != end;
         it.increment(error)) {
        if (it->path().filename().string().starts_with(".hew-")) {
            leftovers.push_back(it->path());
            it.disable_recursion_pending();
        }
    }
    for (const fs::path& leftover : leftovers) {
        fs::remove_all(leftover, error);
    }
}

}  // namespace cam::job
