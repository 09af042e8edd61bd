#pragma once
/// The objects behind the handles of alhazen.h, and the boundary that no exception crosses.

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "alhazen/alhazen.h"
#include "alhazen/base/error.h"
#include "alhazen/tracer/tracer.h"

namespace alhazen::capi {

/// An object with a reference count, which deletes itself with its last reference.
class Counted {
  public:
    virtual ~Counted() = default;
    void retain() { references_.fetch_add(1, std::memory_order_relaxed); }
    void release() {
        if (references_.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
    }

  private:
    std::atomic<std::int64_t> references_{1};
};

/// Holds one reference.
template <class T>
class Reference {
  public:
    Reference() = default;
    explicit Reference(T* object) : object_(object) {
        if (object_ != nullptr) object_->retain();
    }
    Reference(const Reference& other) : Reference(other.object_) {}
    Reference(Reference&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
    Reference& operator=(Reference other) noexcept {
        std::swap(object_, other.object_);
        return *this;
    }
    ~Reference() {
        if (object_ != nullptr) object_->release();
    }
    /// Adopts the initial reference of `object`.
    static Reference adopt(T* object) {
        Reference reference;
        reference.object_ = object;
        return reference;
    }
    [[nodiscard]] T* get() const { return object_; }
    T* operator->() const { return object_; }
    explicit operator bool() const { return object_ != nullptr; }

  private:
    T* object_ = nullptr;
};

/// An error with an AlhazenError code.
class CodedError : public std::runtime_error {
  public:
    CodedError(AlhazenError code, const std::string& text)
        : std::runtime_error(text), code_(code) {}
    [[nodiscard]] AlhazenError code() const { return code_; }

  private:
    AlhazenError code_;
};

inline void need(bool holds, AlhazenError code, const char* text) {
    if (!holds) throw CodedError(code, text);
}
inline void need_argument(bool holds, const char* text) {
    need(holds, ALHAZEN_ERROR_INVALID_ARGUMENT, text);
}

class Device;
/// Records the current exception as an error of this thread, and calls the device's error function.
void note_error(Device* device) noexcept;

/// Runs `work`. An exception becomes an error of the device, and `otherwise` is returned.
template <class Result, class Work>
Result guarded(Device* device, Result otherwise, const Work& work) noexcept {
    try {
        return work();
    } catch (...) {
        note_error(device);
        return otherwise;
    }
}
template <class Work>
void guarded(Device* device, const Work& work) noexcept {
    try {
        work();
    } catch (...) {
        note_error(device);
    }
}

class Device final : public Counted {
  public:
    /// Throws CodedError for an unknown key or value.
    explicit Device(const char* config);

    /// Calls the memory monitor; false if it refuses.
    bool tell_memory(std::int64_t bytes, bool post) const;

    std::uint64_t number = 0;  ///< unique in the process
    int threads = 0;
    TracerOptions options;
    AlhazenErrorFunction error_function = nullptr;
    void* error_pointer = nullptr;
    AlhazenMemoryMonitorFunction memory_function = nullptr;
    void* memory_pointer = nullptr;
};

/// Memory behind an AlhazenBuffer: allocated, or the caller's.
class Memory final : public Counted {
  public:
    /// Throws CodedError if there is not enough memory.
    Memory(Device* owner, std::size_t size);
    Memory(Device* owner, void* shared, std::size_t size)
        : device(owner), begin(static_cast<std::byte*>(shared)), bytes(size) {}

    Reference<Device> device;
    std::byte* begin = nullptr;
    std::size_t bytes = 0;

  private:
    std::vector<std::byte> own_;
};

/// The items of one buffer of a geometry.
struct Buffer {
    AlhazenFormat format = ALHAZEN_FORMAT_FLOAT3;
    const std::byte* begin = nullptr;
    std::size_t stride = 0, count = 0;
    Reference<Memory> memory;  ///< null: the caller's (alhazenSetSharedGeometryBuffer)

    /// Component `k` of item `i`, for formats of floats or doubles.
    [[nodiscard]] double real(std::size_t i, std::size_t k) const;
    [[nodiscard]] std::uint32_t whole(std::size_t i, std::size_t k) const;
};

class Scene;

class Geometry final : public Counted {
  public:
    Geometry(Device* owner, AlhazenGeometryType kind) : device(owner), type(kind) {}

    /// The buffer of a type. Throws CodedError if the geometry has none of the type.
    Buffer& buffer(AlhazenBufferType wanted, unsigned slot);

    Reference<Device> device;
    AlhazenGeometryType type;
    Buffer index, vertex;
    Affine transform;
    Reference<Scene> instanced;
    std::vector<Scene*> holders;  ///< scenes that an instance is attached to, once for each id
    RayMask mask = kAllRays;
    void* user_pointer = nullptr;
    bool enabled = true, committed = false;
};

/// The result of a commit.
struct Built {
    struct Origin {
        unsigned geometry = ALHAZEN_INVALID_ID;  ///< id in the scene
        unsigned primitive = 0;                  ///< number of the sphere
        std::shared_ptr<const Built> instanced;  ///< for an instance
    };
    std::optional<Tracer> tracer;
    std::vector<Origin> origins;  ///< [GeometryId]
    bool has_instances = false;
    std::int64_t bytes = 0;
};

/// Guards the links between geometries and scenes of all devices: `Scene::geometries`,
/// `Geometry::instanced`, `Geometry::holders`. While it is held, nothing is released, and no
/// function of the caller runs.
std::mutex& structure_mutex();

class Scene final : public Counted {
  public:
    explicit Scene(Device* owner) : device(owner) {}
    ~Scene() override;

    /// Throws CodedError for an id in use, and for an instance of a scene that contains this one.
    void attach(unsigned id, Geometry& geometry);
    /// Attaches with the smallest free id, which it returns.
    unsigned attach(Geometry& geometry);
    void detach(unsigned id);
    /// True if the scene is `other` or contains instances of it at any depth. Requires
    /// structure_mutex().
    [[nodiscard]] bool reaches(const Scene* other) const;

    /// `join`: waits for a commit of another thread, which is otherwise an error.
    void commit(bool join);

    Reference<Device> device;
    std::map<unsigned, Reference<Geometry>> geometries;
    AlhazenProgressMonitorFunction progress = nullptr;
    void* progress_pointer = nullptr;
    std::optional<BuildQuality> quality;
    AlhazenSceneFlags flags = ALHAZEN_SCENE_FLAG_NONE;
    std::shared_ptr<const Built> built;

  private:
    void attach_locked(unsigned id, Geometry& geometry);
    void build();
    void tell(double done) const;

    unsigned first_free_ = 0;         ///< all lower ids are in use
    std::size_t instance_count_ = 0;  ///< number of instances in `geometries`
    std::mutex commit_mutex_;
    std::condition_variable commit_ended_;
    std::optional<std::thread::id> committing_;
};

inline Device* object(AlhazenDevice handle) {
    return reinterpret_cast<Device*>(handle);
}
inline Geometry* object(AlhazenGeometry handle) {
    return reinterpret_cast<Geometry*>(handle);
}
inline Scene* object(AlhazenScene handle) {
    return reinterpret_cast<Scene*>(handle);
}
inline Memory* object(AlhazenBuffer handle) {
    return reinterpret_cast<Memory*>(handle);
}
/// The device of an object, which may be null.
template <class Object>
Device* device_of(const Object* object) {
    return object != nullptr ? object->device.get() : nullptr;
}
/// The same with a reference of its own, for work that may release the object.
template <class Object>
Reference<Device> held_device_of(const Object& object) {
    object.device->retain();
    return Reference<Device>::adopt(object.device.get());
}

}  // namespace alhazen::capi
