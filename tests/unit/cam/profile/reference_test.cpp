// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_profile.h"
#include "decomp/base/file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

namespace {

TEST(ProfileReference, IsWhatTheTableSays) {
    const std::string path = std::string(HEW_SOURCE_DIR) + "/docs/profiles.md";
    const std::string wanted = cam::profile::profile_reference_markdown();
    if (std::getenv("HEW_BLESS") != nullptr) {
        ASSERT_TRUE(decomp::write_file(path, wanted, decomp::Overwrite::Allow));
    }
    const auto committed = decomp::read_file(path);
    ASSERT_TRUE(committed) << committed.error().text();
    EXPECT_TRUE(*committed == wanted)
        << "docs/profiles.md is out of date: HEW_BLESS=1 ctest -R Profile";
}

TEST(ProfileReference, EveryFieldIsThereOnceAndExplained) {
    std::set<std::string> seen;
    for (const cam::profile::FieldRow& row : cam::profile::describe(cam::profile::FdmSetup{})) {
        EXPECT_TRUE(seen.insert(row.section + "." + row.key).second) << row.key;
        EXPECT_FALSE(row.doc.empty()) << row.key;
    }
    EXPECT_GT(seen.size(), 60U);
}

TEST(ProfileReference, KeysEndInTheirUnit) {
    const std::set<std::pair<std::string, std::string>> suffixes = {
        {"mm", "_mm"},
        {"mm/s", "_mm_per_s"},
        {"mm/s^2", "_mm_per_s2"},
        {"mm^3/s", "_mm3_per_s"},
        {"degrees", "_deg"},
        {"degrees C", "celsius"},
        {"s", "_s"},
        {"g/cm^3", "_g_per_cm3"},
        {"layers", "_layers"},
    };
    for (const cam::profile::FieldRow& row : cam::profile::describe(cam::profile::FdmSetup{})) {
        if (row.unit.empty()) {
            continue;
        }
        bool matches = false;
        for (const auto& [unit, suffix] : suffixes) {
            matches = matches || (row.unit == unit && row.key.ends_with(suffix));
        }
        EXPECT_TRUE(matches) << row.key << " in " << row.unit;
    }
}

}  // namespace
