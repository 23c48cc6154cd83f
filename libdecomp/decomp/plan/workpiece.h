// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/cut/complex.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/plan/plan.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace decomp::plan {

/// A volume that is being cut by a plan: a complex whose regions have names.
class Workpiece {
  public:
    /// Bodies are called r0, r1 …. @error those of cut::Complex
    [[nodiscard]] static Result<Workpiece> of(const mesh::TriMesh& volume);

    /// Does one step. After an error the workpiece is as before. Pieces of a cut beyond those that
    /// the step names are called after the region, "r3.2"; without any name the first keeps it.
    /// @error plan.no_such_region, plan.name_taken, plan.cut_misses, plan.not_neighbours, those of
    /// cut::Complex, each with the place of the step
    /// @return names of the regions that came out of it
    Result<std::vector<std::string>> carry_out(const Step& step);

    /// All steps of a plan that was made for `volume`. @error plan.other_shape, those of
    /// carry_out()
    [[nodiscard]] static Result<Workpiece> carried_out(const mesh::TriMesh& volume,
                                                       const Plan& plan);

    [[nodiscard]] const cut::Complex& complex() const { return complex_; }

    /// Id of a region that is there.
    [[nodiscard]] std::int32_t region(const std::string& name) const { return regions_.at(name); }

    /// Name of a region that is there.
    [[nodiscard]] const std::string& name_of(std::int32_t region) const;

  private:
    explicit Workpiece(cut::Complex complex);

    [[nodiscard]] Status known(const std::string& name, const Step& step) const;
    Result<std::vector<std::string>> cut(const Step& step);
    Result<std::vector<std::string>> merge(const Step& step);

    cut::Complex complex_;
    std::map<std::string, std::int32_t> regions_;  // those that are there
    std::map<std::string, std::string> gone_;      // what became of the others
};

}  // namespace decomp::plan
