// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/check/mill4.h"

#include "cam/check/samples.h"
#include "decomp/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace cam::check {

using decomp::Result;
using decomp::Run;
using decomp::mesh::Facets;
using decomp::part::Part;
using visibility::Facing;
using visibility::Sight;

namespace {

/// Other starts of rays, for those that were not seen: lower, and higher.
constexpr double kLowLift = 1e-6;
constexpr double kHighLift = 1e-4;
constexpr std::array<visibility::RayStart, 2> kOtherStarts = {
    {{.lift = kLowLift, .skip_own = true}, {.lift = kHighLift, .skip_own = true}}};

class Checker {
  public:
    Checker(const Part& part, const Sight& sight, const Mill4Options& options, const Run& run,
            Mill4Check& out)
        : part_(part),
          sight_(sight),
          facets_(sight.facets()),
          options_(options),
          run_(run),
          out_(out),
          axis_(out.axes.front().axis),
          directions_(tool_directions(axis_, options.angles, options.a_sign)) {}

    void see() {
        const std::size_t count = facets_.unit.size();
        out_.stock = smallest_cylinder(part_.mesh, axis_);
        out_.setup_from_model = setup_from_model(out_.stock);
        out_.facets.end.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            out_.facets.end[i] = std::abs(facets_.unit[i].dot(axis_)) > kEndCosine ? 1 : 0;
        }
        if (options_.find_indices) {
            masks_ = sight_.seen_masks(directions_, Facing::Front, run_);
            out_.facets.seen.resize(count);
            for (std::size_t i = 0; i < count; ++i) {
                out_.facets.seen[i] = masks_[i] != 0 ? 1 : 0;
            }
        } else {
            out_.facets.seen = sight_.seen_from_any(directions_, Facing::Front, run_);
        }
        const auto& end = out_.facets.end;
        const auto& seen = out_.facets.seen;
        out_.ends = share([&](std::size_t i) { return end[i] != 0; });
        out_.unseen = share([&](std::size_t i) { return end[i] == 0 && seen[i] == 0; });
        out_.unseen_with_ends = share([&](std::size_t i) { return seen[i] == 0; });
        out_.facets.hidden_end.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            out_.facets.hidden_end[i] = end[i] != 0 && !sees_any(i, Facing::Wall, {}) ? 1 : 0;
        }
        out_.ends_unseen = share([&](std::size_t i) { return out_.facets.hidden_end[i] != 0; });
        out_.unreached_together = out_.unseen;
        out_.uncertain = share([&](std::size_t i) {
            return end[i] == 0 && seen[i] == 0 &&
                   std::any_of(kOtherStarts.begin(), kOtherStarts.end(), [&](const auto& start) {
                       return sees_any(i, Facing::Front, start);
                   });
        });
    }

    void find_indices() {
        out_.facets.index.assign(facets_.unit.size(), -1);
        if (!options_.find_indices) {
            return;
        }
        const Cover cover =
            cover_of(masks_, facets_, [&](std::size_t i) { return out_.facets.end[i] != 0; });
        out_.indices = indices_of(cover);
        chosen_ = 0;
        for (const int bit : cover.chosen) {
            chosen_ |= std::uint64_t{1} << bit;
        }
        for (std::size_t i = 0; i < masks_.size(); ++i) {
            for (std::size_t k = 0; k < cover.chosen.size() && out_.facets.index[i] < 0; ++k) {
                if ((masks_[i] >> cover.chosen[k] & 1U) != 0) {
                    out_.facets.index[i] = static_cast<int>(k);
                }
            }
        }
    }

    decomp::Status try_tools(const std::vector<tool::Tool>& tools) {
        if (tools.empty()) {
            return {};
        }
        samples_ = sample_facets(part_.mesh, facets_, {.spacing_mm = sample_spacing_mm(tools)});
        together_.assign(samples_.facet.size(), 0);
        for (const tool::Tool& tool : tools) {
            if (auto tried = try_tool(tool); !tried) {
                return tried;
            }
        }
        return {};
    }

  private:
    /// Bit j of a piece: reached from direction j.
    struct ReachMasks {
        std::vector<std::uint64_t> cutter;
        std::vector<std::uint64_t> whole;
    };

    [[nodiscard]] Result<ReachMasks> masks_of(const tool::Tool& tool) const {
        const std::size_t count = samples_.facet.size();
        std::vector<Result<Reach>> reaches(directions_.size(), Reach{});
        decomp::for_each_index(run_, directions_.size(), [&](std::size_t j) {
            reaches[j] =
                tool_reach(part_.mesh, samples_.pieces, directions_[j], tool, options_.reach);
        });
        ReachMasks masks;
        masks.cutter.assign(count, 0);
        masks.whole.assign(count, 0);
        for (std::size_t j = 0; j < reaches.size(); ++j) {
            if (!reaches[j]) {
                return decomp::fail(reaches[j].error());
            }
            for (std::size_t i = 0; i < count && !reaches[j]->tool.empty(); ++i) {
                masks.cutter[i] |= std::uint64_t{reaches[j]->cutter[i] != 0} << j;
                masks.whole[i] |= std::uint64_t{reaches[j]->tool[i] != 0} << j;
            }
        }
        if (run_.cancelled()) {
            return decomp::cancelled();
        }
        return masks;
    }

    decomp::Status try_tool(const tool::Tool& tool) {
        const auto masks = masks_of(tool);
        if (!masks) {
            return decomp::fail(masks.error());
        }
        const std::vector<std::uint64_t>& whole = masks->whole;
        const std::size_t facet_count = facets_.unit.size();
        const auto missed = [&](const std::vector<std::uint64_t>& by, std::uint64_t at) {
            return share_of(samples_, facet_count, [&](std::size_t i) {
                return out_.facets.end[samples_.facet[i]] == 0 && (by[i] & at) == 0;
            });
        };
        const std::uint64_t all = ~std::uint64_t{0};
        RotaryToolFigures figures;
        figures.tool = tool.name;
        figures.unreached_cutter = missed(masks->cutter, all);
        figures.unreached = missed(whole, all);
        figures.unreached_at_indices = missed(whole, chosen_);
        if (options_.find_indices) {
            figures.indices = indices_of(cover_of(whole, samples_.pieces, [&](std::size_t i) {
                return out_.facets.end[samples_.facet[i]] != 0;
            }));
        }
        out_.tools.push_back(std::move(figures));
        for (std::size_t i = 0; i < whole.size(); ++i) {
            together_[i] |= whole[i];
        }
        out_.unreached_together = missed(together_, all);
        if (out_.facets.reached.empty()) {
            std::vector<char> reached(whole.size());
            std::transform(whole.begin(), whole.end(), reached.begin(),
                           [](std::uint64_t mask) { return static_cast<char>(mask != 0 ? 1 : 0); });
            out_.facets.reached = mostly(samples_, facet_count, reached);
        }
        return {};
    }

    template <class Belongs>
    [[nodiscard]] Share share(Belongs belongs) const {
        return share_of(facets_, belongs);
    }

    [[nodiscard]] bool sees_any(std::size_t facet, Facing facing,
                                const visibility::RayStart& start) const {
        return std::any_of(directions_.begin(), directions_.end(), [&](const auto& direction) {
            return sight_.sees(facet, direction, facing, start);
        });
    }

    /// Ends need no index; others one that does not graze them, if there is one.
    template <class IsEnd>
    [[nodiscard]] Cover cover_of(std::vector<std::uint64_t> masks, const Facets& of,
                                 IsEnd is_end) const {
        for (std::size_t i = 0; i < masks.size(); ++i) {
            std::uint64_t good = 0;
            for (std::size_t j = 0; j < directions_.size(); ++j) {
                good |= std::uint64_t{of.unit[i].dot(directions_[j]) >= options_.good_cosine} << j;
            }
            good &= masks[i];
            masks[i] = is_end(i) ? 0 : good != 0 ? good : masks[i];
        }
        return smallest_cover(masks, of.area_mm2, options_.cover);
    }

    [[nodiscard]] Indices indices_of(const Cover& cover) const {
        const double percent = facets_.total_mm2 > 0 ? 100 / facets_.total_mm2 : 0;
        Indices indices;
        for (const int bit : cover.chosen) {
            indices.a_degrees.push_back(a_degrees(bit, options_.angles));
        }
        for (const double covered : cover.covered) {
            indices.covered_percent.push_back(percent * covered);
        }
        indices.coverable_percent = percent * cover.coverable;
        indices.smallest = cover.smallest;
        indices.at_least = cover.at_least;
        return indices;
    }

    const Part& part_;
    const Sight& sight_;
    const Facets& facets_;
    const Mill4Options& options_;
    const Run& run_;
    Mill4Check& out_;
    Eigen::Vector3d axis_;
    std::vector<Eigen::Vector3d> directions_;
    std::vector<std::uint64_t> masks_;
    Samples samples_;
    std::vector<std::uint64_t> together_;  // of all tools, a mask a piece
    std::uint64_t chosen_ = 0;
};

}  // namespace

Result<Mill4Check> check_mill4(const Part& part, const Mill4Options& options,
                               const std::vector<tool::Tool>& tools, const Run& run) {
    if (options.axis && !(options.axis->norm() > 0 && options.axis->allFinite())) {
        return decomp::fail("check.axis", "the rotary axis has no direction", {},
                            "give three numbers that are not all 0, e.g. --axis 0,0,1");
    }
    const Facets facets = decomp::mesh::measure_facets(part.mesh);
    const bool few_rays = options.axis && !options.find_indices;
    const auto sight =
        Sight::of(part.mesh, facets, few_rays ? visibility::Tree::Quick : visibility::Tree::Fine);
    if (!sight) {
        return decomp::fail(sight.error());
    }
    Mill4Check out;
    if (options.axis) {
        AxisChoice given;
        given.axis = options.axis->normalized();
        out.axes.push_back(given);
    } else {
        AxisOptions search = options.search;
        search.angles = options.angles;
        out.axes = search_axes(part, *sight, search, run);
    }
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    Checker checker(part, *sight, options, run, out);
    checker.see();
    checker.find_indices();
    if (const auto tried = checker.try_tools(tools); !tried) {
        return decomp::fail(tried.error());
    }
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    if (options.axis) {
        out.axes.front().unseen_percent = out.unseen.by_area_percent;
        out.axes.front().stock_mm3 =
            std::numbers::pi * out.stock.radius_mm * out.stock.radius_mm * out.stock.length_mm;
        const std::vector<char> closed = closed_ends(part, facets, out.axes.front().axis);
        const Share open = share_of(facets, [&](std::size_t i) {
            return out.facets.end[i] != 0 && out.facets.seen[i] == 0 && closed[i] == 0;
        });
        out.axes.front().open_end_percent = open.by_area_percent;
    }
    return out;
}

}  // namespace cam::check
