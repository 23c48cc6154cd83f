// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/rng.h"
#include "tests/cli/hew.h"

#include <chrono>

namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using tests::contents;
using tests::hew;
using tests::quick_make;
using tests::TempDir;

bool has_temporary_files(const fs::path& directory) {
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
        if (entry.path().filename().string().starts_with(".hew-")) {
            return true;
        }
    }
    return false;
}

class Resume : public testing::Test {
  protected:
    void SetUp() override {
        model_ = tests::write_stl(dir_, "bar.stl", tests::block(480, 60, 9));
        const auto start = std::chrono::steady_clock::now();
        ASSERT_EQ(hew(quick_make(model_, dir_ / "clean")).exit_code, 0);
        clean_run_ =
            std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - start);
        clean_ = contents(dir_ / "clean");
    }

    /// Files under final names are those of the clean run, whenever the run was killed; job.json
    /// alone grows.
    void expect_whole_files() const {
        if (!fs::exists(dir_ / "out")) {
            return;
        }
        for (const auto& [name, hash] : contents(dir_ / "out")) {
            const bool temporary = fs::path(name).filename().string().starts_with(".hew-");
            if (name == "job.json") {
                EXPECT_TRUE(tests::Json::accept(*decomp::read_file(dir_.path() / "out/job.json")));
            } else if (!temporary) {
                EXPECT_TRUE(clean_.count(name) == 1 && clean_.at(name) == hash)
                    << name << " is not whole";
            }
        }
    }

    TempDir dir_;
    std::string model_;
    milliseconds clean_run_{};
    std::map<std::string, std::string> clean_;
};

TEST_F(Resume, KilledAtAnyMomentTheNextRunCompletesWithTheSameBytes) {
    decomp::Rng rng(7);
    for (int i = 0; i < 6; ++i) {
        const milliseconds after(
            static_cast<long>(rng.uniform() * static_cast<double>(clean_run_.count())));
        hew(quick_make(model_, dir_ / "out"), tests::Kill{SIGKILL, after});
        expect_whole_files();
    }
    const auto run = hew(quick_make(model_, dir_ / "out"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(contents(dir_ / "out"), clean_);
    EXPECT_FALSE(has_temporary_files(dir_ / "out"));
}

TEST_F(Resume, FinishedStagesAreKept) {
    fs::copy(dir_ / "clean", dir_ / "out", fs::copy_options::recursive);
    fs::remove(dir_.path() / "out/plates/plate-1.gcode.proof.json");
    const auto run = hew(tests::with(quick_make(model_, dir_ / "out"), {"--json"}));
    ASSERT_EQ(run.exit_code, 0);
    const tests::Json answer = tests::object_of(run);
    EXPECT_EQ(answer["stages"].get<int>() - answer["stages_kept"].get<int>(), 1);
    EXPECT_EQ(contents(dir_ / "out"), clean_);
}

TEST_F(Resume, InterruptedItStopsWithoutTemporaryFilesAndWithCode130) {
    const auto run = hew(quick_make(model_, dir_ / "out"), tests::Kill{SIGINT, clean_run_ / 3});
    EXPECT_EQ(run.exit_code, 130) << run.err;
    if (fs::exists(dir_ / "out")) {
        EXPECT_FALSE(has_temporary_files(dir_ / "out"));
    }
    ASSERT_EQ(hew(quick_make(model_, dir_ / "out")).exit_code, 0);
    EXPECT_EQ(contents(dir_ / "out"), clean_);
}

}  // namespace
