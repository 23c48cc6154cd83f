// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/unite.h"

#include "decomp/base/parallel.h"
#include "decomp/mesh/measure.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

namespace decomp::pipeline {

namespace {

constexpr double kMoreSupport = 0.03;  // of the surface

struct Pair {
    std::int32_t a, b;  // regions, a < b
    double area;
};

using Refusals = std::set<std::pair<std::int32_t, std::int32_t>>;

double interface_area(const part::Part& part, std::int32_t neighbour) {
    double area = 0;
    for (std::size_t i = 0; i < part.sources.size(); ++i) {
        if (part.sources[i].is_cut() && part.sources[i].neighbour == neighbour) {
            area += mesh::double_area_normal(part.mesh, i).norm() / 2;
        }
    }
    return area;
}

/// Pairs that touch and have not been refused, largest interface first.
std::vector<Pair> open_pairs(const std::vector<Finished>& finished, const Refusals& refused) {
    std::vector<Pair> pairs;
    for (const Finished& one : finished) {
        std::set<std::int32_t> neighbours;
        for (const part::FacetSource& source : one.part.sources) {
            if (source.is_cut() && source.neighbour > one.region) {
                neighbours.insert(source.neighbour);
            }
        }
        for (const std::int32_t other : neighbours) {
            if (!refused.contains({one.region, other})) {
                pairs.push_back({one.region, other, interface_area(one.part, other)});
            }
        }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.area > b.area; });
    return pairs;
}

/// The union as a judge sees it: both surfaces without what lies between.
part::Part joined(const Finished& a, const Finished& b) {
    part::Part out;
    const auto add = [&](const Finished& one, std::int32_t other) {
        const auto shift = static_cast<std::uint32_t>(out.mesh.points.size());
        out.mesh.points.insert(out.mesh.points.end(), one.part.mesh.points.begin(),
                               one.part.mesh.points.end());
        for (std::size_t i = 0; i < one.part.sources.size(); ++i) {
            const part::FacetSource& source = one.part.sources[i];
            if (source.is_cut() && source.neighbour == other) {
                continue;
            }
            const mesh::Triangle& t = one.part.mesh.triangles[i];
            out.mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
            out.sources.push_back(source);
        }
    };
    add(a, b.region);
    add(b, a.region);
    return out;
}

Finished& of_region(std::vector<Finished>& finished, std::int32_t region) {
    return *std::find_if(finished.begin(), finished.end(),
                         [&](const Finished& one) { return one.region == region; });
}

bool acceptable(const Finished& a, const Finished& b, const part::Part& both,
                const part::Verdict& verdict) {
    const double apart = a.verdict.support_area_mm2 + b.verdict.support_area_mm2;
    return verdict.ok() &&
           verdict.support_area_mm2 <= apart + kMoreSupport * mesh::area_mm2(both.mesh);
}

/// The second region of a pair goes into the first; what touched it is read anew.
void merge(cut::Complex& complex, std::vector<Finished>& finished, const Pair& pair) {
    complex.merge(pair.a, pair.b);
    std::erase_if(finished, [&](const Finished& one) { return one.region == pair.b; });
    for (Finished& one : finished) {
        const bool touches =
            one.region == pair.a ||
            std::any_of(one.part.sources.begin(), one.part.sources.end(),
                        [&](const part::FacetSource& s) { return s.neighbour == pair.b; });
        if (touches) {
            one.part = complex.region(one.region);
        }
    }
}

/// A merge changes what its survivor can be united with.
void forget_gone(Refusals& refused, const std::vector<Finished>& finished) {
    std::erase_if(refused, [&](const auto& pair) {
        return std::none_of(finished.begin(), finished.end(),
                            [&](const Finished& one) { return one.region == pair.second; });
    });
}

}  // namespace

int unite_neighbours(cut::Complex& complex, std::vector<Finished>& finished,
                     const part::Judge& judge, Run& run) {
    Refusals refused;
    int merges = 0;
    for (bool merged = true; merged && !run.cancelled();) {
        merged = false;
        const std::vector<Pair> pairs = open_pairs(finished, refused);
        std::vector<char> good(pairs.size(), 0);
        for_each_index(run, pairs.size(), [&](std::size_t i) {
            const Finished& a = of_region(finished, pairs[i].a);
            const Finished& b = of_region(finished, pairs[i].b);
            const part::Part both = joined(a, b);
            good[i] = acceptable(a, b, both, judge(both, part::Fidelity::Exact)) ? 1 : 0;
        });
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (good[i] == 0) {
                refused.insert({pairs[i].a, pairs[i].b});
                continue;
            }
            if (merged) {
                continue;  // one merge a round: the others are looked at again beside it
            }
            merged = true;
            ++merges;
            merge(complex, finished, pairs[i]);
            Finished& survivor = of_region(finished, pairs[i].a);
            survivor.verdict = judge(survivor.part, part::Fidelity::Exact);
        }
        if (merged) {
            forget_gone(refused, finished);
        }
    }
    return merges;
}

}  // namespace decomp::pipeline
