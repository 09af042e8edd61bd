#include "embree_tracer.h"

#include <embree3/rtcore.h>

#include <cmath>

#include "alhazen/session/stopwatch.h"

namespace alhazen::bench {

struct EmbreeTracer::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    double build_seconds = 0;
};

EmbreeTracer::EmbreeTracer(const TriangleMesh& mesh, bool robust)
    : impl_(std::make_unique<Impl>()) {
    const Stopwatch time;
    impl_->device = rtcNewDevice("threads=1");
    impl_->scene = rtcNewScene(impl_->device);
    rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
    if (robust) rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.positions.size()));
    for (const Vec3& p : mesh.positions) {
        for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(p[k]);
    }
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle) *indices++ = vertex;
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(impl_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(impl_->scene);
    impl_->build_seconds = time.seconds();
}

EmbreeTracer::~EmbreeTracer() {
    rtcReleaseScene(impl_->scene);
    rtcReleaseDevice(impl_->device);
}

double EmbreeTracer::build_seconds() const {
    return impl_->build_seconds;
}

std::size_t EmbreeTracer::trace(const RaySet& set) const {
    std::size_t hits = 0;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (const Ray& r : set.rays) {
        RTCRayHit query{};
        query.ray.org_x = static_cast<float>(r.origin.x);
        query.ray.org_y = static_cast<float>(r.origin.y);
        query.ray.org_z = static_cast<float>(r.origin.z);
        query.ray.dir_x = static_cast<float>(r.direction.x);
        query.ray.dir_y = static_cast<float>(r.direction.y);
        query.ray.dir_z = static_cast<float>(r.direction.z);
        query.ray.tnear = static_cast<float>(r.t_min);
        query.ray.tfar = static_cast<float>(r.t_max);
        query.ray.mask = 0xFFFFFFFFu;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        if (set.any_hit) {
            rtcOccluded1(impl_->scene, &context, &query.ray);
            hits += query.ray.tfar < 0.0f;
        } else {
            rtcIntersect1(impl_->scene, &context, &query);
            hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return hits;
}

}  // namespace alhazen::bench
