// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/hew.h"
#include "tests/support/milling.h"

#include <cmath>

namespace {

namespace fs = std::filesystem;
using tests::hew;
using tests::Json;
using tests::object_of;
using tests::write_stl;

/// A block 30 x 24 mm with a wavy top and a pocket 6 mm wide in it, its walls as steep as the
/// squares of 1 mm that make it up.
std::string bumpy_block(const tests::TempDir& dir) {
    constexpr std::uint32_t kLength = 30;
    constexpr std::uint32_t kWidth = 24;
    decomp::mesh::TriMesh mesh;
    const auto index = [](std::uint32_t x, std::uint32_t y, std::uint32_t top) {
        return (y * (kLength + 1) + x) * 2 + top;
    };
    for (std::uint32_t y = 0; y <= kWidth; ++y) {
        for (std::uint32_t x = 0; x <= kLength; ++x) {
            const bool in_pocket = x >= 7 && x <= 13 && y >= 7 && y <= 16;
            const double z = in_pocket ? 4 : 9 + std::sin(0.4 * x) + 0.8 * std::cos(0.3 * y);
            mesh.points.emplace_back(x, y, 0);
            mesh.points.emplace_back(x, y, z);
        }
    }
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (std::uint32_t y = 0; y < kWidth; ++y) {
        for (std::uint32_t x = 0; x < kLength; ++x) {
            quad(index(x, y, 1), index(x + 1, y, 1), index(x + 1, y + 1, 1), index(x, y + 1, 1));
            quad(index(x, y, 0), index(x, y + 1, 0), index(x + 1, y + 1, 0), index(x + 1, y, 0));
        }
    }
    for (std::uint32_t x = 0; x < kLength; ++x) {
        quad(index(x, 0, 0), index(x + 1, 0, 0), index(x + 1, 0, 1), index(x, 0, 1));
        quad(index(x + 1, kWidth, 0), index(x, kWidth, 0), index(x, kWidth, 1),
             index(x + 1, kWidth, 1));
    }
    for (std::uint32_t y = 0; y < kWidth; ++y) {
        quad(index(0, y + 1, 0), index(0, y, 0), index(0, y, 1), index(0, y + 1, 1));
        quad(index(kLength, y, 0), index(kLength, y + 1, 0), index(kLength, y + 1, 1),
             index(kLength, y, 1));
    }
    return write_stl(dir, "block.stl", mesh);
}

TEST(Mill, ABumpyBlockWithAPocketIsProved) {
    const tests::TempDir dir;
    const auto run =
        hew({"mill", bumpy_block(dir), "--machine", "linuxcnc-router-3axis", "--setups", "1",
             "--scallop", "0.1", "-o", (dir / "out" / "p.ngc").string(), "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    const Json answer = object_of(run);
    EXPECT_EQ(answer["programs"][0]["max_gouge_mm"], 0) << answer.dump(1);
    EXPECT_LT(answer["programs"][0]["unreachable_percent"], 8) << answer.dump(1);
    const auto picture = decomp::read_file(dir / "out" / "p.stock.png");
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->substr(1, 3), "PNG");
    const auto sheet = decomp::read_file(dir / "out" / "p.html");
    ASSERT_TRUE(sheet);
    EXPECT_NE(sheet->find("src=\"p.stock.png\""), std::string::npos);
}

TEST(Mill, WhatIsThereIsNotOverwrittenAndThatIsSaidBeforePlanning) {
    const tests::TempDir dir;
    fs::create_directories(dir / "out");
    ASSERT_TRUE(decomp::write_file(dir / "out" / "setup.json", "{}", decomp::Overwrite::Refuse));
    const auto run = hew({"mill", bumpy_block(dir), "--machine", "linuxcnc-router-3axis", "-o",
                          (dir / "out" / "p.ngc").string(), "--json"});
    EXPECT_EQ(run.exit_code, 6) << run.err;
    EXPECT_EQ(object_of(run)["error"]["code"], "file.exists");
    EXPECT_EQ(run.err.find(" %"), std::string::npos) << "nothing was begun: " << run.err;
    EXPECT_EQ(*decomp::read_file(dir / "out" / "setup.json"), "{}");
}

}  // namespace
