// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/oracle/decomp/repair/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace {

TEST(Models, EveryPrintableModelReadsAndIsASolidOrEasilyMadeOne) {
    const char* models = std::getenv("HEW_MODELS");
    if (models == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    std::vector<std::filesystem::path> files;
    for (const char* folder : {"paper", "real"}) {
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(models) / folder)) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename().string());
        const auto read = decomp::io::read_mesh(file, {}, decomp::Run{});
        ASSERT_TRUE(read) << read.error().text();
        const auto repaired = decomp::repair::repair(*read, {}, decomp::Run{});
        ASSERT_TRUE(repaired) << repaired.error().text();
        EXPECT_LE(repaired->report.status, decomp::repair::Status::Fixed);
        tests::expect_solid(*repaired);
    }
    EXPECT_FALSE(files.empty());
}

}  // namespace
