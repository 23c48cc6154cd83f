// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/cut/complex.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/plane.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace decomp::plan {

/// Who made a plan, for its reader, and for cuts by hand that go on in its polycube.
struct Origin {
    std::string mode = "sections";  ///< sheets, paper, sections
    std::string sweep = "local";    ///< local, global
    bool boxes = false;             ///< every box of the polycube was kept
    std::string polycube = "none";  ///< none, made (from the model and the seed), given (as files)
    std::string tier = "T4";        ///< of the map behind the cuts; T4: there is none
    std::uint64_t seed = 1;
    std::vector<std::string> notes;

    bool operator==(const Origin&) const = default;
};

/// A cut or a merge.
struct Step {
    enum class Kind { Cut, Merge };
    Kind kind = Kind::Cut;
    std::string region;                     ///< that is cut; or the one into which the others go
    part::Plane plane;                      ///< of a cut: unit normal, mm, model frame
    std::vector<Eigen::Vector3d> loops_mm;  ///< the cut is limited to the pieces of the
                                            ///< cross-section nearest to these points; none: whole
    std::vector<std::string> names;  ///< of the pieces of a cut, below the plane first; or what is
                                     ///< merged into the region
    std::string by;                  ///< who decided so
    std::string where;               ///< file:line:column; empty: not from a file
};

struct Plan {
    std::string shape_sha256;  ///< of the volume that it cuts
    Origin origin;
    std::vector<Step> steps;
};

/// SHA-256 of points and triangles, as bits: what a plan was made for.
[[nodiscard]] std::string shape_sha256(const mesh::TriMesh& volume);

/// "r0"
[[nodiscard]] std::string region_name(std::int32_t region);

/// What was done to a complex as steps of a plan; merges into one region that follow each other are
/// one step.
/// @param by  who decided, for each step of the complex
[[nodiscard]] std::vector<Step> steps_of(const cut::Complex& complex,
                                         const std::vector<std::string>& by);

}  // namespace decomp::plan
