#include "embree/embree_scene.h"

#include <fmt/format.h>

#include <atomic>

#include "alhazen/base/error.h"
#include "alhazen/base/stopwatch.h"
#include "embree/embree_cylinders.h"

namespace alhazen::bench {

struct EmbreeScene::Impl {
    std::atomic<std::ptrdiff_t> bytes{0};
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    double build_seconds = 0;
    std::vector<float> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<float> sphere_points;  ///< [sphere][4] center, radius
    std::vector<float> curve_points;   ///< [2 * cylinder][4] end, radius
    std::vector<std::uint32_t> curve_indices;
    EmbreeCylinders cylinders;

    ~Impl() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }

    void check() const {
        const RTCError error = rtcGetDeviceError(device);
        if (error != RTC_ERROR_NONE) {
            throw Error(ErrorKind::Resource, fmt::format("Embree: error {}", int(error)));
        }
    }

    void attach(RTCGeometry geometry, RTCBuildQuality quality) {
        rtcSetGeometryBuildQuality(geometry, quality);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        check();
    }

    void add_triangles(const TriangleMesh& mesh, RTCBuildQuality quality);
    void add_spheres(const std::vector<Sphere>& spheres, RTCBuildQuality quality);
    void add_curves(const std::vector<Cylinder>& list, RTCBuildQuality quality);
};

namespace {

void push(std::vector<float>& list, const Vec3& p) {
    for (int k = 0; k < 3; ++k) list.push_back(static_cast<float>(p[k]));
}

bool count_bytes(void* counter, ssize_t bytes, bool) {
    *static_cast<std::atomic<std::ptrdiff_t>*>(counter) += bytes;
    return true;
}

}  // namespace

void EmbreeScene::Impl::add_triangles(const TriangleMesh& mesh, RTCBuildQuality quality) {
    if (mesh.triangles.empty()) return;
    vertices.reserve(3 * mesh.positions.size() + 4);
    for (const Vec3& p : mesh.positions) push(vertices, p);
    vertices.resize(vertices.size() + 4);  // Embree reads 16 bytes per vertex
    for (const auto& triangle : mesh.triangles) {
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               vertices.data(), 0, 3 * sizeof(float), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices.data(),
                               0, 3 * sizeof(std::uint32_t), mesh.triangles.size());
    attach(geometry, quality);
}

void EmbreeScene::Impl::add_spheres(const std::vector<Sphere>& spheres, RTCBuildQuality quality) {
    if (spheres.empty()) return;
    for (const Sphere& s : spheres) {
        push(sphere_points, s.center);
        sphere_points.push_back(static_cast<float>(s.radius));
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                               sphere_points.data(), 0, 4 * sizeof(float), spheres.size());
    attach(geometry, quality);
}

void EmbreeScene::Impl::add_curves(const std::vector<Cylinder>& list, RTCBuildQuality quality) {
    for (const Cylinder& c : list) {
        curve_indices.push_back(static_cast<std::uint32_t>(curve_points.size() / 4));
        for (const Vec3& end : {c.base, c.top}) {
            push(curve_points, end);
            curve_points.push_back(static_cast<float>(c.radius));
        }
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                               curve_points.data(), 0, 4 * sizeof(float), 2 * list.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                               curve_indices.data(), 0, sizeof(std::uint32_t), list.size());
    attach(geometry, quality);
}

EmbreeScene::EmbreeScene(const KernelScene& scene, const EmbreeOptions& options)
    : impl_(std::make_unique<Impl>()) {
    std::string config;
    if (options.threads > 0) config = fmt::format("threads={}", options.threads);
    if (!options.isa.empty()) config += (config.empty() ? "isa=" : ",isa=") + options.isa;
    impl_->device = rtcNewDevice(config.empty() ? nullptr : config.c_str());
    if (impl_->device == nullptr) throw Error(ErrorKind::Resource, "Embree: no device");
    rtcSetDeviceMemoryMonitorFunction(impl_->device, count_bytes, &impl_->bytes);
    impl_->scene = rtcNewScene(impl_->device);
    rtcSetSceneBuildQuality(impl_->scene, options.quality);
    if (options.robust) rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    impl_->add_triangles(scene.mesh, options.quality);
    impl_->add_spheres(scene.spheres, options.quality);
    if (!scene.cylinders.empty()) {
        if (options.cylinders_are_curves) {
            impl_->add_curves(scene.cylinders, options.quality);
        } else {
            impl_->cylinders = EmbreeCylinders(scene.cylinders);
            impl_->attach(impl_->cylinders.make_geometry(impl_->device), options.quality);
        }
    }
    const Stopwatch time;
    rtcCommitScene(impl_->scene);
    impl_->build_seconds = time.seconds();
    impl_->check();
}

EmbreeScene::~EmbreeScene() = default;

RTCScene EmbreeScene::handle() const {
    return impl_->scene;
}

double EmbreeScene::build_seconds() const {
    return impl_->build_seconds;
}

std::size_t EmbreeScene::memory_bytes() const {
    return static_cast<std::size_t>(impl_->bytes.load());
}

}  // namespace alhazen::bench
