// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/visibility/sight.h"

#include "decomp/base/assert.h"
#include "decomp/base/parallel.h"
#include "decomp/mesh/measure.h"

#include <Eigen/Core>
#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace cam::visibility {

using decomp::fail;
using decomp::Result;
using decomp::mesh::Facets;
using decomp::mesh::TriMesh;

namespace {

constexpr std::size_t kPacket = 4;  // rays that are cast together

/// A facet and the direction that it may see.
struct Ask {
    std::size_t facet = 0;
    const Eigen::Vector3d* direction = nullptr;
};

}  // namespace

struct Sight::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    const Facets* facets = nullptr;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double scale = 1;  ///< millimetres to units of the diagonal

    /// Where the ray of a facet begins, in the tree's units.
    [[nodiscard]] Eigen::Vector3f start_of(std::size_t facet, double lift) const;

    /// Answers the first `count` of some questions together.
    void cast(const std::array<Ask, kPacket>& asks, std::size_t count,
              std::vector<char>& seen) const;

    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;

    ~Handles() {
        if (scene != nullptr) {
            rtcReleaseScene(scene);
        }
        if (device != nullptr) {
            rtcReleaseDevice(device);
        }
    }
};

namespace {

constexpr std::size_t kChunk = 2048;  // facets a task

// One instruction set on every machine: the same tree, the same rounding.
constexpr const char* kDeviceConfig = "isa=sse4.2";

/// A query that must not stop at the facet it starts from.
struct OwnFacet {
    RTCIntersectContext context{};
    unsigned facet = 0;
};

void pass_own_facet(const RTCFilterFunctionNArguments* args) {
    const auto* own = reinterpret_cast<const OwnFacet*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == -1 && RTCHitN_primID(args->hit, args->N, i) == own->facet) {
            args->valid[i] = 0;
        }
    }
}

/// How a mesh becomes float32 triangles.
struct Placing {
    Eigen::Vector3d centre;
    double scale;
    RTCBuildQuality quality;
};

bool attach(RTCDevice device, RTCScene scene, const TriMesh& mesh, const Placing& placing) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, placing.quality);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.points.size()));
    auto* corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    const bool ready = points != nullptr && corners != nullptr;
    if (ready) {
        for (const auto& point : mesh.points) {
            const Eigen::Vector3f scaled = ((point - placing.centre) * placing.scale).cast<float>();
            points = std::copy_n(scaled.data(), 3, points);
        }
        for (const auto& triangle : mesh.triangles) {
            corners = std::copy_n(triangle.data(), 3, corners);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, 0);
    }
    rtcReleaseGeometry(geometry);
    return ready;
}

bool faces(double cosine, Facing facing) {
    return facing == Facing::Front ? cosine > 0 : cosine >= -kWallCosine;
}

/// A direction and how well a facet faces it; the better aligned is less, then the lower index.
struct Faced {
    double cosine;
    std::size_t index;

    bool operator<(const Faced& other) const {
        return cosine != other.cosine ? cosine > other.cosine : index < other.index;
    }
};

/// Directions as columns: a facet's cosines with all of them are computed side by side.
class Columns {
  public:
    explicit Columns(const std::vector<Eigen::Vector3d>& directions)
        : rows_(static_cast<Eigen::Index>(directions.size()), 3) {
        for (std::size_t j = 0; j < directions.size(); ++j) {
            rows_.row(static_cast<Eigen::Index>(j)) = directions[j];
        }
    }

    /// The direction that is faced best; of equal ones the first.
    [[nodiscard]] Faced best_for(const Eigen::Vector3d& normal) const {
        Eigen::Index index = 0;
        const Eigen::ArrayXd cosines = rows_.col(0).array() * normal.x() +
                                       rows_.col(1).array() * normal.y() +
                                       rows_.col(2).array() * normal.z();
        const double cosine = cosines.maxCoeff(&index);
        return {cosine, static_cast<std::size_t>(index)};
    }

  private:
    Eigen::Matrix<double, Eigen::Dynamic, 3> rows_;
};

}  // namespace

Sight::Sight(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}

Sight::Sight(Sight&&) noexcept = default;
Sight& Sight::operator=(Sight&&) noexcept = default;
Sight::~Sight() = default;

Result<Sight> Sight::of(const TriMesh& mesh, const Facets& facets, Tree tree) {
    DECOMP_ASSERT(facets.unit.size() == mesh.triangles.size());
    auto handles = std::make_unique<Handles>();
    handles->facets = &facets;
    handles->device = rtcNewDevice(kDeviceConfig);
    if (handles->device == nullptr) {
        return fail("visibility.device", "the ray caster could not be started");
    }
    handles->scene = rtcNewScene(handles->device);
    // Quick: sorted along a space-filling curve instead of by the surface that rays will meet.
    const bool quick = tree == Tree::Quick;
    const RTCBuildQuality quality = quick ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
    const int layout = quick ? RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_COMPACT : 0;
    rtcSetSceneFlags(handles->scene,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION | layout));
    rtcSetSceneBuildQuality(handles->scene, quality);
    if (!mesh.triangles.empty()) {
        handles->centre = decomp::mesh::bounds(mesh).center();
        const double diagonal = decomp::mesh::diagonal_mm(mesh);
        handles->scale = diagonal > 0 ? 1 / diagonal : 1;
        if (!attach(handles->device, handles->scene, mesh,
                    {handles->centre, handles->scale, quality})) {
            return fail("visibility.device", "not enough memory for the rays' tree", {},
                        "check fewer triangles at once");
        }
    }
    tbb::task_arena one_thread(1);
    one_thread.execute([&] { rtcCommitScene(handles->scene); });
    if (rtcGetDeviceError(handles->device) != RTC_ERROR_NONE) {
        return fail("visibility.device", "the ray caster refused the mesh");
    }
    return Sight(std::move(handles));
}

Eigen::Vector3f Sight::Handles::start_of(std::size_t facet, double lift) const {
    const Eigen::Vector3d origin =
        (facets->centre[facet] - centre) * scale + lift * facets->unit[facet];
    return origin.cast<float>();
}

void Sight::Handles::cast(const std::array<Ask, kPacket>& asks, std::size_t count,
                          std::vector<char>& seen) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    std::array<int, kPacket> valid{};
    RTCRay4 rays{};
    for (std::size_t k = 0; k < count; ++k) {
        const Eigen::Vector3f origin = start_of(asks.at(k).facet, RayStart{}.lift);
        const Eigen::Vector3f direction = asks.at(k).direction->cast<float>();
        valid.at(k) = -1;
        rays.org_x[k] = origin.x();
        rays.org_y[k] = origin.y();
        rays.org_z[k] = origin.z();
        rays.dir_x[k] = direction.x();
        rays.dir_y[k] = direction.y();
        rays.dir_z[k] = direction.z();
        rays.tfar[k] = std::numeric_limits<float>::infinity();
        rays.mask[k] = std::numeric_limits<unsigned>::max();
    }
    rtcOccluded4(valid.data(), scene, &context, &rays);
    for (std::size_t k = 0; k < count; ++k) {
        seen[asks.at(k).facet] = rays.tfar[k] >= 0 ? 1 : 0;
    }
}

bool Sight::sees(std::size_t facet, const Eigen::Vector3d& direction, Facing facing,
                 const RayStart& start) const {
    const Eigen::Vector3d& normal = handles_->facets->unit[facet];
    if (!faces(normal.dot(direction), facing)) {
        return false;
    }
    const Eigen::Vector3f origin = handles_->start_of(facet, start.lift);
    OwnFacet query;
    query.facet = static_cast<unsigned>(facet);
    rtcInitIntersectContext(&query.context);
    if (start.skip_own) {
        query.context.filter = pass_own_facet;
    }
    RTCRay ray{};
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = static_cast<float>(direction.x());
    ray.dir_y = static_cast<float>(direction.y());
    ray.dir_z = static_cast<float>(direction.z());
    ray.tnear = 0;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = std::numeric_limits<unsigned>::max();
    rtcOccluded1(handles_->scene, &query.context, &ray);
    return ray.tfar >= 0;  // Embree sets it to minus infinity at a hit
}

bool Sight::sees_another(std::size_t facet, const std::vector<Eigen::Vector3d>& directions,
                         std::size_t but, Facing facing) const {
    const Eigen::Vector3d& normal = handles_->facets->unit[facet];
    std::vector<Faced> faced;
    for (std::size_t j = 0; j < directions.size(); ++j) {
        const double cosine = normal.dot(directions[j]);
        if (j != but && faces(cosine, facing)) {
            faced.push_back({cosine, j});
        }
    }
    std::sort(faced.begin(), faced.end());
    return std::any_of(faced.begin(), faced.end(), [&](const Faced& next) {
        return sees(facet, directions[next.index], facing);
    });
}

std::vector<char> Sight::seen_from_any(const std::vector<Eigen::Vector3d>& directions,
                                       Facing facing, const decomp::Run& run) const {
    const auto& unit = handles_->facets->unit;
    std::vector<char> seen(unit.size(), 0);
    const Columns columns(directions);
    decomp::for_each_index(run, (unit.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
        const std::size_t first = chunk * kChunk;
        const std::size_t last = std::min(unit.size(), first + kChunk);
        // Most facets are seen by the first ray; only the others need an order of directions.
        std::vector<std::size_t> best(last - first, 0);
        std::vector<std::size_t> asked;
        for (std::size_t i = first; i < last && !directions.empty(); ++i) {
            const Faced faced = columns.best_for(unit[i]);
            best[i - first] = faced.index;
            if (faces(faced.cosine, facing)) {
                asked.push_back(i);
            }
        }
        std::stable_sort(asked.begin(), asked.end(), [&](std::size_t a, std::size_t b) {
            return best[a - first] < best[b - first];
        });
        for (std::size_t k = 0; k < asked.size(); k += kPacket) {
            std::array<Ask, kPacket> asks{};
            const std::size_t count = std::min(kPacket, asked.size() - k);
            for (std::size_t l = 0; l < count; ++l) {
                const std::size_t facet = asked[k + l];
                asks.at(l) = {facet, &directions[best[facet - first]]};
            }
            handles_->cast(asks, count, seen);
        }
        for (const std::size_t i : asked) {
            if (seen[i] == 0 && sees_another(i, directions, best[i - first], facing)) {
                seen[i] = 1;
            }
        }
    });
    return seen;
}

std::vector<std::uint64_t> Sight::seen_masks(const std::vector<Eigen::Vector3d>& directions,
                                             Facing facing, const decomp::Run& run) const {
    DECOMP_ASSERT(directions.size() <= kMostDirections);
    const std::size_t count = handles_->facets->unit.size();
    std::vector<std::uint64_t> masks(count, 0);
    decomp::for_each_index(run, (count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
        for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
            for (std::size_t j = 0; j < directions.size(); ++j) {
                masks[i] |= sees(i, directions[j], facing) ? std::uint64_t{1} << j : 0;
            }
        }
    });
    return masks;
}

const Facets& Sight::facets() const { return *handles_->facets; }

}  // namespace cam::visibility
