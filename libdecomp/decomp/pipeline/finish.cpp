// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/finish.h"

#include "decomp/base/parallel.h"
#include "decomp/mesh/measure.h"
#include "decomp/sections/interface_neck.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

namespace decomp::pipeline {

namespace {

constexpr double kOneLevel = 1e-3;  // of the diagonal: centres this near are level

}  // namespace

std::vector<std::int32_t> reading_order(const cut::Complex& complex, double diagonal_mm,
                                        const Run& run) {
    std::vector<std::pair<std::array<double, 3>, std::int32_t>> keys;
    for (std::int32_t region = 0; region < complex.region_count(); ++region) {
        if (!complex.is_empty(region)) {
            keys.push_back({{}, region});
        }
    }
    for_each_index(run, keys.size(), [&](std::size_t i) {
        const Eigen::Vector3d c = mesh::bounds(complex.region(keys[i].second).mesh).center();
        const auto level = [&](double value) {
            return std::round(value / (kOneLevel * diagonal_mm));
        };
        keys[i].first = {level(c.z()), level(c.x()), level(c.y())};
    });
    std::sort(keys.begin(), keys.end());
    std::vector<std::int32_t> order;
    order.reserve(keys.size());
    for (const auto& key : keys) {
        order.push_back(key.second);
    }
    return order;
}

Result<Decomposition> as_parts(const cut::Complex& complex, const std::vector<std::int32_t>& order,
                               const part::Judge& judge, const Run& run) {
    Result<part::Assembly> assembly = complex.assemble(order, run);
    if (!assembly) {
        return fail(assembly.error());
    }
    Decomposition out;
    out.assembly = std::move(*assembly);
    for (const part::Part& part : out.assembly.parts) {
        out.verdicts.push_back(judge(part, part::Fidelity::Exact));
        out.poses.push_back(out.verdicts.back().best_pose);
    }
    out.necks_mm.resize(out.assembly.interfaces.size());
    for_each_index(run, out.assembly.interfaces.size(), [&](std::size_t i) {
        out.necks_mm[i] = sections::interface_neck_mm(out.assembly, out.assembly.interfaces[i]);
    });
    std::set<std::int32_t> planes;
    for (const part::Interface& interface : out.assembly.interfaces) {
        planes.insert(interface.plane);
    }
    out.cuts = static_cast<int>(planes.size());
    return out;
}

}  // namespace decomp::pipeline
