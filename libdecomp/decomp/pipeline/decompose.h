// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/frame.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/judge.h"
#include "decomp/part/part.h"
#include "decomp/part/plane.h"
#include "decomp/plan/edit.h"
#include "decomp/plan/plan.h"
#include "decomp/tets/tet_mesh.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace decomp::pipeline {

/// Where the cuts come from.
enum class Mode {
    Sheets,  ///< the sheets between the boxes of a polycube; sections where the map is bad or they
             ///< need fewer parts
    Paper,   ///< as the paper: boxes with flattened sides, one plane for each side
    Sections,  ///< events of the cross-sections alone
};

/// "sheets", "paper" or "sections". @error decompose.mode
[[nodiscard]] Result<Mode> mode_named(std::string_view name);

/// The polycube of a shape and where it comes from.
struct PolycubeMap {
    tets::Pair pair;          ///< shape in the model frame
    tets::Lattice lattice;    ///< in polycube space
    std::string tier = "T2";  ///< what the map is worth: T1 valid, T2 with flips, T3 invalid labels
};

/// Every budget is counted, never timed, so that results do not depend on the speed of a machine.
struct DecomposeOptions {
    int max_parts = 200;         ///< more than these is an error
    int proxy_triangles = 5000;  ///< planes are searched on a simplified surface of this size
    int offsets = 11;   ///< evenly spaced planes tried along each direction, besides the events
    int lookahead = 4;  ///< best first cuts that are followed to the end
    double thin_share =
        0.015;  ///< of the diagonal: volume / interface below it is a tongue, taken only in need
    bool merge = true;  ///< unite neighbours afterwards where the judge allows
    Mode mode = Mode::Sheets;
    bool global_sweep = false;  ///< planes sweep through the whole polycube, not one face of it
    bool keep_boxes = false;    ///< every box of the polycube stays a part, also where the judge
                                ///< would take several as one
    std::shared_ptr<const PolycubeMap> map;  ///< null: the cuts come from the cross-sections
    double most_mislabeled = 0.1;            ///< share of the map's votes; a worse map is not used
    std::shared_ptr<const plan::Plan> plan;  ///< carried out instead of searching; else null
    std::vector<plan::Edit> edits;           ///< made afterwards, in this order
};

/// A plane that the polycube proposed, and how far the sheets mapped to it lie from it.
struct SheetFacts {
    part::Plane plane;
    int axis = 0;   ///< of polycube space
    int level = 0;  ///< index of the lattice plane along it
    bool snapped = false;
    double area_mm2 = 0;
    double rms_mm = 0;
    double max_mm = 0;
    std::vector<Eigen::Vector3d> corners;  ///< paper mode: the four back-mapped corners of the side
};

/// What the polycube gave.
struct BoxFacts {
    int boxes = 0;
    int parts = 0;  ///< before the judge was asked
    int cuts = 0;
    int limited_cuts = 0;
    int shifted_cuts = 0;
    int skipped_tongues = 0;
    int healed = 0;
    double healed_share = 0;
    double mislabeled_share = 0;
    double flipped_share = 0;
    bool used = false;  ///< false: the cuts come from the cross-sections, see the notes
    std::vector<SheetFacts> sheets;
};

struct Decomposition {
    part::Assembly assembly;
    std::vector<Pose<PartBedFrame, ModelFrame>>
        poses;                            ///< one for each part: the one in which it was judged
    std::vector<part::Verdict> verdicts;  ///< one for each part; all ok
    std::vector<double> necks_mm;    ///< of the interfaces: the largest circle within the thinnest
                                     ///< piece of each
    std::string tier;                ///< of the map; "T4": planes at cross-section events
    int cuts = 0;                    ///< planes used
    std::optional<BoxFacts> boxes;   ///< when there was a polycube
    std::vector<std::string> notes;  ///< what a reader of the report should know
    plan::Plan plan;  ///< carried out on the same volume it gives the same assembly, bit for bit
    std::vector<std::string> regions;  ///< of the plan, one for each part
};

/// Cuts a volume until the judge is content with every part, then unites neighbours where it stays
/// content. With a polycube its boxes are the parts to begin with; the outcome is compared with
/// that of the cross-sections, and the one with fewer parts is taken (or the one with less
/// interface and support), unless the boxes are to be kept. A volume that already is fine comes
/// back as one part for each of its bodies. Works for every closed volume; the parts are an exact
/// partition. With a plan nothing is searched: it is carried out as it is. Edits by hand follow;
/// the judge must be content with what they leave.
/// @param volume  closed, manifold, outward, free of self-intersection (see repair)
/// @param judge   must become content with small enough pieces
/// @error decompose.too_many_parts  the judge was not content with max_parts parts
/// @error decompose.no_progress     a region cannot be cut any further
/// @error any error of cut::Complex, of by_hand()
[[nodiscard]] Result<Decomposition> decompose(const mesh::TriMesh& volume,
                                              const DecomposeOptions& options,
                                              const part::Judge& judge, Run& run);

}  // namespace decomp::pipeline
