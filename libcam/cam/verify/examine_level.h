// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"
#include "cam/verify/levels.h"
#include "cam/verify/seams.h"
#include "cam/verify/slicer.h"

#include <Eigen/Core>

#include <vector>

namespace cam::verify {

/// What all levels look at.
struct Scene {
    const std::vector<Bead>* beads = nullptr;
    const Levels* levels = nullptr;
    const std::vector<Slicer>* slicers = nullptr;  ///< one a part
    const std::vector<Slicer>* mating = nullptr;   ///< faces that touch another part, one a part
    const profile::FdmMachine::Process* process = nullptr;  ///< what is meant to differ
    double pixel_mm = 0.1;
};

/// One part on one level.
struct PartLevel {
    double section_mm2 = 0;
    double covered_share = 0;
};

/// What one level shows.
struct LevelReport {
    double height_mm = 0;  ///< of its beads of parts, from what is beneath them
    double part_mm3 = 0;   ///< undeclared material
    double ring_mm2 = 0;
    double uncovered_mm2 = 0;
    double outside_mm3 = 0;
    long outside_line = 0;
    double section_mm2 = 0;
    double fill = 0;  ///< V / (A h) where the section is covered, else 0
    int islands = 0;
    long island_line = 0;
    double island_mm2 = 0;
    double hanging_mm2 = 0;  ///< further than 3 mm from anything that carries, and no bridge
    long hanging_line = 0;
    double air_mm2 = 0;       ///< beads over nothing, outside the section of the layer below
    double internal_mm2 = 0;  ///< beads over nothing, inside it: infill bridges
    double bead_mm2 = 0;
    double support_contact_mm2 = 0;
    bool first = false;  ///< lowest layer of parts
    int holes = 0;
    double hole_error_mm = 0;  ///< sum
    double worst_hole_mm = 0;  ///< signed
    Eigen::Vector2d worst_hole_at = Eigen::Vector2d::Zero();
    SeamCount seams;
    std::vector<PartLevel> parts;
};

/// Compares one level with the parts. `below` holds the rough deposits of the levels before this
/// one; those further than 1.2 mm down may be empty. O(pixels of the level).
[[nodiscard]] LevelReport examine_level(const Scene& scene, std::size_t level,
                                        const std::vector<Bitmap>& below);

}  // namespace cam::verify
