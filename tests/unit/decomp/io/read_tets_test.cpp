// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/read_tets.h"

#include "decomp/io/write_tets.h"
#include "decomp/tets/boundary.h"
#include "decomp/tets/measure.h"
#include "decomp/tets/pair.h"
#include "tests/support/tet_shapes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace {

using namespace decomp;

tets::TetMesh block() {
    auto mesh = tests::voxel_tets({2, 1, 1}, [](int, int, int) { return true; });
    for (Eigen::Vector3d& p : mesh.points) {
        p *= 1.0 / 3.0;
    }
    return mesh;
}

TEST(ReadTets, MeditAndVtkGiveBackTheSameBits) {
    const auto mesh = block();
    for (const std::string& bytes :
         {io::medit_bytes(mesh.points, mesh.tets, {}), io::vtk_bytes(mesh.points, mesh.tets)}) {
        const auto read = io::parse_tets(bytes, "file", {});
        ASSERT_TRUE(read.has_value()) << read.error().text();
        EXPECT_EQ(read->points, mesh.points);
        EXPECT_EQ(read->tets, mesh.tets);
    }
}

TEST(ReadTets, MeditHoldsTheLabelsOfTheBoundary) {
    const auto mesh = block();
    std::vector<int> references(tets::boundary_of(mesh.tets).size(), 5);
    references[0] = 3;
    const std::string bytes = io::medit_bytes(mesh.points, mesh.tets, references);
    EXPECT_NE(bytes.find(" 3\n"), std::string::npos);
}

TEST(ReadTets, AHexahedronIsSixTetsOfItsVolumeAndNeighboursConform) {
    // Two cubes that share a face, their corners listed differently.
    const std::string bytes =
        "MeshVersionFormatted 1\nDimension 3\nVertices 12\n"
        "0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\n"
        "2 0 0 0\n2 1 0 0\n2 0 1 0\n2 1 1 0\n"
        "Hexahedra 2\n1 2 3 4 5 6 7 8 0\n10 3 2 9 12 7 6 11 0\nEnd\n";
    const auto read = io::parse_tets(bytes, "two.mesh", {});
    ASSERT_TRUE(read.has_value()) << read.error().text();
    EXPECT_EQ(read->tets.size(), 12U);
    const auto pair = tets::pair_of(*read, *read);
    ASSERT_TRUE(pair.has_value());
    EXPECT_DOUBLE_EQ(tets::measure(*pair).volume_mm3, 2.0);
    EXPECT_EQ(tets::boundary_of(pair->tets).size(), 20U);
}

TEST(ReadTets, VtkOfVersionFiveWithOffsetsIsRead) {
    const std::string bytes =
        "# vtk DataFile Version 5.1\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
        "0 0 0 1 0 0 0 1 0\n0 0 1\nCELLS 2 4\nOFFSETS vtktypeint64\n0 4\n"
        "CONNECTIVITY vtktypeint64\n0 1 2 3\nCELL_TYPES 1\n10\n";
    const auto read = io::parse_tets(bytes, "five.vtk", {});
    ASSERT_TRUE(read.has_value()) << read.error().text();
    ASSERT_EQ(read->tets.size(), 1U);
    EXPECT_EQ(read->tets[0], (tets::Tet{0, 1, 2, 3}));
}

TEST(ReadTets, FaultsAreNamed) {
    const auto code = [](const std::string& bytes) {
        const auto read = io::parse_tets(bytes, "file", {});
        return read ? std::string("read") : read.error().code;
    };
    EXPECT_EQ(code("solid\n"), "io.unknown_format");
    EXPECT_EQ(code("# vtk DataFile Version 3.0\nt\nBINARY\n"), "io.unsupported");
    EXPECT_EQ(code("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n"), "io.unsupported");
    EXPECT_EQ(
        code(
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n0 0"),
        "io.truncated");
    EXPECT_EQ(
        code("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n"
             "0 0 0\nCELLS 1 5\n4 0 0 0 7\n"),
        "io.index_out_of_range");
    EXPECT_EQ(code("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS "
                   "99999999 float\n"),
              "io.too_large");
    EXPECT_EQ(code("MeshVersionFormatted 1\nDimension 3\nVertices 1\n0 0 0 0\nEnd\n"), "io.empty");
}

/// Polycubes made elsewhere: not integer, some tets inverted, hexahedra, other orders.
TEST(ReadTets, ForeignPairsAreRead) {
    const char* models = std::getenv("HEW_MODELS");
    if (models == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    const std::filesystem::path folder = std::filesystem::path(models) / "polycubes";
    for (const auto& [shape, polycube] :
         {std::pair{"l1_kitty_orig.tet.vtk", "l1_kitty_polycube.tet.vtk"},
          std::pair{"l1_angel_1_orig.tet.vtk", "l1_angel_1_polycube.tet.vtk"},
          std::pair{"hexpair_block_model_in.mesh", "hexpair_block_polycube_in.mesh"}}) {
        auto a = io::read_tets(folder / shape, {});
        auto b = io::read_tets(folder / polycube, {});
        ASSERT_TRUE(a.has_value()) << a.error().text();
        ASSERT_TRUE(b.has_value()) << b.error().text();
        const auto pair = tets::pair_of(std::move(*a), std::move(*b));
        ASSERT_TRUE(pair.has_value()) << pair.error().text();
        EXPECT_LT(tets::measure(*pair).flipped_share, 0.06) << shape;
    }
}

}  // namespace
