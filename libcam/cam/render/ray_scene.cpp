// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/render/ray_scene_detail.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <string>

namespace cam::render {

struct RayScene::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

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

// One instruction set on every machine, one thread: the tree, and with it which of two equally near
// triangles is met, is the same everywhere.
constexpr const char* kDeviceConfig = "isa=sse2";

struct Placing {
    Eigen::Vector3d centre;
    double radius_mm = 1;
};

bool attach(RTCDevice device, RTCScene scene, const Item& item, unsigned id,
            const Placing& placing) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto& mesh = *item.mesh;
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.points.size()));
    auto* corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    const bool ready = points != nullptr && corners != nullptr;
    if (ready) {
        for (const auto& point : mesh.points) {
            const Eigen::Vector3d scaled =
                (point + item.offset - placing.centre) / placing.radius_mm;
            points = std::copy_n(scaled.cast<float>().eval().data(), 3, points);
        }
        for (const auto& triangle : mesh.triangles) {
            corners = std::copy_n(triangle.data(), 3, corners);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
    }
    rtcReleaseGeometry(geometry);
    return ready;
}

RTCRay ray_from(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach) {
    RTCRay ray{};
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = direction.x();
    ray.dir_y = direction.y();
    ray.dir_z = direction.z();
    ray.tnear = 0;
    ray.tfar = reach;
    ray.mask = std::numeric_limits<unsigned>::max();
    return ray;
}

}  // namespace

RayScene::RayScene(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}

RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

decomp::Result<RayScene> RayScene::of(const std::vector<Item>& items, const Eigen::Vector3d& centre,
                                      double radius_mm) {
    auto handles = std::make_unique<Handles>();
    handles->device = rtcNewDevice(kDeviceConfig);
    if (handles->device == nullptr) {
        return decomp::fail("render.device", "the ray caster could not be started");
    }
    handles->scene = rtcNewScene(handles->device);
    rtcSetSceneFlags(handles->scene, RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].mesh->triangles.empty()) {
            continue;
        }
        if (!attach(handles->device, handles->scene, items[i], static_cast<unsigned>(i),
                    {centre, radius_mm})) {
            return decomp::fail("render.device", "not enough memory to draw the meshes", {},
                                "draw fewer parts at once");
        }
    }
    tbb::task_arena one_thread(1);
    one_thread.execute([&] { rtcCommitScene(handles->scene); });
    if (rtcGetDeviceError(handles->device) != RTC_ERROR_NONE) {
        return decomp::fail("render.device", "the ray caster refused the meshes");
    }
    return RayScene(std::move(handles));
}

Hit RayScene::first_hit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = ray_from(origin, direction, std::numeric_limits<float>::infinity());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(handles_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return {};
    }
    return {static_cast<std::int32_t>(query.hit.geomID), query.hit.primID, query.ray.tfar,
            query.hit.u, query.hit.v};
}

bool RayScene::blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                       float reach) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = ray_from(origin, direction, reach);
    rtcOccluded1(handles_->scene, &context, &ray);
    return ray.tfar < 0;
}

}  // namespace cam::render
