// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/rng.h"
#include "decomp/io/read_tets.h"
#include "decomp/map/quantise.h"
#include "decomp/tets/boundary.h"
#include "decomp/tets/pair.h"
#include "tests/oracle/decomp/partition/checker.h"
#include "tests/oracle/decomp/partition/sample.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

namespace {

using tests::faults_of;
using tests::Sample;
using tests::Voxel;

/// A connected heap of voxels, grown at random faces, without two that touch along an edge or at a
/// corner alone.
std::vector<Voxel> heap(decomp::Rng& rng, int count) {
    std::set<Voxel> taken{{0, 0, 0}};
    const auto manifold = [&] {
        for (const Voxel& v : taken) {
            for (int i = 0; i < 27; ++i) {
                const Voxel d{i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
                if (std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]) < 2 ||
                    !taken.contains({v[0] + d[0], v[1] + d[1], v[2] + d[2]})) {
                    continue;
                }
                bool linked = false;
                for (std::size_t k = 0; k < 3; ++k) {
                    Voxel step = v;
                    step.at(k) += d.at(k);
                    linked = linked || (d.at(k) != 0 && taken.contains(step));
                }
                if (!linked) {
                    return false;
                }
            }
        }
        return true;
    };
    while (static_cast<int>(taken.size()) < count) {
        auto at = taken.begin();
        std::advance(at, static_cast<std::ptrdiff_t>(rng.uniform(0, double(taken.size()))));
        Voxel next = *at;
        const int side = static_cast<int>(rng.uniform(0, 6));
        next.at(static_cast<std::size_t>(side / 2)) += side % 2 == 0 ? 1 : -1;
        if (taken.insert(next).second && !manifold()) {
            taken.erase(next);
        }
    }
    return {taken.begin(), taken.end()};
}

TEST(PartitionOracle, RandomHeapsOfVoxelsAreCutIntoSoundParts) {
    decomp::Rng rng(20);
    for (int trial = 0; trial < 24; ++trial) {
        const auto voxels = heap(rng, 4 + trial % 7);
        const double wave = rng.uniform(0, 0.06);
        const auto map =
            tests::voxel_pair(voxels, 10, 2, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
                return {p.x() + 0.2 * p.y() + wave * 9 * std::sin(p.z() / 7),
                        p.y() - 0.1 * p.z() + wave * 9 * std::sin(p.x() / 6),
                        p.z() + wave * 9 * std::sin(p.y() / 8)};
            });
        for (const bool limit : {true, false}) {
            decomp::partition::PartitionOptions options;
            options.limit_cuts = limit;
            options.paper = limit && trial % 3 == 0;
            const Sample s = tests::partitioned(map.surface, map.pair, map.lattice, options);
            EXPECT_TRUE(faults_of(s.assembly, s.shape, {.points = 150}).empty())
                << "trial " << trial << " limited " << limit;
            EXPECT_GE(s.assembly.parts.size() + 3, s.boxes) << trial;
        }
    }
}

class ForeignPolycube : public testing::TestWithParam<std::array<const char*, 2>> {};

TEST_P(ForeignPolycube, GivesASoundPartition) {
    const char* models = std::getenv("HEW_MODELS");
    if (models == nullptr) {
        GTEST_SKIP() << "HEW_MODELS is not set";
    }
    const std::filesystem::path folder = std::filesystem::path(models) / "polycubes";
    auto shape = decomp::io::read_tets(folder / GetParam()[0], {});
    auto polycube = decomp::io::read_tets(folder / GetParam()[1], {});
    ASSERT_TRUE(shape.has_value() && polycube.has_value());
    const auto pair = decomp::tets::pair_of(std::move(*shape), std::move(*polycube));
    ASSERT_TRUE(pair.has_value()) << pair.error().text();
    const auto surface = decomp::tets::boundary_surface(pair->shape, pair->tets).surface;
    const Sample s = tests::partitioned(surface, *pair, decomp::map::lattice_of(*pair));
    EXPECT_TRUE(faults_of(s.assembly, s.shape).empty());
    EXPECT_GE(s.assembly.parts.size(), 4U);
}

INSTANTIATE_TEST_SUITE_P(Models, ForeignPolycube,
                         testing::Values(std::array<const char*, 2>{"l1_kitty_orig.tet.vtk",
                                                                    "l1_kitty_polycube.tet.vtk"},
                                         std::array<const char*, 2>{"l1_angel_1_orig.tet.vtk",
                                                                    "l1_angel_1_polycube.tet.vtk"},
                                         std::array<const char*, 2>{
                                             "hexpair_block_model_in.mesh",
                                             "hexpair_block_polycube_in.mesh"}),
                         [](const auto& info) {
                             std::string name = info.param[0];
                             std::erase_if(name, [](char c) {
                                 return std::isalnum(static_cast<unsigned char>(c)) == 0;
                             });
                             return name;
                         });

}  // namespace
