// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/rng.h"
#include "decomp/mesh/measure.h"
#include "tests/oracle/cam/fdm/proof_of.h"
#include "tests/support/random_shapes.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cstdlib>

/// Random shapes sliced and proved: a few here, as many as HEW_RANDOM_PARTS says by hand, from the
/// seed HEW_RANDOM_FIRST on.
namespace {

using tests::TriMesh;

int from_environment(const char* name, int otherwise) {
    const char* asked = std::getenv(name);
    return asked != nullptr ? std::atoi(asked) : otherwise;
}

TriMesh on_the_bed(TriMesh mesh) {
    const double low = decomp::mesh::bounds(mesh).min().z();
    for (auto& p : mesh.points) {
        p.z() -= low;
    }
    return mesh;
}

void expect_proved(const TriMesh& part, const std::string& name) {
    const auto proof = tests::proof_of(part);
    for (const auto& fault : proof.faults) {
        ADD_FAILURE() << name << ": " << fault.code << " line " << fault.line << " layer "
                      << fault.layer << ": " << fault.text;
    }
    EXPECT_LE(proof.figures.uncovered_skin_percent, 0.2) << name;
    EXPECT_LE(proof.figures.out_of_part_percent, 0.01) << name;
}

/// A lump of random bumps, long, flat or round, that touches the bed in a point: all of its lower
/// half hangs.
TriMesh lump(decomp::Rng& rng) {
    TriMesh out = tests::sphere(rng.uniform(6, 12), 36, 23);
    Eigen::Vector3d stretch;
    for (int axis = 0; axis < 3; ++axis) {
        stretch[axis] = rng.uniform(0.6, 1.6);
    }
    for (auto& p : out.points) {
        p = rng.uniform(0.92, 1.06) * p.cwiseProduct(stretch);
    }
    return on_the_bed(std::move(out));
}

TEST(RandomProofs, Lumps) {
    decomp::Rng rng(17);
    for (int i = 0; i < from_environment("HEW_RANDOM_PARTS", 4); ++i) {
        expect_proved(lump(rng), "lump " + std::to_string(i));
    }
}

/// About 40 mm long.
TriMesh shape(int seed) {
    TriMesh out = tests::random_shape(static_cast<std::uint64_t>(seed));
    constexpr double kScale = 0.6;
    for (auto& p : out.points) {
        p *= kScale;
    }
    return on_the_bed(std::move(out));
}

TEST(RandomProofs, ShapesOfSevenFamilies) {
    const int first = from_environment("HEW_RANDOM_FIRST", 0);
    const int count = from_environment("HEW_RANDOM_PARTS", 7);
    for (int seed = first; seed < first + count; ++seed) {
        expect_proved(shape(seed), "seed " + std::to_string(seed));
    }
}

TEST(RandomProofs, ShapesWhoseSupportsOnceFloated) {
    for (const int seed : {21, 28, 126, 213, 231, 240}) {
        expect_proved(shape(seed), "seed " + std::to_string(seed));
    }
}

}  // namespace
