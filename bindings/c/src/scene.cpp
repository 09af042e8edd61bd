#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/parallel/parallel.h"
#include "handles.h"

namespace alhazen::capi {

namespace {

/// Adds committed geometries to a TracerScene.
class Gatherer {
  public:
    explicit Gatherer(Built& built) : built_(built) {}

    void add(unsigned id, const Geometry& geometry) {
        switch (geometry.type) {
            case ALHAZEN_GEOMETRY_TYPE_TRIANGLE:
                return add_triangles(id, geometry);
            case ALHAZEN_GEOMETRY_TYPE_SPHERE_POINT:
                return add_spheres(id, geometry);
            case ALHAZEN_GEOMETRY_TYPE_INSTANCE:
                return add_instance(id, geometry);
        }
    }
    [[nodiscard]] TracerScene take() { return std::move(scene_); }

  private:
    /// The place that errors name: the scene's id, not the tracer's number of the geometry.
    static std::string place_of(unsigned id) { return "geometry " + std::to_string(id); }
    /// Throws what is wrong with a shape that the tracer has refused.
    template <class Shape>
    static void refuse(const Shape& shape, const std::string& place) {
        Diagnostics found;
        shape.validate({place, 0, 0}, found);
        found.throw_if_errors();
    }

    void add_triangles(unsigned id, const Geometry& geometry) {
        auto mesh = std::make_shared<TriangleMesh>();
        const Buffer& vertex = geometry.vertex;
        mesh->positions.resize(vertex.count);
        for (std::size_t i = 0; i < vertex.count; ++i) {
            mesh->positions[i] = {vertex.real(i, 0), vertex.real(i, 1), vertex.real(i, 2)};
        }
        const Buffer& index = geometry.index;
        mesh->triangles.resize(index.count);
        for (std::size_t i = 0; i < index.count; ++i) {
            mesh->triangles[i] = {index.whole(i, 0), index.whole(i, 1), index.whole(i, 2)};
        }
        const std::shared_ptr<const TriangleMesh> shared = std::move(mesh);
        try {
            scene_.add_mesh(shared, {.visible_to = geometry.mask});
        } catch (const Error&) {
            refuse(*shared, place_of(id));
            throw;
        }
        built_.origins.push_back({id, 0, nullptr});
    }

    void add_spheres(unsigned id, const Geometry& geometry) {
        const Buffer& vertex = geometry.vertex;
        for (std::size_t i = 0; i < vertex.count; ++i) {
            const Sphere sphere{.center = {vertex.real(i, 0), vertex.real(i, 1), vertex.real(i, 2)},
                                .radius = vertex.real(i, 3)};
            try {
                scene_.add(sphere, {.visible_to = geometry.mask});
            } catch (const Error&) {
                refuse(sphere, place_of(id) + ", primitive " + std::to_string(i));
                throw;
            }
            built_.origins.push_back({id, static_cast<unsigned>(i), nullptr});
        }
    }

    void add_instance(unsigned id, const Geometry& geometry) {
        const auto need_of_instance = [&](bool holds, AlhazenError code, const char* text) {
            if (!holds) throw CodedError(code, place_of(id) + ": " + text);
        };
        need_of_instance(static_cast<bool>(geometry.instanced), ALHAZEN_ERROR_INVALID_OPERATION,
                         "an instance has no scene: alhazenSetGeometryInstancedScene");
        const auto inner = geometry.instanced->built;
        need_of_instance(inner != nullptr, ALHAZEN_ERROR_INVALID_OPERATION,
                         "the scene of an instance is not committed");
        need_of_instance(!inner->has_instances, ALHAZEN_ERROR_INVALID_OPERATION,
                         "the scene of an instance has instances itself");
        need_of_instance(is_invertible(geometry.transform), ALHAZEN_ERROR_INVALID_ARGUMENT,
                         "the transform is singular or not finite");
        scene_.add_instance(*inner->tracer, {.world_from_geometry = geometry.transform,
                                             .visible_to = geometry.mask});
        built_.origins.push_back({id, 0, inner});
        built_.has_instances = true;
    }

    Built& built_;
    TracerScene scene_;
};

/// Bytes of the copy of a geometry.
std::int64_t bytes_of(const Geometry& geometry) {
    const bool spheres = geometry.type == ALHAZEN_GEOMETRY_TYPE_SPHERE_POINT;
    const std::size_t bytes = geometry.vertex.count * (spheres ? sizeof(Sphere) : sizeof(Vec3)) +
                              geometry.index.count * 3 * sizeof(std::uint32_t);
    return static_cast<std::int64_t>(bytes);
}

/// Memory reported to the monitor; reported as freed on destruction unless it is kept.
class ToldMemory {
  public:
    explicit ToldMemory(const Device& device) : device_(device) {}
    ~ToldMemory() {
        if (bytes_ != 0) device_.tell_memory(-bytes_, true);
    }
    ToldMemory(const ToldMemory&) = delete;
    ToldMemory& operator=(const ToldMemory&) = delete;

    /// Throws CodedError if the monitor refuses. Bytes refused after their allocation (`post`) are
    /// reported as freed too.
    void add(std::int64_t bytes, bool post) {
        const bool allowed = device_.tell_memory(bytes, post);
        if (allowed || post) bytes_ += bytes;
        need(allowed, ALHAZEN_ERROR_OUT_OF_MEMORY, "the memory monitor forbids to build");
    }
    std::int64_t keep() { return std::exchange(bytes_, 0); }

  private:
    const Device& device_;
    std::int64_t bytes_ = 0;
};

/// Runs `work` with the scene, which must not be null.
template <class Work>
void with_scene(AlhazenScene handle, const Work& work) {
    Scene* scene = object(handle);
    if (scene == nullptr) {
        return guarded(nullptr, [] { need_argument(false, "the scene is NULL"); });
    }
    // A monitor may release the scene, and with it the last reference to the device.
    const Reference<Device> device = held_device_of(*scene);
    guarded(device.get(), [&] { work(*scene); });
}

/// The nearest floats, rounded outward.
float below(double x) {
    const auto f = static_cast<float>(x);
    return double(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float above(double x) {
    return -below(-x);
}

}  // namespace

std::mutex& structure_mutex() {
    static std::mutex mutex;
    return mutex;
}

Scene::~Scene() {
    {
        const std::lock_guard lock(structure_mutex());
        for (const auto& [id, geometry] : geometries) {
            std::erase(geometry->holders, this);
        }
    }
    if (built) device->tell_memory(-built->bytes, true);
}

bool Scene::reaches(const Scene* other) const {
    std::set<const Scene*> seen{this};
    std::vector<const Scene*> open{this};
    while (!open.empty()) {
        const Scene* scene = open.back();
        open.pop_back();
        if (scene == other) return true;
        if (scene->instance_count_ == 0) continue;
        for (const auto& [id, geometry] : scene->geometries) {
            const Scene* inner = geometry->instanced.get();
            if (inner != nullptr && seen.insert(inner).second) open.push_back(inner);
        }
    }
    return false;
}

void Scene::attach_locked(unsigned id, Geometry& geometry) {
    need(!geometry.instanced || !geometry.instanced->reaches(this), ALHAZEN_ERROR_INVALID_OPERATION,
         "the scene of the instance holds this scene: a scene cannot be an instance in itself");
    const bool instance = geometry.type == ALHAZEN_GEOMETRY_TYPE_INSTANCE;
    if (instance) geometry.holders.reserve(geometry.holders.size() + 1);
    const bool added = geometries.emplace(id, Reference<Geometry>(&geometry)).second;
    need(added, ALHAZEN_ERROR_INVALID_OPERATION, "the id is in use");
    if (!instance) return;
    geometry.holders.push_back(this);
    ++instance_count_;
}

void Scene::attach(unsigned id, Geometry& geometry) {
    const std::lock_guard lock(structure_mutex());
    attach_locked(id, geometry);
}

unsigned Scene::attach(Geometry& geometry) {
    const std::lock_guard lock(structure_mutex());
    unsigned id = first_free_;
    while (geometries.count(id) != 0) ++id;
    attach_locked(id, geometry);
    first_free_ = id + 1;
    return id;
}

void Scene::detach(unsigned id) {
    Reference<Geometry> geometry;  // released after the mutex
    const std::lock_guard lock(structure_mutex());
    const auto found = geometries.find(id);
    need_argument(found != geometries.end(), "no geometry has this id");
    geometry = std::move(found->second);
    geometries.erase(found);
    first_free_ = std::min(first_free_, id);
    if (geometry->type != ALHAZEN_GEOMETRY_TYPE_INSTANCE) return;
    auto& holders = geometry->holders;
    holders.erase(std::find(holders.begin(), holders.end(), this));
    --instance_count_;
}

void Scene::tell(double done) const {
    need(progress == nullptr || progress(progress_pointer, done), ALHAZEN_ERROR_CANCELLED,
         "the progress monitor ended the commit");
}

void Scene::commit(bool join) {
    const Reference<Scene> alive(this);  // a monitor may release the caller's reference
    {
        std::unique_lock lock(commit_mutex_);
        if (committing_) {
            need(join && *committing_ != std::this_thread::get_id(),
                 ALHAZEN_ERROR_INVALID_OPERATION,
                 "the scene is being committed; another thread may alhazenJoinCommitScene");
            commit_ended_.wait(lock, [&] { return !committing_; });
            return;
        }
        committing_ = std::this_thread::get_id();
    }
    const auto end = [this] {
        const std::lock_guard lock(commit_mutex_);
        committing_.reset();
        commit_ended_.notify_all();
    };
    try {
        build();
    } catch (...) {
        end();
        throw;
    }
    end();
}

void Scene::build() {
    ToldMemory memory(*device.get());  // on an error reported as freed after `next` is
    auto next = std::make_shared<Built>();
    Gatherer gatherer(*next);
    std::vector<std::pair<unsigned, Reference<Geometry>>> wanted;
    {
        const std::lock_guard lock(structure_mutex());
        for (const auto& [id, geometry] : geometries) {
            if (geometry->enabled && geometry->committed) wanted.emplace_back(id, geometry);
        }
    }
    std::int64_t bytes = 0;
    for (const auto& [id, geometry] : wanted) bytes += bytes_of(*geometry.get());
    tell(0.0);
    memory.add(bytes, false);
    // Copying the geometry counts as a tenth of the work.
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        gatherer.add(wanted[i].first, *wanted[i].second.get());
        tell(0.1 * static_cast<double>(i + 1) / static_cast<double>(wanted.size()));
    }
    TracerOptions options = device->options;
    if (quality) options.build.quality = *quality;
    ThreadLimit(device->threads).run([&] { next->tracer.emplace(gatherer.take(), options); });
    memory.add(static_cast<std::int64_t>(next->tracer->memory_bytes()), true);
    next->bytes = memory.keep();
    const std::int64_t before = built ? built->bytes : 0;
    built = std::move(next);
    if (before != 0) device->tell_memory(-before, true);
    if (progress != nullptr) (void)progress(progress_pointer, 1.0);  // too late to end the commit
}

}  // namespace alhazen::capi

using namespace alhazen::capi;

AlhazenScene alhazenNewScene(AlhazenDevice device) {
    return guarded(object(device), static_cast<AlhazenScene>(nullptr), [&] {
        need_argument(device != nullptr, "the device is NULL");
        return reinterpret_cast<AlhazenScene>(new Scene(object(device)));
    });
}
void alhazenRetainScene(AlhazenScene scene) {
    if (scene != nullptr) object(scene)->retain();
}
void alhazenReleaseScene(AlhazenScene scene) {
    if (scene != nullptr) object(scene)->release();
}

void alhazenSetSceneBuildQuality(AlhazenScene scene, AlhazenBuildQuality quality) {
    with_scene(scene, [&](Scene& s) {
        need_argument(quality >= ALHAZEN_BUILD_QUALITY_LOW && quality <= ALHAZEN_BUILD_QUALITY_HIGH,
                      "a build quality is LOW, MEDIUM or HIGH");
        using alhazen::BuildQuality;
        constexpr BuildQuality kQualities[] = {BuildQuality::Fast, BuildQuality::Default,
                                               BuildQuality::High};
        s.quality = kQualities[quality];
    });
}
void alhazenSetSceneFlags(AlhazenScene scene, AlhazenSceneFlags flags) {
    with_scene(scene, [&](Scene& s) { s.flags = flags; });
}
AlhazenSceneFlags alhazenGetSceneFlags(AlhazenScene scene) {
    AlhazenSceneFlags flags = ALHAZEN_SCENE_FLAG_NONE;
    with_scene(scene, [&](Scene& s) { flags = s.flags; });
    return flags;
}
AlhazenDevice alhazenGetSceneDevice(AlhazenScene scene) {
    AlhazenDevice device = nullptr;
    with_scene(scene, [&](Scene& s) {
        s.device->retain();
        device = reinterpret_cast<AlhazenDevice>(s.device.get());
    });
    return device;
}
void alhazenSetSceneProgressMonitorFunction(AlhazenScene scene,
                                            AlhazenProgressMonitorFunction progress,
                                            void* userPtr) {
    with_scene(scene, [&](Scene& s) {
        s.progress = progress;
        s.progress_pointer = userPtr;
    });
}

unsigned int alhazenAttachGeometry(AlhazenScene scene, AlhazenGeometry geometry) {
    unsigned id = ALHAZEN_INVALID_ID;
    with_scene(scene, [&](Scene& s) {
        need_argument(geometry != nullptr, "the geometry is NULL");
        id = s.attach(*object(geometry));
    });
    return id;
}
void alhazenAttachGeometryByID(AlhazenScene scene, AlhazenGeometry geometry, unsigned int geomID) {
    with_scene(scene, [&](Scene& s) {
        need_argument(geometry != nullptr, "the geometry is NULL");
        need_argument(geomID != ALHAZEN_INVALID_ID, "the id is ALHAZEN_INVALID_ID");
        s.attach(geomID, *object(geometry));
    });
}
void alhazenDetachGeometry(AlhazenScene scene, unsigned int geomID) {
    with_scene(scene, [&](Scene& s) { s.detach(geomID); });
}
AlhazenGeometry alhazenGetGeometry(AlhazenScene scene, unsigned int geomID) {
    AlhazenGeometry geometry = nullptr;
    with_scene(scene, [&](Scene& s) {
        const std::lock_guard lock(structure_mutex());
        const auto found = s.geometries.find(geomID);
        need_argument(found != s.geometries.end(), "no geometry has this id");
        geometry = reinterpret_cast<AlhazenGeometry>(found->second.get());
    });
    return geometry;
}
AlhazenGeometry alhazenGetGeometryThreadSafe(AlhazenScene scene, unsigned int geomID) {
    return alhazenGetGeometry(scene, geomID);
}

void alhazenCommitScene(AlhazenScene scene) {
    with_scene(scene, [](Scene& s) { s.commit(false); });
}
void alhazenJoinCommitScene(AlhazenScene scene) {
    with_scene(scene, [](Scene& s) { s.commit(true); });
}

void alhazenGetSceneBounds(AlhazenScene scene, AlhazenBounds* bounds_o) {
    with_scene(scene, [&](Scene& s) {
        need_argument(bounds_o != nullptr, "bounds_o is NULL");
        need(s.built != nullptr, ALHAZEN_ERROR_INVALID_OPERATION, "the scene is not committed");
        const alhazen::Box3 box = s.built->tracer->box();
        *bounds_o = {below(box.lo.x), below(box.lo.y), below(box.lo.z), 0,
                     above(box.hi.x), above(box.hi.y), above(box.hi.z), 0};
    });
}
