// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"
#include "decomp/mesh/facets.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace cam::visibility {

/// Directions that a mask of seen_masks() can hold.
inline constexpr std::size_t kMostDirections = 64;

/// Facets this far from facing a direction (cosine) still count as walls along it.
inline constexpr double kWallCosine = 1e-6;

/// What a facet must do to be asked at all.
enum class Facing {
    Front,  ///< normal . direction > 0, as the paper has it
    Wall    ///< or a wall: normal . direction >= -kWallCosine
};

/// Whose rays: the usual ones, or a second opinion that must differ nowhere but in rounding.
struct RayStart {
    double lift = 1e-5;     ///< of the mesh's diagonal: rays start so far above their facet
    bool skip_own = false;  ///< hits on the facet itself do not count
};

/// How much work goes into the tree that rays walk. Both give the same answers.
enum class Tree {
    Fine,  ///< for many rays a facet: three times as long to build, walked a tenth faster
    Quick  ///< for about one ray a facet
};

/// A closed, outward oriented mesh made ready for rays (Embree, float32, centred and scaled): which
/// facets see which directions. A facet sees a direction when it faces it and a ray from its
/// barycentre that way meets nothing; a direction points from the part to the tool.
///
/// Yes and no only; distances come from other rooms. Cost: 0.35 s for a fine tree of a million
/// triangles, 0.1 s for a quick one, 3 to 8 million rays a second and thread. Results do not depend
/// on the number of threads.
class Sight {
  public:
    /// `mesh` and `facets` (those of the mesh) must outlive it.
    /// @error visibility.device  the ray caster could not be started, or lacks memory
    [[nodiscard]] static decomp::Result<Sight> of(const decomp::mesh::TriMesh& mesh,
                                                  const decomp::mesh::Facets& facets,
                                                  Tree tree = Tree::Fine);

    Sight(Sight&&) noexcept;
    Sight& operator=(Sight&&) noexcept;
    Sight(const Sight&) = delete;
    Sight& operator=(const Sight&) = delete;
    ~Sight();

    /// One facet, one direction of unit length. Thread-safe.
    [[nodiscard]] bool sees(std::size_t facet, const Eigen::Vector3d& direction, Facing facing,
                            const RayStart& start = {}) const;

    /// For each facet, whether it sees one of the directions: the best aligned is tried first, and
    /// the first that is seen ends the search.
    [[nodiscard]] std::vector<char> seen_from_any(const std::vector<Eigen::Vector3d>& directions,
                                                  Facing facing, const decomp::Run& run) const;

    /// For each facet, bit j set when it sees direction j. At most kMostDirections directions.
    [[nodiscard]] std::vector<std::uint64_t> seen_masks(
        const std::vector<Eigen::Vector3d>& directions, Facing facing,
        const decomp::Run& run) const;

    [[nodiscard]] const decomp::mesh::Facets& facets() const;

  private:
    struct Handles;
    explicit Sight(std::unique_ptr<Handles> handles);

    /// Whether it sees one of the directions other than number `but`.
    [[nodiscard]] bool sees_another(std::size_t facet,
                                    const std::vector<Eigen::Vector3d>& directions, std::size_t but,
                                    Facing facing) const;

    std::unique_ptr<Handles> handles_;
};

}  // namespace cam::visibility
