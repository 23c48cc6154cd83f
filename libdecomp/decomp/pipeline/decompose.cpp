// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/decompose.h"

#include "decomp/base/number.h"
#include "decomp/cut/complex.h"
#include "decomp/mesh/measure.h"
#include "decomp/pipeline/boxes.h"
#include "decomp/pipeline/by_hand.h"
#include "decomp/pipeline/finish.h"
#include "decomp/pipeline/nudge.h"
#include "decomp/pipeline/plan.h"
#include "decomp/pipeline/settle.h"
#include "decomp/pipeline/unite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace decomp::pipeline {

namespace {

constexpr std::array<double, 4> kNudges{3e-5, 5e-5, 7e-5, 1e-4};  // of the diagonal
constexpr int kSplitTries = 4;        // positions of one plane tried where a split is refused
constexpr int kPlannedDepth = 24;     // deeper regions are only bisected
constexpr double kSamePlane = 1e-9;   // of the diagonal: offsets of one plane
constexpr double kSameVolume = 0.05;  // relative: a planned piece and the region that it became
constexpr double kSameCentre = 0.03;  // of the diagonal

constexpr std::array<std::pair<const char*, Mode>, 3> kModes{
    {{"sheets", Mode::Sheets}, {"paper", Mode::Paper}, {"sections", Mode::Sections}}};

/// A region to look at, and the plan for it if one was made.
struct Pending {
    std::int32_t region = 0;
    std::shared_ptr<PlannedCut>* plan = nullptr;
    int depth = 0;
    const Hints* hints = nullptr;
};

part::Plane bisecting(const mesh::TriMesh& mesh) {
    const Eigen::AlignedBox3d box = mesh::bounds(mesh);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    return {Eigen::Vector3d::Unit(axis), box.center()[axis]};
}

class Decomposer {
  public:
    Decomposer(const mesh::TriMesh& volume, const DecomposeOptions& options,
               const part::Judge& judge, Run& run)
        : options_(options),
          judge_(judge),
          run_(run),
          whole_{mesh::diagonal_mm(volume), mesh::volume_mm3(volume)} {}

    /// @param start  makes the complex to begin with for a nudge, as a share of the diagonal
    Result<Decomposition> decompose(const std::function<Result<Start>(double)>& start) {
        Result<Decomposition> result = fail("decompose.no_progress", "nothing was tried");
        for (const double nudge : kNudges) {
            Result<Start> begun = start(nudge);
            if (!begun) {
                return fail(begun.error());
            }
            result = attempt(*begun, nudge);
            if (result || result.error().code != "cut.rounding_intersects") {
                return result;
            }
            run_.info(
                "a part intersects itself after rounding; trying again with planes shifted by " +
                shortest(nudge) + " of the diagonal");
        }
        return result;
    }

  private:
    Result<Decomposition> attempt(Start& start, double nudge) {
        cut::Complex& complex = start.complex;
        finished_.clear();
        used_.clear();
        for (const auto& [region, hints] : start.hints) {
            for (const part::Plane& plane : hints.known) {
                used_.emplace_back(plane, plane);
            }
        }
        if (hints_ != start.hints.size()) {
            roots_.clear();  // plans of other regions than those of the attempt before
        }
        hints_ = start.hints.size();
        Status cut = cut_all(start, nudge * whole_.diagonal_mm);
        if (!cut) {
            return fail(cut.error());
        }
        const bool merge = options_.merge && !start.keeps_regions;
        const int merges = merge ? unite_neighbours(complex, finished_, judge_, run_) : 0;
        start.by.resize(complex.steps().size(), "united");
        if (run_.cancelled()) {
            return cancelled();
        }
        run_.progress("decompose", 0.9);
        return written(start, merges);
    }

    Status cut_all(Start& start, double step_mm) {
        cut::Complex& complex = start.complex;
        std::deque<Pending> pending;
        for (std::int32_t region = 0; region < complex.region_count(); ++region) {
            if (!complex.is_empty(region)) {
                const auto hints = start.hints.find(region);
                pending.push_back({region, &roots_[region], 0,
                                   hints == start.hints.end() ? nullptr : &hints->second});
            }
        }
        while (!pending.empty()) {
            if (run_.cancelled()) {
                return cancelled();
            }
            const Pending next = pending.front();
            pending.pop_front();
            Status looked = look_at(start, next, step_mm, pending);
            if (!looked) {
                return looked;
            }
            if (finished_.size() + pending.size() > static_cast<std::size_t>(options_.max_parts)) {
                return fail("decompose.too_many_parts",
                            "the machine is not content with " +
                                std::to_string(options_.max_parts) + " parts",
                            "",
                            "scale the model down, choose a machine with a larger chamber, or "
                            "allow more parts");
            }
            const auto done = static_cast<double>(finished_.size());
            run_.progress("decompose", 0.8 * done / (done + static_cast<double>(pending.size())));
        }
        return {};
    }

    Status look_at(Start& start, const Pending& next, double step_mm,
                   std::deque<Pending>& pending) {
        cut::Complex& complex = start.complex;
        part::Part part = complex.region(next.region);
        part::Verdict verdict = judge_(part, part::Fidelity::Exact);
        if (verdict.ok()) {
            finished_.push_back({next.region, std::move(part), std::move(verdict)});
            return {};
        }
        if (next.plan != nullptr && !*next.plan && next.depth < kPlannedDepth) {
            *next.plan = plan_cut(part, options_, judge_, whole_,
                                  next.hints != nullptr ? *next.hints : Hints{}, run_);
            if (run_.cancelled()) {
                return cancelled();
            }
        }
        PlannedCut bisection{bisecting(part.mesh), {}, 0};
        std::array<PlannedCut*, 2> choices{next.plan != nullptr ? next.plan->get() : nullptr,
                                           &bisection};
        std::optional<Error> refusal;
        for (PlannedCut* choice : choices) {
            if (choice == nullptr) {
                continue;
            }
            const Result<bool> divided = divide(complex, next, part, *choice, step_mm, pending);
            if (divided && *divided) {
                start.by.resize(complex.steps().size(),
                                choice == &bisection ? "bisected" : "too large");
                return {};
            }
            if (!divided) {
                refusal = divided.error();
            }
        }
        if (refusal) {
            return fail(*refusal);
        }
        return fail("decompose.no_progress",
                    "a part is too large for the machine and no plane divides it",
                    "region " + std::to_string(next.region),
                    "scale the model down, or choose a machine with a larger chamber");
    }

    /// Splits the region by the plane of the choice, nudged until one divides it; its pieces are
    /// pending then. False: none divides it. @error the last one of a split
    Result<bool> divide(cut::Complex& complex, const Pending& next, const part::Part& part,
                        PlannedCut& choice, double step_mm, std::deque<Pending>& pending) {
        std::optional<Error> refusal;
        const part::Plane aim = settled(part, choice, judge_, whole_, run_);
        for (int turn = 0; turn < kSplitTries; ++turn) {
            const part::Plane plane = turn == 0 ? used_or_nudged(aim, part.mesh, step_mm)
                                                : nudged(aim, part.mesh, step_mm, turn);
            Result<std::vector<std::int32_t>> regions = complex.split(next.region, plane);
            if (!regions) {
                refusal = regions.error();
                continue;
            }
            if (regions->size() < 2) {
                continue;
            }
            for (const std::int32_t region : *regions) {
                pending.push_back(
                    {region, plan_of(complex, region, plane, choice), next.depth + 1, next.hints});
            }
            return true;
        }
        if (refusal) {
            return fail(*refusal);
        }
        return false;
    }

    /// A plane that two regions share is nudged once, so that it stays one plane.
    part::Plane used_or_nudged(const part::Plane& aim, const mesh::TriMesh& mesh, double step_mm) {
        for (const auto& [planned, cut] : used_) {
            if (planned.normal == aim.normal &&
                std::abs(planned.offset_mm - aim.offset_mm) <= kSamePlane * whole_.diagonal_mm) {
                return cut;
            }
        }
        used_.emplace_back(aim, nudged(aim, mesh, step_mm));
        return used_.back().second;
    }

    /// The plan for a region that a planned cut gave: that of the planned piece most like it.
    std::shared_ptr<PlannedCut>* plan_of(const cut::Complex& complex, std::int32_t region,
                                         const part::Plane& plane, PlannedCut& planned) {
        const part::Part part = complex.region(region);
        const double volume = mesh::volume_mm3(part.mesh);
        const Eigen::Vector3d centre = mesh::bounds(part.mesh).center();
        double mean_height = 0;
        for (const Eigen::Vector3d& point : part.mesh.points) {
            mean_height += plane.normal.dot(point) - plane.offset_mm;
        }
        PlannedPiece* best = nullptr;
        double best_distance = 0;
        for (PlannedPiece& piece : planned.pieces) {
            const double distance = (piece.centre - centre).norm();
            const bool alike = piece.above == (mean_height > 0) &&
                               std::abs(piece.volume_mm3 - volume) < kSameVolume * volume &&
                               distance < kSameCentre * whole_.diagonal_mm;
            if (alike && (best == nullptr || distance < best_distance)) {
                best = &piece;
                best_distance = distance;
            }
        }
        if (best != nullptr) {
            return &best->next;
        }
        strays_.emplace_back();
        return &strays_.back();
    }

    Result<Decomposition> written(const Start& start, int merges) {
        const std::vector<std::int32_t> order =
            reading_order(start.complex, whole_.diagonal_mm, run_);
        Result<Decomposition> out = as_parts(start.complex, order, judge_, run_);
        if (!out) {
            return out;
        }
        for (std::size_t i = 0; i < out->verdicts.size(); ++i) {
            if (!out->verdicts[i].ok()) {
                return fail("decompose.no_progress", "a part is too large once it is rounded",
                            out->assembly.parts[i].id);
            }
        }
        out->tier = start.tier;
        out->boxes = start.facts;
        out->plan.steps = plan::steps_of(start.complex, start.by);
        for (const std::int32_t region : order) {
            out->regions.push_back(plan::region_name(region));
        }
        if (merges > 0) {
            out->notes.push_back(std::to_string(merges) + (merges == 1 ? " pair" : " pairs") +
                                 " of neighbours united after cutting");
        }
        run_.progress("decompose", 1);
        return out;
    }

    const DecomposeOptions& options_;
    const part::Judge& judge_;
    Run& run_;
    Whole whole_;
    std::vector<std::pair<part::Plane, part::Plane>> used_;      // as planned, as cut
    std::map<std::int32_t, std::shared_ptr<PlannedCut>> roots_;  // plans survive a second attempt
    std::size_t hints_ = 0;                                      // regions that had any
    std::deque<std::shared_ptr<PlannedCut>> strays_;  // plans of regions that no plan foresaw
    std::vector<Finished> finished_;
};

/// Parts, and what they cost besides: the weights are those of the search.
double cost_of(const Decomposition& found) {
    constexpr double kAreaWeight = 0.6;
    constexpr double kSupportWeight = 0.8;
    double volume = 0;
    double surface = 0;
    double interface = 0;
    double support = 0;
    for (const part::Part& part : found.assembly.parts) {
        volume += mesh::volume_mm3(part.mesh);
        surface += mesh::area_mm2(part.mesh);
    }
    for (const part::Interface& one : found.assembly.interfaces) {
        interface += one.area_mm2;
    }
    for (const part::Verdict& verdict : found.verdicts) {
        support += verdict.support_area_mm2;
    }
    return static_cast<double>(found.assembly.parts.size()) +
           kAreaWeight * interface / std::cbrt(volume * volume) +
           kSupportWeight * support / surface;
}

bool content_with_all(const cut::Complex& complex, const part::Judge& judge) {
    for (std::int32_t region = 0; region < complex.region_count(); ++region) {
        if (!judge(complex.region(region), part::Fidelity::Exact).ok()) {
            return false;
        }
    }
    return true;
}

}  // namespace

Result<Mode> mode_named(std::string_view name) {
    for (const auto& [known, mode] : kModes) {
        if (name == known) {
            return mode;
        }
    }
    return fail("decompose.mode", "there is no mode '" + std::string(name) + "'", "",
                "use sheets, paper or sections");
}

namespace {

/// Searched for, without plan and edits.
Result<Decomposition> automatic(const mesh::TriMesh& volume, const DecomposeOptions& options,
                                const part::Judge& judge, Run& run) {
    const Result<cut::Complex> complex = cut::Complex::from_volume(volume);
    if (!complex) {
        return fail(complex.error());
    }
    const auto by_sections = [&] {
        return Decomposer(volume, options, judge, run).decompose([&](double) -> Result<Start> {
            return Start(*complex);
        });
    };
    if (options.mode == Mode::Sections || !options.map ||
        (!options.keep_boxes && content_with_all(*complex, judge))) {
        return by_sections();
    }
    std::optional<BoxFacts> facts;
    Result<Decomposition> boxes =
        Decomposer(volume, options, judge, run).decompose([&](double nudge) {
            Result<Start> start = start_from_boxes(volume, options, nudge, run);
            if (start) {
                facts = start->facts;
            }
            return start;
        });
    if (!boxes && (boxes.error().code == "run.cancelled" || options.keep_boxes)) {
        return boxes;
    }
    if (boxes && options.keep_boxes) {
        return boxes;
    }
    Result<Decomposition> sections = by_sections();
    if (!sections) {
        return boxes ? std::move(boxes) : std::move(sections);
    }
    if (boxes && cost_of(*boxes) <= cost_of(*sections)) {
        return boxes;
    }
    sections->boxes = facts;
    if (sections->boxes) {
        sections->boxes->used = false;
    }
    sections->notes.push_back(
        boxes ? "cross-sections were used: " + std::to_string(sections->assembly.parts.size()) +
                    " parts and less interface and support, the polycube needs " +
                    std::to_string(boxes->assembly.parts.size())
              : "cross-sections were used: " + boxes.error().message);
    return sections;
}

plan::Origin origin_of(const Decomposition& found, const DecomposeOptions& options,
                       const Run& run) {
    plan::Origin out;
    for (const auto& [name, mode] : kModes) {
        out.mode = mode == options.mode ? name : out.mode;
    }
    out.sweep = options.global_sweep ? "global" : "local";
    out.boxes = options.keep_boxes;
    out.polycube = !options.map ? "none" : options.map->tier == "imported" ? "given" : "made";
    out.tier = found.tier;
    out.seed = run.seed;
    out.notes = found.notes;
    return out;
}

}  // namespace

Result<Decomposition> decompose(const mesh::TriMesh& volume, const DecomposeOptions& options,
                                const part::Judge& judge, Run& run) {
    run.progress("decompose", 0);
    if (options.plan) {
        return by_hand(volume, *options.plan, options, judge, run);
    }
    Result<Decomposition> out = automatic(volume, options, judge, run);
    if (!out) {
        return out;
    }
    out->plan.shape_sha256 = plan::shape_sha256(volume);
    out->plan.origin = origin_of(*out, options, run);
    if (options.edits.empty()) {
        return out;
    }
    Result<Decomposition> edited = by_hand(volume, out->plan, options, judge, run);
    if (edited) {
        edited->boxes = out->boxes;
    }
    return edited;
}

}  // namespace decomp::pipeline
