// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/partition/partition.h"
#include "tests/support/pairs.h"

#include <gtest/gtest.h>

namespace tests {

struct Sample {
    decomp::mesh::TriMesh shape;
    decomp::part::Assembly assembly;
    decomp::partition::Figures figures;
    std::size_t boxes = 0;
};

/// The partition of a shape by a map, assembled.
inline Sample partitioned(const decomp::mesh::TriMesh& shape, const decomp::tets::Pair& pair,
                          const decomp::tets::Lattice& lattice,
                          const decomp::partition::PartitionOptions& options = {}) {
    decomp::Run run;
    auto found = decomp::partition::partition(shape, pair, lattice, options, run);
    EXPECT_TRUE(found.has_value()) << (found ? "" : found.error().text());
    if (!found) {
        return {};
    }
    std::vector<std::int32_t> order;
    for (const auto& part : found->parts) {
        order.push_back(part.region);
    }
    EXPECT_TRUE(found->complex.volumes_sum_exactly());
    auto assembly = found->complex.assemble(order, run);
    EXPECT_TRUE(assembly.has_value()) << (assembly ? "" : assembly.error().text());
    return {shape, assembly ? std::move(*assembly) : decomp::part::Assembly{}, found->figures,
            found->sheets.boxes.size()};
}

}  // namespace tests
