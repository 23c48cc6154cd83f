// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/orient.h"
#include "decomp/io/read_mesh.h"
#include "tests/property/decomp/pipeline/sound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

namespace {

/// Real scans and mechanical parts, found through HEW_MODELS.
struct Case {
    const char* file;
    const char* up;
    std::optional<double> height_mm;
    std::size_t most_parts;
};

/// So that a test is listed by its file, the same in every build.
void PrintTo(const Case& one, std::ostream* out) { *out << one.file; }

class RealModel : public testing::TestWithParam<Case> {};

TEST_P(RealModel, IsCutIntoFewPartsThatAllFit) {
    const char* models = std::getenv("HEW_MODELS");
    if (models == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    decomp::Run run;
    const auto mesh =
        decomp::io::read_mesh(std::filesystem::path(models) / GetParam().file, {}, run);
    ASSERT_TRUE(mesh.has_value()) << mesh.error().text();
    const auto volume = decomp::io::to_model_frame(*mesh, *decomp::io::parse_up(GetParam().up),
                                                   GetParam().height_mm);
    const auto result = tests::sound(volume, tests::printer(227, 148, 150));
    EXPECT_GE(result.assembly.parts.size(), 2U);
    EXPECT_LE(result.assembly.parts.size(), GetParam().most_parts);
}

INSTANTIATE_TEST_SUITE_P(Decompose, RealModel,
                         testing::Values(Case{"paper/hfd_maxplank.obj", "y", 245, 4},
                                         Case{"paper/hfd_BU.obj", "x", 300, 4},
                                         Case{"real/od_nefertiti_lr.obj", "y", 400, 8},
                                         Case{"real/tm_plate_holes.stl", "z", std::nullopt, 4}),
                         [](const auto& one) {
                             std::string name =
                                 std::filesystem::path(one.param.file).stem().string();
                             std::replace(name.begin(), name.end(), '_', '0');
                             return name;
                         });

}  // namespace
