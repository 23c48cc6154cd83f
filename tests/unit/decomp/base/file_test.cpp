// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/file.h"

#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

namespace {

TEST(File, ReadsBackWhatWasWritten) {
    const tests::TempDir dir;
    const std::string bytes("a\0b\n", 4);
    ASSERT_TRUE(decomp::write_file(dir / "f", bytes));
    EXPECT_EQ(decomp::read_file(dir / "f").value(), bytes);
}

TEST(File, RefusesToOverwriteUnlessAllowed) {
    const tests::TempDir dir;
    ASSERT_TRUE(decomp::write_file(dir / "f", "old"));
    EXPECT_EQ(decomp::write_file(dir / "f", "new").error().code, "file.exists");
    EXPECT_EQ(decomp::read_file(dir / "f").value(), "old");
    ASSERT_TRUE(decomp::write_file(dir / "f", "new", decomp::Overwrite::Allow));
    EXPECT_EQ(decomp::read_file(dir / "f").value(), "new");
}

TEST(File, LeavesNoTemporaryBehind) {
    const tests::TempDir dir;
    ASSERT_TRUE(decomp::write_file(dir / "f", "x"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

TEST(File, AMissingFolderIsAnErrorWithItsName) {
    const tests::TempDir dir;
    const auto status = decomp::write_file(dir / "no" / "f", "x");
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, "file.unwritable");
    EXPECT_NE(status.error().where.find("no"), std::string::npos);
}

TEST(File, AFolderCannotBeReadAsAFile) {
    const tests::TempDir dir;
    EXPECT_EQ(decomp::read_file(dir.path()).error().code, "file.unreadable");
    EXPECT_EQ(decomp::read_file(dir / "nothing").error().code, "file.not_found");
}

}  // namespace
