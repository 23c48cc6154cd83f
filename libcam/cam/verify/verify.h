// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/read_profile.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"

#include <string>
#include <string_view>
#include <vector>

/// The proof: re-reads emitted text with a parser of its own, shares no code with slicing or
/// posting.
namespace cam::verify {

/// A part where the program is meant to make it: mesh already in the machine's coordinates (bed
/// frame, mm).
struct PlacedPart {
    std::string id;
    decomp::mesh::TriMesh mesh;
    std::vector<bool> mating = {};  ///< for each triangle: another part touches it; empty: none
};

/// How a program is looked at.
struct Options {
    /// Written by another slicer: unknown commands and forbidden words are notes, not faults.
    bool strangers_program = false;
    double pixel_mm = 0.1;  ///< of the rasters, 0.05 .. 0.2
};

/// One thing that is wrong, with the line of the program.
struct Fault {
    std::string code;  ///< stable dotted word, e.g. "proof.outside_chamber"
    long line = 0;     ///< 1-based; 0 when it belongs to no line
    int layer = -1;    ///< 0-based; -1 when it belongs to no layer
    std::string text;  ///< one sentence with the figure and the limit
};

/// The figures of one program, whether or not it passed.
struct Figures {
    long lines = 0;
    int layers = 0;
    double filament_mm = 0;
    double extruded_mm3 = 0;
    double max_flow_mm3_per_s = 0;
    double out_of_part_mm3 = 0;
    double out_of_part_percent = 0;     ///< of the extruded volume that belongs to the part
    double uncovered_skin_percent = 0;  ///< of the skin ring 0.1..0.35 mm inside the surface
    double worst_layer_uncovered_percent = 0;
    double solid_fill_ratio = 0;  ///< V / (A h) over solid layers; 0 when there are none
    int floating_islands = 0;
    double hanging_mm2 = 0;  ///< shelves over nothing that are no bridges, all layers
    int moves_below_printed = 0;
    int moves_outside_chamber = 0;
    double blob_mm3 = 0;      ///< extruded at a standstill, retractions made up for
    double declared_mm3 = 0;  ///< beads that the program calls support, skirt, brim or prime
    double air_percent = 0;   ///< of the part's bead area: over nothing and beyond the layer below
    double internal_bridge_percent =
        0;  ///< of the part's bead area: over nothing, inside the layer below
    int solid_layers = 0;
    double first_layer_mm2 = 0;       ///< of the parts' beads on the bed
    double first_layer_percent = 0;   ///< of the parts' lowest sections
    double support_contact_mm2 = 0;   ///< of the parts' beads over the gap above a support
    int round_holes = 0;              ///< upright ones, counted layer by layer
    double hole_error_mm = 0;         ///< of their diameters, mean; with the profile's growth
    double worst_hole_error_mm = 0;   ///< in one layer
    int outer_walls = 0;              ///< closed ones
    int mating_walls = 0;             ///< of them, along a face that touches another part
    double mating_seams_percent = 0;  ///< of these, begun on that face
};

/// The verdict on one program.
struct Proof {
    std::vector<Fault> faults;
    std::vector<std::string> notes;
    Figures figures;

    [[nodiscard]] bool passed() const { return faults.empty(); }
};

/// A program that a proof has passed; only check() makes one, and only it can be streamed.
class CheckedProgram {
  public:
    [[nodiscard]] const std::string& text() const { return text_; }

    [[nodiscard]] const std::string& hash() const { return hash_; }

    [[nodiscard]] const Proof& proof() const { return proof_; }

  private:
    friend decomp::Result<CheckedProgram> check(std::string_view, const std::vector<PlacedPart>&,
                                                const profile::FdmSetup&, const Options&,
                                                const decomp::Run&);
    std::string text_;
    std::string hash_;
    Proof proof_;
};

/// Replays a program and compares what it deposits with the parts. Faults are no error here: read
/// `passed()`. Faults are in the order of their lines and do not depend on run.jobs. Cost: see
/// README.md; memory 40 bytes a bead and the pixels of a few layers.
/// @error proof.unreadable (a line that is no G-code, with its number), proof.bad_part (a mesh that
/// is not finite or far from the chamber), run.cancelled
[[nodiscard]] decomp::Result<Proof> examine(std::string_view program,
                                            const std::vector<PlacedPart>& parts,
                                            const profile::FdmSetup& setup, const Options& options,
                                            const decomp::Run& run);

/// examine(), and the program as a value that can be streamed.
/// @error as examine(); proof.failed with one note per fault
[[nodiscard]] decomp::Result<CheckedProgram> check(std::string_view program,
                                                   const std::vector<PlacedPart>& parts,
                                                   const profile::FdmSetup& setup,
                                                   const Options& options, const decomp::Run& run);

}  // namespace cam::verify
