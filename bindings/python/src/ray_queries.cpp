#include "ray_queries.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <string_view>

#include "alhazen/base/error.h"
#include "array_making.h"
#include "interruptible.h"
#include "ray_array.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

constexpr std::array<const char*, 9> kFields{
    "t_hit",  "geometry_ids",    "primitive_ids", "uvs",         "normals",
    "points", "shading_normals", "instance_ids",  "material_ids"};

Coherence coherence_of(const BatchOptions& options) {
    return options.coherent ? Coherence::Coherent : Coherence::Any;
}

/// The arrays of hits that the caller requests; others are empty.
class HitArrays {
  public:
    HitArrays(const std::vector<std::string>& fields, bool single, const Shape& shape) {
        for (const std::string& field : fields) add(field, single, shape);
    }

    /// Writes hit `i` into the arrays.
    void set(const Tracer& tracer, const Ray& ray, const Hit& hit, std::size_t i,
             Surface& scratch) const {
        const bool found = hit.found();
        if (t_) t_.set(i, hit.t);
        if (uvs_) {
            uvs_.set(2 * i, found ? hit.u : 0.0);
            uvs_.set(2 * i + 1, found ? hit.v : 0.0);
        }
        if (wants_ids_) set_ids(tracer, hit, i);
        if (wants_surface_) {
            set_surface_of(tracer, ray, hit, i, scratch);
        } else if (normals_) {
            normals_.set(i, found ? tracer.normal(ray, hit, scratch) : Vec3{});
        }
    }

    [[nodiscard]] py::dict take() const {
        py::dict result;
        for (const auto& [name, array] : named_) result[py::str(name)] = array;
        return result;
    }

  private:
    void add(const std::string& field, bool single, const Shape& shape) {
        const auto real = [&](RealArray& array, py::ssize_t columns) {
            array = RealArray(single, shape, columns);
            named_.emplace_back(field, array.array());
        };
        const auto ids = [&](PlainArray<std::uint32_t>& array) {
            array = PlainArray<std::uint32_t>(shape);
            named_.emplace_back(field, array.array());
        };
        if (field == "t_hit") return real(t_, 0);
        if (field == "uvs") return real(uvs_, 2);
        wants_ids_ |=
            field == "geometry_ids" || field == "primitive_ids" || field == "instance_ids";
        if (field == "geometry_ids") return ids(geometry_);
        if (field == "primitive_ids") return ids(primitive_);
        if (field == "instance_ids") return ids(instance_);
        if (field == "normals") return real(normals_, 3);
        wants_surface_ = true;
        if (field == "shading_normals") return real(shading_normals_, 3);
        if (field == "points") return real(points_, 3);
        if (field == "material_ids") return ids(material_);
        std::string known;
        for (const char* name : kFields) known += (known.empty() ? "" : ", ") + std::string(name);
        throw Error(ErrorKind::Usage, "unknown field '" + field + "'; known are " + known);
    }

    void set_ids(const Tracer& tracer, const Hit& hit, std::size_t i) const {
        HitIds ids{GeometryId{kNone}, kNone, GeometryId{kNone}};
        if (hit.found()) ids = tracer.ids(hit);
        if (geometry_) geometry_[i] = static_cast<std::uint32_t>(ids.geometry);
        if (primitive_) primitive_[i] = ids.primitive;
        if (instance_) instance_[i] = static_cast<std::uint32_t>(ids.outermost);
    }

    void set_surface_of(const Tracer& tracer, const Ray& ray, const Hit& hit, std::size_t i,
                        Surface& surface) const {
        const bool found = hit.found();
        if (found) tracer.surface(ray, hit, surface);
        if (normals_) normals_.set(i, found ? surface.normal : Vec3{});
        if (shading_normals_) shading_normals_.set(i, found ? surface.shading_normal : Vec3{});
        if (points_) points_.set(i, found ? surface.point : Vec3{});
        if (material_) {
            material_[i] = found ? static_cast<std::uint32_t>(surface.materials[0]) : kNone;
        }
    }

    RealArray t_, uvs_, normals_, shading_normals_, points_;
    PlainArray<std::uint32_t> geometry_, primitive_, instance_, material_;
    std::vector<std::pair<std::string, py::array>> named_;
    bool wants_ids_ = false;
    bool wants_surface_ = false;  ///< anything but the normal
};

/// Scratch memory of a thread for its ranges of rays.
struct RangeScratch {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    HitLists lists;
    Surface surface;
};

RangeScratch& scratch_of_thread() {
    thread_local RangeScratch scratch;
    return scratch;
}

/// Counts the hits of each ray into counts[ray].
void count_hits(const BuiltScene& scene, const RayArray& rays, const BatchOptions& options,
                std::int64_t* counts) {
    run_in_blocks(rays.count(), options.threads, [&](std::size_t begin, std::size_t end) {
        RangeScratch& scratch = scratch_of_thread();
        const std::span<const Ray> range = rays.rays(begin, end, scratch.rays);
        scene.tracer().all_hits(range, scratch.lists, options.mask);
        for (std::size_t i = 0; i < range.size(); ++i) {
            counts[begin + i] = static_cast<std::int64_t>(scratch.lists.of(i).size());
        }
    });
}

}  // namespace

std::vector<std::string> hit_fields() {
    return {kFields.begin(), kFields.end()};
}

py::dict intersect(const BuiltScene& scene, const py::object& rays_object,
                   const std::vector<std::string>& fields, const BatchOptions& options) {
    const RayArray rays(rays_object);
    const HitArrays arrays(fields, rays.single(), rays.shape());
    run_in_blocks(rays.count(), options.threads, [&](std::size_t begin, std::size_t end) {
        RangeScratch& scratch = scratch_of_thread();
        const std::span<const Ray> range = rays.rays(begin, end, scratch.rays);
        scratch.hits.resize(range.size());
        const std::span<Hit> hits(scratch.hits);
        scene.tracer().intersect(range, hits, options.mask, coherence_of(options));
        for (std::size_t i = 0; i < range.size(); ++i) {
            arrays.set(scene.tracer(), range[i], hits[i], begin + i, scratch.surface);
        }
    });
    return arrays.take();
}

py::object occluded(const BuiltScene& scene, const py::object& rays_object,
                    const BatchOptions& options) {
    const RayArray rays(rays_object);
    const PlainArray<bool> result(rays.shape());
    run_in_blocks(rays.count(), options.threads, [&](std::size_t begin, std::size_t end) {
        const std::span<const Ray> range = rays.rays(begin, end, scratch_of_thread().rays);
        scene.tracer().occluded(range, std::span(result.data() + begin, range.size()), options.mask,
                                coherence_of(options));
    });
    return result.array();
}

py::object count_intersections(const BuiltScene& scene, const py::object& rays_object,
                               const BatchOptions& options) {
    const RayArray rays(rays_object);
    const PlainArray<std::int64_t> result(rays.shape());
    count_hits(scene, rays, options, result.data());
    return result.array();
}

py::dict all_hits(const BuiltScene& scene, const py::object& rays_object,
                  const BatchOptions& options) {
    const RayArray rays(rays_object);
    const std::size_t count = rays.count();
    const PlainArray<std::int64_t> splits(length(count + 1));
    splits[0] = 0;
    count_hits(scene, rays, options, splits.data() + 1);
    for (std::size_t i = 0; i < count; ++i) splits[i + 1] += splits[i];
    const auto total = static_cast<std::size_t>(splits[count]);
    const PlainArray<std::int64_t> ray_ids(length(total));
    const HitArrays arrays({"t_hit", "geometry_ids", "primitive_ids", "uvs"}, rays.single(),
                           length(total));
    // Tracing twice is cheaper than keeping all hits, which are large.
    run_in_blocks(count, options.threads, [&](std::size_t begin, std::size_t end) {
        RangeScratch& scratch = scratch_of_thread();
        const std::span<const Ray> range = rays.rays(begin, end, scratch.rays);
        scene.tracer().all_hits(range, scratch.lists, options.mask);
        for (std::size_t i = 0; i < range.size(); ++i) {
            auto at = static_cast<std::size_t>(splits[begin + i]);
            // The caller's array is read twice: another thread may have written to it.
            if (scratch.lists.of(i).size() !=
                static_cast<std::size_t>(splits[begin + i + 1]) - at) {
                throw Error(ErrorKind::Usage, "the rays were changed while they were traced");
            }
            for (const Hit& hit : scratch.lists.of(i)) {
                ray_ids[at] = static_cast<std::int64_t>(begin + i);
                arrays.set(scene.tracer(), range[i], hit, at++, scratch.surface);
            }
        }
    });
    py::dict result = arrays.take();
    result["ray_splits"] = splits.array();
    result["ray_ids"] = ray_ids.array();
    return result;
}

bool traced_in_place(const py::object& rays) {
    return RayArray(rays).in_place();
}

}  // namespace alhazen::python
