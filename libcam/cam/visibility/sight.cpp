// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/visibility/sight.h"

#include "decomp/base/assert.h"
#include "decomp/base/parallel.h"
#include "decomp/mesh/measure.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace cam::visibility {

using decomp::fail;
using decomp::Result;
using decomp::mesh::Facets;
using decomp::mesh::TriMesh;

struct Sight::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    const Facets* facets = nullptr;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double scale = 1;  ///< millimetres to units of the diagonal

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

bool attach(RTCDevice device, RTCScene scene, const TriMesh& mesh, const Eigen::Vector3d& centre,
            double scale) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.points.size()));
    auto* corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    const bool ready = points != nullptr && corners != nullptr;
    if (ready) {
        for (const auto& point : mesh.points) {
            const Eigen::Vector3f scaled = ((point - centre) * scale).cast<float>();
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

}  // namespace

Sight::Sight(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}

Sight::Sight(Sight&&) noexcept = default;
Sight& Sight::operator=(Sight&&) noexcept = default;
Sight::~Sight() = default;

Result<Sight> Sight::of(const TriMesh& mesh, const Facets& facets) {
    DECOMP_ASSERT(facets.unit.size() == mesh.triangles.size());
    auto handles = std::make_unique<Handles>();
    handles->facets = &facets;
    handles->device = rtcNewDevice(kDeviceConfig);
    if (handles->device == nullptr) {
        return fail("visibility.device", "the ray caster could not be started");
    }
    handles->scene = rtcNewScene(handles->device);
    rtcSetSceneFlags(handles->scene,
                     RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    if (!mesh.triangles.empty()) {
        handles->centre = decomp::mesh::bounds(mesh).center();
        const double diagonal = decomp::mesh::diagonal_mm(mesh);
        handles->scale = diagonal > 0 ? 1 / diagonal : 1;
        if (!attach(handles->device, handles->scene, mesh, handles->centre, handles->scale)) {
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

bool Sight::sees(std::size_t facet, const Eigen::Vector3d& direction, Facing facing,
                 const RayStart& start) const {
    const Eigen::Vector3d& normal = handles_->facets->unit[facet];
    if (!faces(normal.dot(direction), facing)) {
        return false;
    }
    const Eigen::Vector3d origin =
        (handles_->facets->centre[facet] - handles_->centre) * handles_->scale +
        start.lift * normal;
    OwnFacet query;
    query.facet = static_cast<unsigned>(facet);
    rtcInitIntersectContext(&query.context);
    if (start.skip_own) {
        query.context.filter = pass_own_facet;
    }
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x());
    ray.org_y = static_cast<float>(origin.y());
    ray.org_z = static_cast<float>(origin.z());
    ray.dir_x = static_cast<float>(direction.x());
    ray.dir_y = static_cast<float>(direction.y());
    ray.dir_z = static_cast<float>(direction.z());
    ray.tnear = 0;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = std::numeric_limits<unsigned>::max();
    rtcOccluded1(handles_->scene, &query.context, &ray);
    return ray.tfar >= 0;  // Embree sets it to minus infinity at a hit
}

std::vector<char> Sight::seen_from_any(const std::vector<Eigen::Vector3d>& directions,
                                       Facing facing, const decomp::Run& run) const {
    const std::size_t count = handles_->facets->unit.size();
    std::vector<char> seen(count, 0);
    decomp::for_each_index(run, (count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
        std::vector<Faced> faced;
        for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
            const Eigen::Vector3d& normal = handles_->facets->unit[i];
            Faced best{-2, 0};
            for (std::size_t j = 0; j < directions.size(); ++j) {
                const double cosine = normal.dot(directions[j]);
                best = cosine > best.cosine ? Faced{cosine, j} : best;
            }
            if (directions.empty() || !faces(best.cosine, facing)) {
                continue;
            }
            // Most facets are seen by the first ray; only the others need an order.
            if (sees(i, directions[best.index], facing)) {
                seen[i] = 1;
                continue;
            }
            faced.clear();
            for (std::size_t j = 0; j < directions.size(); ++j) {
                const double cosine = normal.dot(directions[j]);
                if (j != best.index && faces(cosine, facing)) {
                    faced.push_back({cosine, j});
                }
            }
            std::sort(faced.begin(), faced.end());
            seen[i] = std::any_of(faced.begin(), faced.end(),
                                  [&](const Faced& next) {
                                      return sees(i, directions[next.index], facing);
                                  })
                          ? 1
                          : 0;
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
