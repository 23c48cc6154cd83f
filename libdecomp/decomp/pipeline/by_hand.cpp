// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/pipeline/by_hand.h"

#include "decomp/base/nearest.h"
#include "decomp/base/number.h"
#include "decomp/cells/cells.h"
#include "decomp/mesh/measure.h"
#include "decomp/part/part_id.h"
#include "decomp/partition/extent.h"
#include "decomp/pipeline/finish.h"
#include "decomp/plan/workpiece.h"
#include "decomp/sheets/sheets.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace decomp::pipeline {

namespace {

constexpr std::array<double, 4> kNudges{3e-5, 5e-5, 7e-5, 1e-4};  // of the diagonal

std::string first_violation(const part::Verdict& verdict) {
    const part::Violation& violation = verdict.violations.front();
    return violation.constraint + " by " + decimal(violation.by_ratio, 3);
}

/// What all tries share.
struct Task {
    const DecomposeOptions& options;
    const part::Judge& judge;
    double diagonal_mm;
    bool in_polycube;                         ///< splits count along the axes of the polycube
    std::optional<cells::CellComplex> cells;  ///< where one of them does
};

/// One try to make the edits. Parts go by the names that they have before the edits; the pieces of
/// P03 are P03.1, P03.2 …, what P02 and others were merged into is P02.
class Hands {
  public:
    Hands(plan::Workpiece piece, const Task& task, std::size_t turn, const Run& run)
        : piece_(std::move(piece)), task_(task), turn_(turn) {
        const std::vector<std::int32_t> order =
            reading_order(piece_.complex(), task.diagonal_mm, run);
        for (std::size_t i = 0; i < order.size(); ++i) {
            parts_.emplace(part::part_id(i), piece_.name_of(order[i]));
        }
    }

    Status edit(const plan::Edit& edit) {
        switch (edit.kind) {
            case plan::Edit::Kind::Split:
                return split(edit);
            case plan::Edit::Kind::Merge:
                return merge(edit);
            case plan::Edit::Kind::Plane:
                return plane(edit);
        }
        return {};
    }

    [[nodiscard]] const plan::Workpiece& piece() const { return piece_; }

    [[nodiscard]] const std::vector<plan::Step>& steps() const { return steps_; }

    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  private:
    [[nodiscard]] Result<std::string> region_of(const std::string& part) const {
        const auto found = parts_.find(part);
        if (found != parts_.end()) {
            return found->second;
        }
        std::vector<std::string> names;
        std::string pieces;
        for (const auto& [name, region] : parts_) {
            names.push_back(name);
            if (name.starts_with(part + ".")) {
                pieces += (pieces.empty() ? "" : ", ") + name;
            }
        }
        return fail("plan.no_such_part", "there is no part '" + part + "'", "",
                    pieces.empty() ? did_you_mean(part, names) : "it was cut into " + pieces);
    }

    /// Cuts a part and names its pieces after it.
    Status cut(const std::string& part, const part::Plane& plane, const plan::Edit& edit) {
        plan::Step step;
        step.region = parts_.at(part);
        step.plane = plane;
        step.by = "hand: " + edit.text;
        const auto pieces = piece_.carry_out(step);
        if (!pieces) {
            return fail(pieces.error());
        }
        step.names = *pieces;
        steps_.push_back(step);
        parts_.erase(part);
        for (std::size_t i = 0; i < pieces->size(); ++i) {
            parts_.emplace(part + "." + std::to_string(i + 1), (*pieces)[i]);
        }
        if (pieces->size() > 2) {
            notes_.push_back(part + " fell into " + std::to_string(pieces->size()) + " parts");
        }
        return {};
    }

    Status split(const plan::Edit& edit) {
        const std::string& part = edit.parts.front();
        const Result<std::string> name = region_of(part);
        if (!name) {
            return fail(name.error());
        }
        const std::int32_t region = piece_.region(*name);
        const mesh::TriMesh mesh = piece_.complex().region(region).mesh;
        std::optional<part::Plane> aim;
        if (task_.in_polycube) {
            aim = across_box(mesh, edit);
        } else {
            const Eigen::AlignedBox3d box = mesh::bounds(mesh);
            aim = {Eigen::Vector3d::Unit(edit.axis),
                   box.min()[edit.axis] + edit.share * box.sizes()[edit.axis]};
        }
        if (!aim) {
            return fail("plan.cut_misses", "the polycube has nothing where '" + part + "' is", "",
                        "use --plane");
        }
        notes_.push_back("by hand: " + edit.text);
        const double step_mm = kNudges.at(turn_) * task_.diagonal_mm;
        return cut(part, piece_.complex().nudged_off_vertices(region, *aim, step_mm), edit);
    }

    [[nodiscard]] std::optional<part::Plane> across_box(const mesh::TriMesh& mesh,
                                                        const plan::Edit& edit) const {
        const auto extent = partition::extent_of(*task_.cells, mesh);
        if (!extent) {
            return std::nullopt;
        }
        const double low = extent->low[edit.axis];
        const double high = extent->high[edit.axis];
        return sheets::mapped_plane(*task_.cells, extent->cells, edit.axis,
                                    low + edit.share * (high - low));
    }

    /// Where planes of this normal meet something.
    [[nodiscard]] std::string reach_along(const Eigen::Vector3d& normal) const {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (const auto& [part, region] : parts_) {
            for (const auto& point : piece_.complex().region(piece_.region(region)).mesh.points) {
                low = std::min(low, normal.dot(point));
                high = std::max(high, normal.dot(point));
            }
        }
        return "along this normal the shape reaches from " + decimal(low, 3) + " to " +
               decimal(high, 3) + " mm";
    }

    /// Names of the parts with a face in common with a region, or "no part".
    [[nodiscard]] std::string neighbours_of(const std::string& region) const {
        std::string out;
        for (const auto& [part, other] : parts_) {
            if (other != region &&
                piece_.complex().touch(piece_.region(region), piece_.region(other))) {
                out += (out.empty() ? "" : ", ") + part;
            }
        }
        return out.empty() ? "no part" : out;
    }

    Status merge(const plan::Edit& edit) {
        plan::Step step;
        step.kind = plan::Step::Kind::Merge;
        step.by = "hand: " + edit.text;
        for (const std::string& part : edit.parts) {
            const Result<std::string> name = region_of(part);
            if (!name) {
                return fail(name.error());
            }
            step.region.empty() ? step.region = *name : step.names.emplace_back(*name);
        }
        const auto done = piece_.carry_out(step);
        if (!done) {
            Error error = done.error();
            if (error.code == "plan.not_neighbours") {
                error.message = "the parts of '" + edit.text + "' do not all touch";
                error.hint = edit.parts.front() + " touches " + neighbours_of(step.region);
            }
            return fail(std::move(error));
        }
        const part::Verdict verdict =
            task_.judge(piece_.complex().region(piece_.region(step.region)), part::Fidelity::Exact);
        if (!verdict.ok()) {
            return fail("plan.does_not_fit",
                        "merged, the parts exceed the machine: " + first_violation(verdict),
                        edit.text, "leave them apart, or choose a larger chamber");
        }
        for (std::size_t i = 1; i < edit.parts.size(); ++i) {
            parts_.erase(edit.parts[i]);
        }
        steps_.push_back(std::move(step));
        notes_.push_back("by hand: " + edit.text);
        return {};
    }

    Status plane(const plan::Edit& edit) {
        part::Plane plane = edit.plane;
        notes_.push_back("by hand: " + edit.text);
        if (turn_ > 0) {
            const double moved = kNudges.at(turn_) * task_.diagonal_mm;
            plane.offset_mm += moved;
            notes_.back() += ", moved by " + decimal(moved, 6) +
                             " mm: where it was, a part intersected itself after rounding";
        }
        std::vector<std::string> names;
        for (const auto& [part, region] : parts_) {
            names.push_back(part);
        }
        int divided = 0;
        for (const std::string& part : names) {
            Status done = cut(part, plane, edit);
            if (!done && done.error().code != "plan.cut_misses") {
                return done;
            }
            divided += done ? 1 : 0;
        }
        if (divided == 0) {
            return fail("plan.cut_misses", "the plane meets no part", edit.text,
                        reach_along(plane.normal));
        }
        return {};
    }

    plan::Workpiece piece_;
    const Task& task_;
    std::size_t turn_;
    std::map<std::string, std::string> parts_;  // their regions
    std::vector<plan::Step> steps_;
    std::vector<std::string> notes_;
};

Result<Decomposition> attempt(const plan::Workpiece& start, const plan::Plan& plan,
                              const Task& task, std::size_t turn, const Run& run) {
    Hands hands(start, task, turn, run);
    for (const plan::Edit& edit : task.options.edits) {
        if (Status done = hands.edit(edit); !done) {
            return fail(done.error());
        }
    }
    const cut::Complex& complex = hands.piece().complex();
    const std::vector<std::int32_t> order = reading_order(complex, task.diagonal_mm, run);
    Result<Decomposition> out = as_parts(complex, order, task.judge, run);
    if (!out) {
        return out;
    }
    out->tier = plan.origin.tier;
    out->plan = plan;
    out->plan.steps.insert(out->plan.steps.end(), hands.steps().begin(), hands.steps().end());
    std::vector<std::string>& notes = out->plan.origin.notes;
    notes.insert(notes.end(), hands.notes().begin(), hands.notes().end());
    out->notes = notes;
    for (const std::int32_t region : order) {
        out->regions.push_back(hands.piece().name_of(region));
    }
    return out;
}

Status all_fit(const Decomposition& found) {
    for (std::size_t i = 0; i < found.verdicts.size(); ++i) {
        if (!found.verdicts[i].ok()) {
            return fail("plan.does_not_fit",
                        "the part exceeds the machine: " + first_violation(found.verdicts[i]),
                        found.assembly.parts[i].id + ", region " + found.regions[i],
                        "cut it once more, by the plan or with --split, or choose a larger "
                        "chamber");
        }
    }
    return {};
}

}  // namespace

Result<Decomposition> by_hand(const mesh::TriMesh& volume, const plan::Plan& plan,
                              const DecomposeOptions& options, const part::Judge& judge, Run& run) {
    const Result<plan::Workpiece> start = plan::Workpiece::carried_out(volume, plan);
    if (!start) {
        return fail(start.error());
    }
    run.progress("decompose", 0.5);
    Task task{options, judge, mesh::diagonal_mm(volume), plan.origin.tier != "T4", std::nullopt};
    const auto is_split = [](const plan::Edit& edit) {
        return edit.kind == plan::Edit::Kind::Split;
    };
    const bool splits = std::any_of(options.edits.begin(), options.edits.end(), is_split);
    if (splits && task.in_polycube) {
        if (!options.map) {
            return fail("plan.no_polycube",
                        "the plan was made with a polycube, which a split by share needs", "",
                        "give it: --polycube SHAPE POLYCUBE; or use --plane");
        }
        auto cells = cells::cells_of(options.map->pair, options.map->lattice, {});
        if (!cells) {
            return fail(cells.error());
        }
        task.cells = std::move(*cells);
    }
    Result<Decomposition> out = fail("plan.cut_misses", "nothing was tried");
    for (std::size_t turn = 0; turn < kNudges.size(); ++turn) {
        out = attempt(*start, plan, task, turn, run);
        if (out || out.error().code != "cut.rounding_intersects" || options.edits.empty()) {
            break;
        }
    }
    if (!out) {
        return out;
    }
    if (Status fit = all_fit(*out); !fit) {
        return fail(fit.error());
    }
    run.progress("decompose", 1);
    return out;
}

}  // namespace decomp::pipeline
