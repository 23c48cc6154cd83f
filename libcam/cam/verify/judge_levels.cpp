// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/judge_levels.h"

#include "cam/verify/limits.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>

namespace cam::verify {
namespace {

using decomp::decimal;

/// A layer with a fault.
struct Lapse {
    int layer = -1;
    long line = 0;
    double figure = 0;
    double share = 0;
};

/// Faults of consecutive layers told as one.
struct Streak {
    const char* code = "";
    long line = 0;
    int first = -1;
    int last = -1;
    double worst = 0;
    double worst_share = 0;

    void add(const Lapse& lapse) {
        if (first < 0) {
            first = lapse.layer;
            line = lapse.line;
        }
        last = lapse.layer;
        if (lapse.figure > worst) {
            worst = lapse.figure;
            worst_share = lapse.share;
        }
    }

    [[nodiscard]] std::string layers() const {
        return first == last ? "layer " + std::to_string(first)
                             : "layers " + std::to_string(first) + " to " + std::to_string(last);
    }
};

void tell_skin(Streak& streak, FaultList& faults) {
    if (streak.first >= 0) {
        faults.add({"proof.uncovered_skin", streak.line, streak.first,
                    streak.layers() + ": up to " + decimal(streak.worst, 2) + " mm^2 (" +
                        decimal(100 * streak.worst_share, 2) +
                        " %) of the skin ring is not covered, " + decimal(limits::kSkinMm2, 2) +
                        " mm^2 is allowed"});
    }
    streak = Streak{};
}

void tell_outside(Streak& streak, FaultList& faults) {
    if (streak.first >= 0) {
        faults.add({"proof.outside_part", streak.line, streak.first,
                    streak.layers() + ": up to " + decimal(streak.worst, 2) +
                        " mm^3 lies more than " + decimal(limits::kOutsideMm, 2) +
                        " mm outside the part, " + decimal(limits::kOutsideLayerMm3, 2) +
                        " mm^3 is allowed"});
    }
    streak = Streak{};
}

void tell_fill(Streak& streak, FaultList& faults, bool over) {
    if (streak.first >= 0) {
        faults.add({over ? "proof.overfilled" : "proof.underfilled", streak.line, streak.first,
                    streak.layers() + ": a solid layer holds " + decimal(streak.worst_share, 3) +
                        " of its volume, the limit is " +
                        decimal(over ? limits::kFillHigh : limits::kFillLow, 3)});
    }
    streak = Streak{};
}

/// What all levels together say of feet, holes and seams.
struct Details {
    double contact_mm2 = 0;
    double foot_mm2 = 0;
    double foot_section_mm2 = 0;
    double support_mm2 = 0;
    int holes = 0;
    double hole_error_mm = 0;
    double worst_hole_mm = 0;
    SeamCount seams;
};

void add_details(const LevelReport& report, Details& totals) {
    if (report.first) {
        totals.contact_mm2 += report.bead_mm2;
        for (const PartLevel& part : report.parts) {
            totals.foot_mm2 += part.covered_share * part.section_mm2;
            totals.foot_section_mm2 += part.section_mm2;
        }
    }
    totals.support_mm2 += report.support_contact_mm2;
    totals.holes += report.holes;
    totals.hole_error_mm += report.hole_error_mm;
    if (std::abs(report.worst_hole_mm) > std::abs(totals.worst_hole_mm)) {
        totals.worst_hole_mm = report.worst_hole_mm;
    }
    totals.seams.loops += report.seams.loops;
    totals.seams.touching += report.seams.touching;
    totals.seams.on_face += report.seams.on_face;
}

void judge_details(const Level& level, const LevelReport& report, const Scene& scene,
                   FaultList& faults) {
    if (std::abs(report.worst_hole_mm) > limits::kHoleMm) {
        faults.add({"proof.hole_diameter", level.first_line, level.layer,
                    "the round hole at X " + decimal(report.worst_hole_at.x(), 1) + " Y " +
                        decimal(report.worst_hole_at.y(), 1) + " is " +
                        decimal(std::abs(report.worst_hole_mm), 2) + " mm too " +
                        (report.worst_hole_mm > 0 ? "wide" : "narrow") + ", " +
                        decimal(limits::kHoleMm, 2) + " mm is allowed"});
    }
    if (!report.first || scene.process->bottom_layers == 0) {
        return;
    }
    double covered = 0;
    double section = 0;
    for (const PartLevel& part : report.parts) {
        covered += part.covered_share * part.section_mm2;
        section += part.section_mm2;
    }
    if (section >= limits::kLeastSolidMm2 && covered < limits::kFirstLayerShare * section) {
        faults.add({"proof.first_layer", level.first_line, level.layer,
                    "only " + decimal(100 * covered / section, 1) +
                        " % of the parts' feet touch the bed, " +
                        decimal(100 * limits::kFirstLayerShare, 0) + " % must"});
    }
}

void tell_details(const Details& totals, Figures& figures) {
    figures.first_layer_mm2 = totals.contact_mm2;
    figures.first_layer_percent =
        totals.foot_section_mm2 > 0 ? 100 * totals.foot_mm2 / totals.foot_section_mm2 : 0;
    figures.support_contact_mm2 = totals.support_mm2;
    figures.round_holes = totals.holes;
    figures.hole_error_mm = totals.holes > 0 ? totals.hole_error_mm / totals.holes : 0;
    figures.worst_hole_error_mm = totals.worst_hole_mm;
    figures.outer_walls = totals.seams.loops;
    figures.mating_walls = totals.seams.touching;
    figures.mating_seams_percent =
        totals.seams.touching > 0 ? 100.0 * totals.seams.on_face / totals.seams.touching : 0;
}

void judge_islands(const Level& level, const LevelReport& report, const Scene& scene,
                   FaultList& faults) {
    if (report.islands > 0) {
        faults.add({"proof.floating_island",
                    report.island_line != 0 ? report.island_line : level.first_line,
                    level.layer >= 0 ? level.layer : scene.levels->layer_at(level.z),
                    std::to_string(report.islands) + " island(s) of " +
                        decimal(report.island_mm2, 2) + " mm^2 at z " + decimal(level.z, 3) +
                        " mm rest on nothing, 0 are allowed"});
    }
}

void judge_hanging(const Level& level, const LevelReport& report, Figures& figures,
                   FaultList& faults) {
    if (report.hanging_mm2 >= limits::kHangingMm2) {
        figures.hanging_mm2 += report.hanging_mm2;
        faults.add({"proof.unsupported", report.hanging_line, level.layer,
                    decimal(report.hanging_mm2, 1) + " mm^2 of layer " +
                        std::to_string(level.layer) + " hang further than " +
                        decimal(limits::kHangingMm, 1) + " mm from anything that carries them, " +
                        decimal(limits::kHangingMm2, 1) + " mm^2 are allowed"});
    }
}

/// Skin, outside and fill, whose faults are told by streaks of layers.
class Streaks {
  public:
    void judge(const Level& level, const LevelReport& report, FaultList& faults) {
        const double share = report.ring_mm2 > 0 ? report.uncovered_mm2 / report.ring_mm2 : 0;
        if (report.uncovered_mm2 > limits::kSkinMm2 && share > limits::kSkinShare) {
            skin_.add({level.layer, level.first_line, report.uncovered_mm2, share});
        } else {
            tell_skin(skin_, faults);
        }
        if (report.outside_mm3 > limits::kOutsideLayerMm3) {
            outside_.add({level.layer,
                          report.outside_line != 0 ? report.outside_line : level.first_line,
                          report.outside_mm3, 0});
        } else {
            tell_outside(outside_, faults);
        }
        if (report.fill > limits::kFillHigh) {
            over_.add({level.layer, level.first_line, report.fill - 1, report.fill});
        } else {
            tell_fill(over_, faults, true);
        }
        if (report.fill > 0 && report.fill < limits::kFillLow) {
            under_.add({level.layer, level.first_line, 1 - report.fill, report.fill});
        } else {
            tell_fill(under_, faults, false);
        }
    }

    void tell(FaultList& faults) {
        tell_skin(skin_, faults);
        tell_outside(outside_, faults);
        tell_fill(over_, faults, true);
        tell_fill(under_, faults, false);
    }

  private:
    Streak skin_;
    Streak outside_;
    Streak over_;
    Streak under_;
};

/// Sums over all layers.
struct Sums {
    double ring = 0;
    double uncovered = 0;
    double part = 0;
    double air = 0;
    double internal = 0;
    double bead_area = 0;
    double solid_volume = 0;
    double solid_room = 0;
    Lapse outside;  ///< the worst
};

void add_sums(const Level& level, const LevelReport& report, Sums& sums, Figures& figures) {
    ++figures.layers;
    sums.ring += report.ring_mm2;
    sums.uncovered += report.uncovered_mm2;
    sums.part += report.part_mm3;
    sums.air += report.air_mm2;
    sums.internal += report.internal_mm2;
    sums.bead_area += report.bead_mm2;
    figures.out_of_part_mm3 += report.outside_mm3;
    if (report.outside_mm3 > sums.outside.figure) {
        sums.outside = {level.layer,
                        report.outside_line != 0 ? report.outside_line : level.first_line,
                        report.outside_mm3, 0};
    }
    const double share = report.ring_mm2 > 0 ? report.uncovered_mm2 / report.ring_mm2 : 0;
    figures.worst_layer_uncovered_percent =
        std::max(figures.worst_layer_uncovered_percent, 100 * share);
    if (report.fill > 0) {
        ++figures.solid_layers;
        sums.solid_volume += report.part_mm3;
        sums.solid_room += report.part_mm3 / report.fill;
    }
}

void tell_sums(const Sums& sums, Figures& figures) {
    figures.uncovered_skin_percent = sums.ring > 0 ? 100 * sums.uncovered / sums.ring : 0;
    figures.out_of_part_percent = sums.part > 0 ? 100 * figures.out_of_part_mm3 / sums.part : 0;
    figures.solid_fill_ratio = sums.solid_room > 0 ? sums.solid_volume / sums.solid_room : 0;
    figures.air_percent = sums.bead_area > 0 ? 100 * sums.air / sums.bead_area : 0;
    figures.internal_bridge_percent = sums.bead_area > 0 ? 100 * sums.internal / sums.bead_area : 0;
}

/// A little on every layer adds up.
void judge_outside(const Sums& sums, const Figures& figures, FaultList& faults) {
    if (sums.outside.figure < limits::kOutsideLayerMm3 &&
        figures.out_of_part_mm3 > limits::kOutsideShare * sums.part &&
        figures.out_of_part_mm3 > 1) {
        faults.add({"proof.outside_part", sums.outside.line, sums.outside.layer,
                    decimal(figures.out_of_part_mm3, 2) + " mm^3 (" +
                        decimal(figures.out_of_part_percent, 4) +
                        " %) of the program's material lies outside the parts, " +
                        decimal(100 * limits::kOutsideShare, 4) + " % is allowed"});
    }
}

}  // namespace

void judge_levels(const Scene& scene, const std::vector<LevelReport>& reports, FaultList& faults,
                  Proof& proof) {
    Figures& figures = proof.figures;
    Streaks streaks;
    Details totals;
    Sums sums;
    for (std::size_t k = 0; k < reports.size(); ++k) {
        const Level& level = scene.levels->levels[k];
        const LevelReport& report = reports[k];
        figures.floating_islands += report.islands;
        judge_islands(level, report, scene, faults);
        if (level.layer < 0) {
            continue;
        }
        judge_hanging(level, report, figures, faults);
        add_details(report, totals);
        judge_details(level, report, scene, faults);
        add_sums(level, report, sums, figures);
        streaks.judge(level, report, faults);
    }
    streaks.tell(faults);
    tell_details(totals, figures);
    tell_sums(sums, figures);
    judge_outside(sums, figures, faults);
}

}  // namespace cam::verify
