// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/labels/facets.h"
#include "decomp/labels/labeling.h"

#include <array>
#include <span>
#include <vector>

/// Inside the room: what a labelling costs.
namespace decomp::labels {

using LabelCosts = std::array<double, kLabelCount>;

/// Misfit of labels to normals plus compactness times the length of the boundaries (Livesu et al.
/// 2013, PolyCut), both measured against the area of the surface, so that the sum does not depend
/// on how finely it is meshed. The mean facet has area 1 and at most misfit 1.
class Energy {
  public:
    /// One unit normal for each facet; areas and lengths are those of the surface.
    Energy(const Facets& facets, std::span<const Eigen::Vector3d> normals, double compactness);

    /// The misfit of each label to a facet.
    [[nodiscard]] const LabelCosts& misfit(std::uint32_t facet) const { return misfit_[facet]; }

    /// The cost of a change of label across edge k of a facet.
    [[nodiscard]] double step(std::uint32_t facet, std::size_t k) const {
        return steps_[facet].at(k);
    }

    /// Percent of the area at full misfit that weigh as much. O(facets).
    [[nodiscard]] double of(const Labeling& labels) const;

    [[nodiscard]] const Facets& facets() const { return facets_; }

  private:
    const Facets& facets_;
    std::vector<LabelCosts> misfit_;
    std::vector<std::array<double, 3>> steps_;
};

/// The label nearest to each normal.
[[nodiscard]] Labeling nearest_labels(std::span<const Eigen::Vector3d> normals);

/// Each normal replaced by the area-weighted mean of itself and those of the three neighbours,
/// `passes` times.
[[nodiscard]] std::vector<Eigen::Vector3d> smoothed(const Facets& facets,
                                                    std::vector<Eigen::Vector3d> normals,
                                                    int passes);

/// Mean of the normals' components along their labels, by area: 1 on a polycube.
[[nodiscard]] double fidelity(const Facets& facets, const Labeling& labels);

}  // namespace decomp::labels
