// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/tri_mesh.h"
#include "decomp/part/part.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace decomp::cut {

/// A connected piece of the cross-section of a region by a plane.
struct SectionPiece {
    double area_mm2 = 0;
    Eigen::Vector3d inside_mm = Eigen::Vector3d::Zero();  ///< a point of it, rounded
    std::int32_t below = -1;  ///< what lies on either side of it, counted as split() by the whole
    std::int32_t above = -1;  ///< plane would return the regions
};

/// One thing that was done to a complex.
struct Step {
    enum class Kind {
        Split,    ///< by the whole plane
        SplitAt,  ///< along some pieces of the cross-section
        Merge,
    };
    Kind kind = Kind::Split;
    std::int32_t region = -1;  ///< that was split; or into which the other was merged
    part::Plane plane;
    std::vector<Eigen::Vector3d> inside_mm;  ///< of each piece that was cut along
    std::vector<std::int32_t> others;        ///< what `region` became; or what was merged into it
};

/// A volume partitioned by planes: facets that know the region on either side, one shared vertex
/// table. Splitting adds regions, merging relabels them, caps are identical on both sides by
/// construction. Predicates are exact; a vertex stays implicit (input point, edge x plane, facet x
/// 2 planes, 3 planes) until it is written, so cost does not grow with the depth of cuts. A value:
/// copying is cheap enough to branch a search (O(facets)).
class Complex {
  public:
    Complex(const Complex&);
    Complex& operator=(const Complex&);
    Complex(Complex&&) noexcept;
    Complex& operator=(Complex&&) noexcept;
    ~Complex();

    /// One region per solid body (an outer shell with its voids).
    /// @error cut.not_a_volume  open, non-manifold, misoriented or self-intersecting where it was
    /// found out
    [[nodiscard]] static Result<Complex> from_volume(const mesh::TriMesh& volume);

    /// Regions are numbered 0 … region_count() - 1. Ids are never given twice: one that was merged
    /// away stays, empty.
    [[nodiscard]] std::int32_t region_count() const;

    /// Splits `region` by the whole plane; both sides are then taken apart into connected
    /// components, each a region of its own. Planes with equal coefficients are one plane object.
    /// Coplanar facets stay where they are; an empty side gives no region. On an error the complex
    /// is as before.
    /// @return ids of the regions that `region` became, below (normal . x < offset) before above;
    /// [region] if the plane misses it
    /// @error  cut.bad_plane  no normal, or a coefficient that is not finite
    /// @error  cut.crossing_constraints  the input intersects itself on the plane
    [[nodiscard]] Result<std::vector<std::int32_t>> split(std::int32_t region,
                                                          const part::Plane& plane);

    /// The cross-section of a region, piece by piece; empty where the plane misses it or takes
    /// nothing off. Costs a split and a copy of the complex.
    /// @error as split()
    [[nodiscard]] Result<std::vector<SectionPiece>> section(std::int32_t region,
                                                            const part::Plane& plane) const;

    /// As split(), but only along these pieces of section(): what the plane meets elsewhere stays
    /// whole and unmarked. Pieces that do not take the region apart, as one of the two of a ring,
    /// are left out.
    /// @return ids of the regions that `region` became, itself first; [region] if nothing is left
    /// to cut
    /// @error  cut.no_such_piece  section() has no piece of this number
    [[nodiscard]] Result<std::vector<std::int32_t>> split(std::int32_t region,
                                                          const part::Plane& plane,
                                                          const std::vector<std::int32_t>& pieces);

    /// The same for the pieces nearest to these points, by SectionPiece::inside_mm: what steps()
    /// recorded is found again, and a plane that was moved a little meets what it was meant for.
    [[nodiscard]] Result<std::vector<std::int32_t>> split_near(
        std::int32_t region, const part::Plane& plane,
        const std::vector<Eigen::Vector3d>& inside_mm);

    /// The plane, moved along its normal by 0, +-1 … +-4 steps: the nearest of these that no vertex
    /// of the region comes closer to than half a step, save those that lie on it exactly; or else
    /// the one that keeps farthest away. Rounded parts then rarely intersect themselves. @param
    /// step_mm  3e-5 of the model's diagonal serves well
    [[nodiscard]] part::Plane nudged_off_vertices(std::int32_t region, const part::Plane& plane,
                                                  double step_mm) const;

    /// Unites regions: every facet between them vanishes. `into` survives, `from` is empty
    /// afterwards.
    void merge(std::int32_t into, std::int32_t from);

    /// Every split that divided a region and every merge since from_volume(), in order. Done again
    /// on the same volume they give the same complex, ids and all.
    [[nodiscard]] const std::vector<Step>& steps() const;

    /// Whether a face lies between the two regions.
    [[nodiscard]] bool touch(std::int32_t a, std::int32_t b) const;

    /// The planes that have cut so far; the sources of region() and the planes that errors name
    /// count in them.
    [[nodiscard]] const std::vector<part::Plane>& planes() const;

    /// True for a region that was merged away.
    [[nodiscard]] bool is_empty(std::int32_t region) const;

    /// Volume of a region, mm^3, good to about 1e-13 of it. O(facets).
    [[nodiscard]] double volume_mm3(std::int32_t region) const;

    /// Volume of a region, mm^3, as a fraction in lowest terms. Long: the denominator grows with
    /// the cut edges.
    [[nodiscard]] std::string exact_volume_mm3(std::int32_t region) const;

    /// True when the region volumes sum to the input's volume exactly, as rationals.
    [[nodiscard]] bool volumes_sum_exactly() const;

    /// Closed surface of one region in double precision, with the source of each facet (neighbour =
    /// region id).
    [[nodiscard]] part::Part region(std::int32_t region) const;

    /// All regions that are not empty as parts "P01"…, in the given order of region ids,
    /// coordinates rounded once per vertex to the nearest double; checks closedness, manifoldness,
    /// orientation and self-intersection of every part after rounding to double and, for the mesh
    /// that an STL would carry, to float.
    /// @error cut.bad_order  a region is missing or listed twice
    /// @error cut.rounding_intersects  the rounded part intersects itself; shift the plane by a few
    /// 1e-5 of the diagonal
    [[nodiscard]] Result<part::Assembly> assemble(const std::vector<std::int32_t>& order,
                                                  const Run& run) const;

  private:
    struct State;

    /// Index of a plane in the table, added when it is new.
    [[nodiscard]] static Result<std::int32_t> add_plane(State& state, const part::Plane& plane);

    using Choose = std::function<std::vector<std::int32_t>(const std::vector<SectionPiece>&)>;
    [[nodiscard]] Result<std::vector<std::int32_t>> split_some(std::int32_t region,
                                                               const part::Plane& plane,
                                                               const Choose& choose);

    explicit Complex(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace decomp::cut
