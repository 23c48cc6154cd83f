// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/judge_levels.h"

#include "cam/verify/limits.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>

namespace cam::verify {
namespace {

using decomp::decimal;

/// Faults of consecutive layers told as one.
struct Streak {
    const char* code = "";
    long line = 0;
    int first = -1;
    int last = -1;
    double worst = 0;
    double worst_share = 0;

    void add(int layer, long at, double figure, double share) {
        if (first < 0) {
            first = layer;
            line = at;
        }
        last = layer;
        if (figure > worst) {
            worst = figure;
            worst_share = share;
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

}  // namespace

void judge_levels(const Scene& scene, const std::vector<LevelReport>& reports, FaultList& faults,
                  Proof& proof) {
    Streak skin;
    Streak outside;
    Streak over;
    Streak under;
    Figures& figures = proof.figures;
    double ring = 0;
    double uncovered = 0;
    double part = 0;
    double air = 0;
    double internal = 0;
    double bead_area = 0;
    double solid_volume = 0;
    double solid_room = 0;
    Details totals;
    double worst_outside = 0;
    long worst_line = 0;
    int worst_layer = -1;
    for (std::size_t k = 0; k < reports.size(); ++k) {
        const Level& level = scene.levels->levels[k];
        const LevelReport& report = reports[k];
        if (report.islands > 0) {
            figures.floating_islands += report.islands;
            faults.add({"proof.floating_island",
                        report.island_line != 0 ? report.island_line : level.first_line,
                        level.layer >= 0 ? level.layer : scene.levels->layer_at(level.z),
                        std::to_string(report.islands) + " island(s) of " +
                            decimal(report.island_mm2, 2) + " mm^2 at z " + decimal(level.z, 3) +
                            " mm rest on nothing, 0 are allowed"});
        }
        if (level.layer < 0) {
            continue;
        }
        if (report.hanging_mm2 >= limits::kHangingMm2) {
            figures.hanging_mm2 += report.hanging_mm2;
            faults.add({"proof.unsupported", report.hanging_line, level.layer,
                        decimal(report.hanging_mm2, 1) + " mm^2 of layer " +
                            std::to_string(level.layer) + " hang further than " +
                            decimal(limits::kHangingMm, 1) +
                            " mm from anything that carries them, " +
                            decimal(limits::kHangingMm2, 1) + " mm^2 are allowed"});
        }
        ++figures.layers;
        add_details(report, totals);
        judge_details(level, report, scene, faults);
        ring += report.ring_mm2;
        uncovered += report.uncovered_mm2;
        part += report.part_mm3;
        air += report.air_mm2;
        internal += report.internal_mm2;
        bead_area += report.bead_mm2;
        figures.out_of_part_mm3 += report.outside_mm3;
        if (report.outside_mm3 > worst_outside) {
            worst_outside = report.outside_mm3;
            worst_line = report.outside_line != 0 ? report.outside_line : level.first_line;
            worst_layer = level.layer;
        }
        const double share = report.ring_mm2 > 0 ? report.uncovered_mm2 / report.ring_mm2 : 0;
        figures.worst_layer_uncovered_percent =
            std::max(figures.worst_layer_uncovered_percent, 100 * share);
        if (report.uncovered_mm2 > limits::kSkinMm2 && share > limits::kSkinShare) {
            skin.add(level.layer, level.first_line, report.uncovered_mm2, share);
        } else {
            tell_skin(skin, faults);
        }
        if (report.outside_mm3 > limits::kOutsideLayerMm3) {
            outside.add(level.layer,
                        report.outside_line != 0 ? report.outside_line : level.first_line,
                        report.outside_mm3, 0);
        } else {
            tell_outside(outside, faults);
        }
        if (report.fill > 0) {
            ++figures.solid_layers;
            solid_volume += report.part_mm3;
            solid_room += report.part_mm3 / report.fill;
        }
        if (report.fill > limits::kFillHigh) {
            over.add(level.layer, level.first_line, report.fill - 1, report.fill);
        } else {
            tell_fill(over, faults, true);
        }
        if (report.fill > 0 && report.fill < limits::kFillLow) {
            under.add(level.layer, level.first_line, 1 - report.fill, report.fill);
        } else {
            tell_fill(under, faults, false);
        }
    }
    tell_skin(skin, faults);
    tell_outside(outside, faults);
    tell_fill(over, faults, true);
    tell_fill(under, faults, false);
    tell_details(totals, figures);
    figures.uncovered_skin_percent = ring > 0 ? 100 * uncovered / ring : 0;
    figures.out_of_part_percent = part > 0 ? 100 * figures.out_of_part_mm3 / part : 0;
    figures.solid_fill_ratio = solid_room > 0 ? solid_volume / solid_room : 0;
    figures.air_percent = bead_area > 0 ? 100 * air / bead_area : 0;
    figures.internal_bridge_percent = bead_area > 0 ? 100 * internal / bead_area : 0;
    // A little on every layer adds up.
    if (worst_outside < limits::kOutsideLayerMm3 &&
        figures.out_of_part_mm3 > limits::kOutsideShare * part && figures.out_of_part_mm3 > 1) {
        faults.add({"proof.outside_part", worst_line, worst_layer,
                    decimal(figures.out_of_part_mm3, 2) + " mm^3 (" +
                        decimal(figures.out_of_part_percent, 4) +
                        " %) of the program's material lies outside the parts, " +
                        decimal(100 * limits::kOutsideShare, 4) + " % is allowed"});
    }
}

void judge_missing_layers(const Scene& scene, const std::vector<LevelReport>& reports,
                          const std::vector<Climb>& climbs,
                          const std::vector<std::string>& part_ids, FaultList& faults) {
    const auto climb_between = [&](double low, double high, long otherwise) {
        for (const Climb& climb : climbs) {
            if (climb.z > low + 0.011 && climb.z < high - 0.011 && climb.line < otherwise) {
                return static_cast<long>(climb.line);
            }
        }
        return otherwise;
    };
    // Something to print: the part of the section that a bead can reach.
    const auto printable = [&](const Slicer& slicer, double z) {
        const Section section = slicer.at(z);
        if (section.bounds.isEmpty()) {
            return false;
        }
        const auto pixel = [&](double at) {
            return static_cast<int>(std::floor(at / scene.pixel_mm));
        };
        const Eigen::AlignedBox2d& box = section.bounds;
        Bitmap inside(Window::around(pixel(box.min().x()), pixel(box.min().y()),
                                     pixel(box.max().x()), pixel(box.max().y())));
        Bitmap rim(inside.window());
        fill_section(section, scene.pixel_mm, inside);
        draw_outline(section, 0.2, scene.pixel_mm, rim);
        std::size_t pixels = 0;
        for (std::size_t w = 0; w < rim.words().size(); ++w) {
            pixels += static_cast<std::size_t>(std::popcount(inside.words()[w] & ~rim.words()[w]));
        }
        return static_cast<double>(pixels) * scene.pixel_mm * scene.pixel_mm >=
               limits::kPrintableMm2;
    };
    for (std::size_t p = 0; p < scene.slicers->size(); ++p) {
        const Slicer& slicer = (*scene.slicers)[p];
        if (slicer.bounds().isEmpty()) {
            continue;
        }
        double below = slicer.bounds().min().z();
        double height = 0;
        long last_line = 0;
        int layer = -1;
        const auto missing = [&](double from, double to, long line, int at) {
            faults.add({"proof.missing_layer", line, at,
                        "part " + part_ids[p] + " has no material between z " + decimal(from, 3) +
                            " and " + decimal(to, 3) + " mm, its layers are " + decimal(height, 3) +
                            " mm high"});
        };
        for (std::size_t k = 0; k < reports.size(); ++k) {
            if (reports[k].parts.empty() || reports[k].parts[p].covered_share < limits::kPresence) {
                continue;
            }
            const Level& level = scene.levels->levels[k];
            const double step = level.z - below;
            const double usual = height > 0 ? height : reports[k].height_mm;
            if (step > limits::kMissingLayers * usual) {
                const double middle =
                    height > 0 ? below + height / 2 : (below + level.z - usual) / 2;
                height = usual;
                if (printable(slicer, middle)) {
                    missing(below, level.z - usual, climb_between(below, level.z, level.first_line),
                            layer + 1);
                }
            }
            height = std::min(reports[k].height_mm, step > 0 ? step : reports[k].height_mm);
            below = level.z;
            layer = level.layer;
            last_line = level.first_line;
        }
        const double top = slicer.bounds().max().z();
        if (layer < 0) {
            if (printable(slicer, (below + top) / 2)) {
                faults.add({"proof.missing_part", 0, -1,
                            "part " + part_ids[p] + " is not made by this program"});
            }
        } else if (top - below > (limits::kMissingLayers - 0.5) * height &&
                   printable(slicer, below + height / 2)) {
            missing(below, top, climb_between(below, 1e9, last_line), layer + 1);
        }
    }
}

}  // namespace cam::verify
