// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/plan/workpiece.h"

#include "decomp/base/assert.h"
#include "decomp/base/nearest.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace decomp::plan {

namespace {

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (const std::string& name : names) {
        out += (out.empty() ? "" : ", ") + name;
    }
    return out;
}

/// The error of another room, at the place of the step.
tl::unexpected<Error> at_step(Error error, const Step& step) {
    if (!step.where.empty()) {
        error.where = step.where + (error.where.empty() ? "" : ": ") + error.where;
    }
    return fail(std::move(error));
}

}  // namespace

Workpiece::Workpiece(cut::Complex complex) : complex_(std::move(complex)) {
    for (std::int32_t body = 0; body < complex_.region_count(); ++body) {
        regions_.emplace(region_name(body), body);
    }
}

Result<Workpiece> Workpiece::of(const mesh::TriMesh& volume) {
    Result<cut::Complex> complex = cut::Complex::from_volume(volume);
    if (!complex) {
        return fail(complex.error());
    }
    return Workpiece(std::move(*complex));
}

Result<Workpiece> Workpiece::carried_out(const mesh::TriMesh& volume, const Plan& plan) {
    if (plan.shape_sha256 != shape_sha256(volume)) {
        return fail("plan.other_shape", "the plan was made for another shape", "",
                    "give the model that it was made for with the same --unit, --scale, --up and "
                    "--height, or make a new plan");
    }
    Result<Workpiece> out = of(volume);
    for (std::size_t i = 0; out && i < plan.steps.size(); ++i) {
        const auto done = out->carry_out(plan.steps[i]);
        if (!done) {
            return fail(done.error());
        }
    }
    return out;
}

Result<std::vector<std::string>> Workpiece::carry_out(const Step& step) {
    if (Status there = known(step.region, step); !there) {
        return fail(there.error());
    }
    return step.kind == Step::Kind::Cut ? cut(step) : merge(step);
}

Status Workpiece::known(const std::string& name, const Step& step) const {
    if (regions_.contains(name)) {
        return {};
    }
    std::vector<std::string> names;
    names.reserve(regions_.size());
    for (const auto& [there, region] : regions_) {
        names.push_back(there);
    }
    const auto gone = gone_.find(name);
    std::string hint = gone != gone_.end() ? gone->second : did_you_mean(name, names);
    return fail("plan.no_such_region", "there is no region '" + name + "' at this step", step.where,
                hint.empty() ? "at this step there are " + listed(names) : std::move(hint));
}

Result<std::vector<std::string>> Workpiece::cut(const Step& step) {
    for (const std::string& name : step.names) {
        if (name != step.region && regions_.contains(name)) {
            return fail("plan.name_taken", "a region is called '" + name + "' already", step.where,
                        "choose another name, and use it in the steps below");
        }
    }
    const std::int32_t region = regions_.at(step.region);
    const Result<std::vector<std::int32_t>> ids =
        step.loops_mm.empty() ? complex_.split(region, step.plane)
                              : complex_.split_near(region, step.plane, step.loops_mm);
    if (!ids) {
        return at_step(ids.error(), step);
    }
    if (ids->size() < 2) {
        return fail("plan.cut_misses", "the plane does not divide '" + step.region + "'",
                    step.where, "move the plane, or leave the cut out");
    }
    regions_.erase(step.region);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < ids->size(); ++i) {
        std::string name = step.region;
        if (i < step.names.size()) {
            name = step.names[i];
        } else if (i > 0) {
            for (std::size_t k = i + 1; name == step.region || regions_.contains(name); ++k) {
                name = step.region + "." + std::to_string(k);
            }
        }
        regions_[name] = (*ids)[i];
        gone_.erase(name);
        names.push_back(std::move(name));
    }
    if (!regions_.contains(step.region)) {
        gone_[step.region] = "it was cut into " + listed(names);
    }
    return names;
}

Result<std::vector<std::string>> Workpiece::merge(const Step& step) {
    for (const std::string& name : step.names) {
        if (Status there = known(name, step); !there) {
            return fail(there.error());
        }
    }
    // They need not all touch the first: it is enough that together they are one piece.
    std::vector<std::string> open = step.names;
    std::vector<std::int32_t> joined{regions_.at(step.region)};
    for (bool found = true; found && !open.empty();) {
        found = false;
        for (const std::string& name : open) {
            const std::int32_t region = regions_.at(name);
            found = std::any_of(joined.begin(), joined.end(), [&](std::int32_t other) {
                return other == region || complex_.touch(other, region);
            });
            if (found) {
                joined.push_back(region);
                std::erase(open, std::string(name));
                break;
            }
        }
    }
    if (!open.empty()) {
        return fail("plan.not_neighbours",
                    "'" + open.front() + "' and '" + step.region + "' do not touch", step.where,
                    "only parts with a common face can be merged");
    }
    for (const std::string& name : step.names) {
        if (name != step.region) {
            complex_.merge(joined.front(), regions_.at(name));
            regions_.erase(name);
            gone_[name] = "it was merged into " + step.region;
        }
    }
    return std::vector<std::string>{step.region};
}

const std::string& Workpiece::name_of(std::int32_t region) const {
    const auto found = std::find_if(regions_.begin(), regions_.end(),
                                    [&](const auto& entry) { return entry.second == region; });
    DECOMP_ASSERT(found != regions_.end());
    return found->first;
}

}  // namespace decomp::plan
