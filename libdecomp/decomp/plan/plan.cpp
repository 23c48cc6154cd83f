// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/plan/plan.h"

#include "decomp/base/assert.h"
#include "decomp/base/hash.h"

#include <array>
#include <bit>
#include <cstddef>

namespace decomp::plan {

namespace {

void append(std::string& bytes, std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) {
        bytes += static_cast<char>((value >> shift) & 0xffU);
    }
}

}  // namespace

std::string shape_sha256(const mesh::TriMesh& volume) {
    std::string bytes;
    bytes.reserve(24 * (volume.points.size() + volume.triangles.size()) + 8);
    append(bytes, volume.points.size());
    for (const Eigen::Vector3d& point : volume.points) {
        for (const double coordinate : point) {
            append(bytes, std::bit_cast<std::uint64_t>(coordinate + 0.0));
        }
    }
    for (const mesh::Triangle& triangle : volume.triangles) {
        for (const std::uint32_t corner : triangle) {
            append(bytes, corner);
        }
    }
    return sha256_hex(bytes);
}

std::string region_name(std::int32_t region) { return "r" + std::to_string(region); }

std::vector<Step> steps_of(const cut::Complex& complex, const std::vector<std::string>& by) {
    DECOMP_ASSERT(by.size() == complex.steps().size());
    std::vector<Step> out;
    for (std::size_t i = 0; i < by.size(); ++i) {
        const cut::Step& done = complex.steps()[i];
        Step step;
        step.region = region_name(done.region);
        step.by = by[i];
        for (const std::int32_t other : done.others) {
            step.names.push_back(region_name(other));
        }
        if (done.kind == cut::Step::Kind::Merge) {
            step.kind = Step::Kind::Merge;
            Step* last = out.empty() ? nullptr : &out.back();
            if (last != nullptr && last->kind == Step::Kind::Merge && last->region == step.region &&
                last->by == step.by) {
                last->names.push_back(step.names.front());
                continue;
            }
        } else {
            step.plane = done.plane;
            step.loops_mm = done.inside_mm;
        }
        out.push_back(std::move(step));
    }
    return out;
}

}  // namespace decomp::plan
