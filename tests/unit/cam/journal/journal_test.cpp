// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/journal/journal.h"

#include "decomp/base/file.h"
#include "decomp/base/rng.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace {

using namespace cam::journal;

std::string ten_records() {
    std::string bytes;
    for (std::uint64_t i = 0; i < 10; ++i) {
        bytes += record_line(i, "at " + std::to_string(100 * i));
    }
    return bytes;
}

TEST(Journal, WhatWasWrittenIsReadBack) {
    const Contents contents = read_records(ten_records());
    ASSERT_EQ(contents.records.size(), 10U);
    EXPECT_EQ(contents.records[9], "at 900");
    EXPECT_EQ(contents.torn_bytes, 0U);
}

TEST(Journal, CutAnywhereItHoldsEveryWholeRecordAndNoOther) {
    const std::string bytes = ten_records();
    for (std::size_t length = 0; length <= bytes.size(); ++length) {
        const Contents contents = read_records(bytes.substr(0, length));
        const auto whole = static_cast<std::size_t>(
            std::count(bytes.begin(), bytes.begin() + static_cast<long>(length), '\n'));
        ASSERT_EQ(contents.records.size(), whole) << length;
        ASSERT_EQ(contents.whole_bytes + contents.torn_bytes, length);
    }
}

TEST(Journal, AChangedByteEndsItBeforeTheRecordThatHoldsIt) {
    const std::string bytes = ten_records();
    decomp::Rng rng(7);
    for (int i = 0; i < 500; ++i) {
        std::string changed = bytes;
        const std::size_t at = rng.below(bytes.size());
        changed[at] = static_cast<char>(changed[at] ^ static_cast<char>(1 + rng.below(255)));
        const auto before = static_cast<std::size_t>(
            std::count(bytes.begin(), bytes.begin() + static_cast<long>(at), '\n'));
        EXPECT_EQ(read_records(changed).records.size(), before) << at;
    }
}

TEST(Journal, ARecordThatIsMissingEndsIt) {
    EXPECT_EQ(read_records(record_line(0, "a") + record_line(2, "c")).records.size(), 1U);
}

TEST(Journal, WhatIsFlushedIsOnTheDiskAndATornTailIsCutOff) {
    const tests::TempDir folder;
    const std::filesystem::path path = folder / "journal";
    {
        auto writer = Writer::create(path, {});
        ASSERT_TRUE(writer);
        (*writer)->add("begin");
        (*writer)->note("at 1", 1);
        (*writer)->note("at 2", 1);
        ASSERT_TRUE((*writer)->flush());
        EXPECT_EQ((*writer)->durable(), read_journal(path)->records.size());
        EXPECT_EQ(read_journal(path)->records.back(), "at 2");
    }
    const std::string torn = *decomp::read_file(path) + "deadbeef 9 at";
    ASSERT_TRUE(decomp::write_file(path, torn, decomp::Overwrite::Allow));
    const Contents contents = *read_journal(path);
    EXPECT_EQ(contents.torn_bytes, 13U);
    {
        auto writer = Writer::append(path, contents, {});
        ASSERT_TRUE(writer);
        (*writer)->add("resume");
    }
    EXPECT_EQ(read_journal(path)->records.back(), "resume");
    EXPECT_EQ(read_journal(path)->torn_bytes, 0U);
}

TEST(Journal, AnotherJobsJournalIsNotOverwritten) {
    const tests::TempDir folder;
    ASSERT_TRUE(decomp::write_file(folder / "journal", "x"));
    const auto writer = Writer::create(folder / "journal", {});
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().code, "file.exists");
}

TEST(Journal, AFullDiskIsAStatus) {
    if (!std::filesystem::exists("/dev/full")) {
        GTEST_SKIP() << "no /dev/full";
    }
    auto writer = Writer::append("/dev/full", {}, {});
    if (!writer) {
        GTEST_SKIP() << "cannot be truncated here";
    }
    (*writer)->add("begin", Writer::Urgency::Urgent);
    EXPECT_FALSE((*writer)->flush());
    EXPECT_EQ((*writer)->status().error().code, "file.unwritable");
}

}  // namespace
