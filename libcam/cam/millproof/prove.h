// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/read_mill.h"
#include "cam/tool/tool.h"
#include "decomp/base/result.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Geometry>

#include <string>
#include <string_view>
#include <vector>

/// The proof of a milling program from its own text. Shares no code with planners and posts: own
/// parser, own sweep of the tool, own stock.
namespace cam::millproof {

/// A tool and what it may be fed at.
struct ProofTool {
    tool::Tool tool;
    double max_mm_per_min = 0;  ///< 0: the machine's own limit alone
};

/// One set-up, in the frame of its program (mm).
struct MillJob {
    const decomp::mesh::TriMesh* part = nullptr;  ///< closed, in the set-up's frame
    Eigen::AlignedBox3d stock;
    double safe_z = 0;
    double floor_z = 0;                          ///< no tip goes below
    bool border_holds = false;                   ///< the stock is held at its border alone
    std::vector<Eigen::AlignedBox3d> keep_outs;  ///< clamps: nothing of tool or holder in them
    std::vector<Eigen::AlignedBox3d> keeps;      ///< material that is left on purpose
    std::vector<ProofTool> tools;
    profile::MillMachine machine;
    profile::MillDialect dialect;
    bool finished = true;  ///< false: the surface is not looked at for what was left
};

struct ProofOptions {
    double cell_mm = 0.2;        ///< of the stock's height map
    double sample_mm = 0.5;      ///< between points of the part's surface
    double max_gouge_mm = 0.02;  ///< along the normal
    double max_excess_mm = 0.1;  ///< along the normal, where the tools reach: 99.9 in 100 points
    /// Where the tools leave more than this at best is out of reach; ridges come on top, so that
    /// max_excess_mm must be larger by their height.
    double reach_mm = 0.05;
};

/// What is wrong, and where: lines are counted from 1; 0: the whole program.
struct Fault {
    std::string kind;  ///< "gouge", "rapid", "excess", ...: docs/formats.md lists them
    long line = 0;
    std::string what;
};

struct Figures {
    long lines = 0;
    double cut_mm = 0;
    double rapid_mm = 0;
    double seconds = 0;        ///< with acceleration, changes of tool left out
    double max_gouge_mm = 0;   ///< along the normal; what is below the tolerance is not measured
    double max_excess_mm = 0;  ///< along the normal, reachable surface
    double excess_999_mm = 0;  ///< 99.9th percentile by area
    double unreachable = 0;    ///< share of the upward area, from part and tools alone
    double left = 0;           ///< share of the upward area with more than the excess, cut
    long rapid_hits = 0;
    Eigen::AlignedBox3d reached;  ///< by the tip
};

/// Heights of the stock after the program, row by row from the stock's lower corner.
struct StockMap {
    Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower corner
    double cell_mm = 0;
    int columns = 0;
    int rows = 0;
    std::vector<float> height;  ///< mm
    std::vector<int> line;      ///< that cut last here; 0: none
};

struct MillProof {
    std::vector<Fault> faults;  ///< by line; at most 20 of a kind
    Figures figures;
    StockMap stock;

    [[nodiscard]] bool passed() const { return faults.empty(); }
};

/// Proves a program. Gouges and excess are exact at points of the surface `sample_mm` apart (the
/// tool's envelope along each line, by convex search); rapids, shank and holder are tried against
/// the stock's map. Cost: about a CPU-second for 3 m of finishing path over 100 x 100 mm at the
/// default cell.
/// @error millproof.job (no part, no tool, an empty stock, a map above 64 million cells)
[[nodiscard]] decomp::Result<MillProof> prove(std::string_view program, const MillJob& job,
                                              const ProofOptions& options);

}  // namespace cam::millproof
