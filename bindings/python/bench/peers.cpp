/// The extension module alhazen_peers for numpy_bench.py: the C++ call without Python around it,
/// and Embree by the route that numpy arrays take in alhazen.
#include <embree3/rtcore.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <cstring>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <vector>

#include "alhazen/parallel/parallel.h"
#include "alhazen/tracer/tracer.h"

namespace py = pybind11;

namespace {

using Doubles = py::array_t<double, py::array::c_style>;
using Floats = py::array_t<float, py::array::c_style>;
using Faces = py::array_t<std::uint32_t, py::array::c_style>;

constexpr std::size_t kGrain = 1024;

/// Calls work(begin, end) for ranges that cover [0, count), from `threads` threads.
template <class Work>
void in_ranges(std::size_t count, int threads, const Work& work) {
    alhazen::ThreadLimit(threads).run([&] { alhazen::parallel_for(count, kGrain, work); });
}

/// Wall-clock seconds, or processor seconds of all threads.
double now(bool processor) {
    if (processor) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

class Direct {
  public:
    Direct(const Doubles& vertices, const Faces& faces) : tracer_(scene_of(vertices, faces)) {}

    /// Seconds, or processor seconds, of Tracer::intersect over all rays, with rays and hits
    /// already in memory; with `normals`, also of the normal of each hit.
    double seconds(const Doubles& numbers, int threads, bool normals, bool processor) {
        const auto count = static_cast<std::size_t>(numbers.shape(0));
        if (rays_.size() != count) {
            rays_.resize(count);
            hits_.resize(count);
            for (std::size_t i = 0; i < count; ++i) {
                const double* n = numbers.data() + 6 * i;
                rays_[i] = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
            }
        }
        normals_.resize(count);
        const double start = now(processor);
        const auto trace = [&](std::size_t begin, std::size_t end) {
            tracer_.intersect(std::span<const alhazen::Ray>(rays_).subspan(begin, end - begin),
                              std::span(hits_).subspan(begin, end - begin));
            if (!normals) return;
            alhazen::Surface scratch;
            for (std::size_t i = begin; i < end; ++i) {
                if (!hits_[i].found()) continue;
                normals_[i] = tracer_.normal(rays_[i], hits_[i], scratch);
            }
        };
        if (threads == 1) {
            trace(0, count);
        } else {
            in_ranges(count, threads, trace);
        }
        return now(processor) - start;
    }

  private:
    static alhazen::TracerScene scene_of(const Doubles& vertices, const Faces& faces) {
        std::vector<alhazen::Vec3> points(static_cast<std::size_t>(vertices.shape(0)));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double* v = vertices.data() + 3 * i;
            points[i] = {v[0], v[1], v[2]};
        }
        std::vector<std::array<std::uint32_t, 3>> triangles(
            static_cast<std::size_t>(faces.shape(0)));
        std::memcpy(triangles.data(), faces.data(), 12 * triangles.size());
        alhazen::TracerScene scene;
        scene.add_mesh(points, triangles);
        return scene;
    }

    alhazen::Tracer tracer_;
    std::vector<alhazen::Ray> rays_;
    std::vector<alhazen::Hit> hits_;
    std::vector<alhazen::Vec3> normals_;
};

class Embree {
  public:
    Embree(const Floats& vertices, const Faces& faces)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto points = static_cast<std::size_t>(vertices.shape(0));
        const auto triangles = static_cast<std::size_t>(faces.shape(0));
        std::memcpy(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, points),
            vertices.data(), 12 * points);
        std::memcpy(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                            triangles),
                    faces.data(), 12 * triangles);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene_);
    }
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    py::dict intersect(const Floats& numbers, int threads) const {
        const auto count = static_cast<std::size_t>(numbers.shape(0));
        py::array_t<float> t(numbers.shape(0)), uvs({numbers.shape(0), py::ssize_t{2}});
        py::array_t<std::uint32_t> geometry(numbers.shape(0)), primitive(numbers.shape(0));
        const float* rays = numbers.data();
        float* t_out = t.mutable_data();
        float* uv_out = uvs.mutable_data();
        std::uint32_t* geometry_out = geometry.mutable_data();
        std::uint32_t* primitive_out = primitive.mutable_data();
        {
            const py::gil_scoped_release released;
            in_ranges(count, threads, [&](std::size_t begin, std::size_t end) {
                thread_local std::vector<RTCRayHit> block;
                block.resize(end - begin);
                for (std::size_t i = begin; i < end; ++i) {
                    const float* n = rays + 6 * i;
                    RTCRayHit& r = block[i - begin];
                    r.ray = {n[0],        n[1], n[2],
                             0.0f,        n[3], n[4],
                             n[5],        0.0f, std::numeric_limits<float>::infinity(),
                             0xFFFFFFFFu, 0,    0};
                    r.hit.geomID = r.hit.primID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
                }
                RTCIntersectContext context;
                rtcInitIntersectContext(&context);
                rtcIntersect1M(scene_, &context, block.data(), static_cast<unsigned>(block.size()),
                               sizeof(RTCRayHit));
                for (std::size_t i = begin; i < end; ++i) {
                    const RTCRayHit& r = block[i - begin];
                    const bool found = r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
                    t_out[i] = r.ray.tfar;
                    geometry_out[i] = r.hit.geomID;
                    primitive_out[i] = r.hit.primID;
                    uv_out[2 * i] = found ? r.hit.u : 0.0f;
                    uv_out[2 * i + 1] = found ? r.hit.v : 0.0f;
                }
            });
        }
        py::dict result;
        result["t_hit"] = t;
        result["geometry_ids"] = geometry;
        result["primitive_ids"] = primitive;
        result["uvs"] = uvs;
        return result;
    }

  private:
    RTCDevice device_;
    RTCScene scene_;
};

}  // namespace

PYBIND11_MODULE(alhazen_peers, module) {
    py::class_<Direct>(module, "Direct")
        .def(py::init<const Doubles&, const Faces&>())
        .def("seconds", &Direct::seconds);
    py::class_<Embree>(module, "Embree")
        .def(py::init<const Floats&, const Faces&>())
        .def("intersect", &Embree::intersect);
}
