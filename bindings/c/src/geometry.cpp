#include <cstring>

#include "handles.h"

namespace alhazen::capi {

namespace {

std::size_t size_of(AlhazenFormat format) {
    switch (format) {
        case ALHAZEN_FORMAT_UINT3:
        case ALHAZEN_FORMAT_FLOAT3:
            return 12;
        case ALHAZEN_FORMAT_FLOAT4:
            return 16;
        case ALHAZEN_FORMAT_DOUBLE3:
            return 24;
        case ALHAZEN_FORMAT_DOUBLE4:
            return 32;
        default:
            return 0;
    }
}

bool is_double(AlhazenFormat format) {
    return format == ALHAZEN_FORMAT_DOUBLE3 || format == ALHAZEN_FORMAT_DOUBLE4;
}

/// Throws unless a buffer of the geometry may have the format.
void check_format(const Geometry& geometry, AlhazenBufferType type, AlhazenFormat format) {
    const bool spheres = geometry.type == ALHAZEN_GEOMETRY_TYPE_SPHERE_POINT;
    if (type == ALHAZEN_BUFFER_TYPE_INDEX) {
        need_argument(format == ALHAZEN_FORMAT_UINT3, "indices have the format UINT3");
    } else if (spheres) {
        need_argument(format == ALHAZEN_FORMAT_FLOAT4 || format == ALHAZEN_FORMAT_DOUBLE4,
                      "spheres have the format FLOAT4 or DOUBLE4");
    } else {
        need_argument(format == ALHAZEN_FORMAT_FLOAT3 || format == ALHAZEN_FORMAT_DOUBLE3,
                      "vertices have the format FLOAT3 or DOUBLE3");
    }
}

Affine affine_of(AlhazenFormat format, const float* m) {
    // Entry (row, column).
    const auto at = [&](int row, int column) -> double {
        switch (format) {
            case ALHAZEN_FORMAT_FLOAT3X4_ROW_MAJOR:
                return m[4 * row + column];
            case ALHAZEN_FORMAT_FLOAT3X4_COLUMN_MAJOR:
                return m[3 * column + row];
            case ALHAZEN_FORMAT_FLOAT4X4_COLUMN_MAJOR:
                return m[4 * column + row];
            default:
                throw CodedError(ALHAZEN_ERROR_INVALID_ARGUMENT,
                                 "a transform has the format FLOAT3X4 or FLOAT4X4_COLUMN_MAJOR");
        }
    };
    const auto column = [&](int c) { return Vec3{at(0, c), at(1, c), at(2, c)}; };
    return {{column(0), column(1), column(2)}, column(3)};
}

/// Writes the matrix in the format.
void write_affine(const Affine& transform, AlhazenFormat format, float* m) {
    const Vec3 columns[] = {transform.linear.x_axis, transform.linear.y_axis,
                            transform.linear.z_axis, transform.translation};
    const bool rows = format == ALHAZEN_FORMAT_FLOAT3X4_ROW_MAJOR;
    const int stride = format == ALHAZEN_FORMAT_FLOAT4X4_COLUMN_MAJOR ? 4 : 3;
    need_argument(rows || stride == 4 || format == ALHAZEN_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                  "a transform has the format FLOAT3X4 or FLOAT4X4_COLUMN_MAJOR");
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            m[rows ? 4 * row + column : stride * column + row] =
                static_cast<float>(columns[column][row]);
        }
        if (stride == 4 && !rows) m[4 * column + 3] = column == 3 ? 1.0f : 0.0f;
    }
}

/// Runs `work` with the geometry, which must not be null.
template <class Work>
void with_geometry(AlhazenGeometry handle, const Work& work) {
    Geometry* geometry = object(handle);
    if (geometry == nullptr) {
        return guarded(nullptr, [] { need_argument(false, "the geometry is NULL"); });
    }
    // Releasing the scene of an instance calls a monitor, which may release the geometry.
    const Reference<Device> device = held_device_of(*geometry);
    guarded(device.get(), [&] { work(*geometry); });
}

/// Replaces a buffer. Throws CodedError for one that the geometry cannot have.
void set_buffer(Geometry& geometry, AlhazenBufferType type, unsigned slot, Buffer next) {
    Buffer& buffer = geometry.buffer(type, slot);
    check_format(geometry, type, next.format);
    need_argument(next.stride >= size_of(next.format) || next.count <= 1,
                  "byteStride is less than an item");
    buffer = std::move(next);
}

}  // namespace

double Buffer::real(std::size_t i, std::size_t k) const {
    const std::byte* item = begin + i * stride;
    if (is_double(format)) {
        double value;
        std::memcpy(&value, item + 8 * k, 8);
        return value;
    }
    float value;
    std::memcpy(&value, item + 4 * k, 4);
    return value;
}

std::uint32_t Buffer::whole(std::size_t i, std::size_t k) const {
    std::uint32_t value;
    std::memcpy(&value, begin + i * stride + 4 * k, 4);
    return value;
}

Buffer& Geometry::buffer(AlhazenBufferType wanted, unsigned slot) {
    need_argument(slot == 0, "there is one slot, 0");
    need_argument(wanted == ALHAZEN_BUFFER_TYPE_VERTEX || wanted == ALHAZEN_BUFFER_TYPE_INDEX,
                  "a buffer is of type VERTEX or INDEX");
    need(type != ALHAZEN_GEOMETRY_TYPE_INSTANCE, ALHAZEN_ERROR_INVALID_OPERATION,
         "an instance has no buffers");
    need(wanted == ALHAZEN_BUFFER_TYPE_VERTEX || type == ALHAZEN_GEOMETRY_TYPE_TRIANGLE,
         ALHAZEN_ERROR_INVALID_OPERATION, "spheres have no indices");
    return wanted == ALHAZEN_BUFFER_TYPE_VERTEX ? vertex : index;
}

}  // namespace alhazen::capi

using namespace alhazen::capi;

AlhazenGeometry alhazenNewGeometry(AlhazenDevice device, AlhazenGeometryType type) {
    return guarded(object(device), static_cast<AlhazenGeometry>(nullptr), [&] {
        need_argument(device != nullptr, "the device is NULL");
        need_argument(type == ALHAZEN_GEOMETRY_TYPE_TRIANGLE ||
                          type == ALHAZEN_GEOMETRY_TYPE_SPHERE_POINT ||
                          type == ALHAZEN_GEOMETRY_TYPE_INSTANCE,
                      "a geometry is of type TRIANGLE, SPHERE_POINT or INSTANCE");
        return reinterpret_cast<AlhazenGeometry>(new Geometry(object(device), type));
    });
}
void alhazenRetainGeometry(AlhazenGeometry geometry) {
    if (geometry != nullptr) object(geometry)->retain();
}
void alhazenReleaseGeometry(AlhazenGeometry geometry) {
    if (geometry != nullptr) object(geometry)->release();
}

void alhazenSetGeometryBuffer(AlhazenGeometry geometry, AlhazenBufferType type, unsigned int slot,
                              AlhazenFormat format, AlhazenBuffer buffer, size_t byteOffset,
                              size_t byteStride, size_t itemCount) {
    with_geometry(geometry, [&](Geometry& g) {
        need_argument(buffer != nullptr, "the buffer is NULL");
        Memory& memory = *object(buffer);
        const std::size_t item = size_of(format);
        need_argument(itemCount == 0 ||
                          (byteOffset <= memory.bytes && item <= memory.bytes - byteOffset &&
                           (itemCount == 1 ||
                            byteStride <= (memory.bytes - byteOffset - item) / (itemCount - 1))),
                      "the items reach beyond the buffer");
        set_buffer(
            g, type, slot,
            {format, memory.begin + byteOffset, byteStride, itemCount, Reference<Memory>(&memory)});
    });
}
void alhazenSetSharedGeometryBuffer(AlhazenGeometry geometry, AlhazenBufferType type,
                                    unsigned int slot, AlhazenFormat format, const void* ptr,
                                    size_t byteOffset, size_t byteStride, size_t itemCount) {
    with_geometry(geometry, [&](Geometry& g) {
        need_argument(ptr != nullptr || itemCount == 0, "the memory of a buffer is NULL");
        const auto* begin = static_cast<const std::byte*>(ptr);
        set_buffer(
            g, type, slot,
            {format, ptr != nullptr ? begin + byteOffset : nullptr, byteStride, itemCount, {}});
    });
}
void* alhazenSetNewGeometryBuffer(AlhazenGeometry geometry, AlhazenBufferType type,
                                  unsigned int slot, AlhazenFormat format, size_t byteStride,
                                  size_t itemCount) {
    void* begin = nullptr;
    with_geometry(geometry, [&](Geometry& g) {
        need_argument(byteStride >= size_of(format), "byteStride is less than an item");
        // Room for one item more: callers may write a float3 as 16 bytes.
        need(byteStride == 0 || itemCount < SIZE_MAX / byteStride - 1, ALHAZEN_ERROR_OUT_OF_MEMORY,
             "the buffer is too large");
        auto memory =
            Reference<Memory>::adopt(new Memory(g.device.get(), (itemCount + 1) * byteStride));
        std::byte* const own = memory->begin;
        set_buffer(g, type, slot, {format, own, byteStride, itemCount, std::move(memory)});
        begin = own;
    });
    return begin;
}

void* alhazenGetGeometryBufferData(AlhazenGeometry geometry, AlhazenBufferType type,
                                   unsigned int slot) {
    void* memory = nullptr;
    with_geometry(geometry, [&](Geometry& g) {
        memory = const_cast<std::byte*>(g.buffer(type, slot).begin);
    });
    return memory;
}
void alhazenUpdateGeometryBuffer(AlhazenGeometry geometry, AlhazenBufferType type,
                                 unsigned int slot) {
    // Only checks the arguments: a commit reads every buffer again.
    with_geometry(geometry, [&](Geometry& g) { (void)g.buffer(type, slot); });
}
void alhazenSetGeometryMask(AlhazenGeometry geometry, unsigned int mask) {
    with_geometry(geometry, [&](Geometry& g) { g.mask = mask; });
}
void alhazenSetGeometryUserData(AlhazenGeometry geometry, void* userPtr) {
    with_geometry(geometry, [&](Geometry& g) { g.user_pointer = userPtr; });
}
void* alhazenGetGeometryUserData(AlhazenGeometry geometry) {
    return geometry != nullptr ? object(geometry)->user_pointer : nullptr;
}

void alhazenSetGeometryBuildQuality(AlhazenGeometry geometry, AlhazenBuildQuality) {
    with_geometry(geometry, [](Geometry&) {});
}
void alhazenSetGeometryTimeStepCount(AlhazenGeometry geometry, unsigned int timeStepCount) {
    with_geometry(geometry, [&](Geometry&) {
        need_argument(timeStepCount == 1, "there is one time step: nothing moves");
    });
}

void alhazenSetGeometryInstancedScene(AlhazenGeometry geometry, AlhazenScene scene) {
    with_geometry(geometry, [&](Geometry& g) {
        need(g.type == ALHAZEN_GEOMETRY_TYPE_INSTANCE, ALHAZEN_ERROR_INVALID_OPERATION,
             "only an instance has a scene");
        need_argument(scene != nullptr, "the scene is NULL");
        Reference<Scene> next(object(scene));  // releases the previous one after the mutex
        const std::lock_guard lock(structure_mutex());
        for (const Scene* holder : g.holders) {
            need(!next->reaches(holder), ALHAZEN_ERROR_INVALID_OPERATION,
                 "the scene holds the instance: a scene cannot be an instance in itself");
        }
        std::swap(g.instanced, next);
    });
}
void alhazenSetGeometryTransform(AlhazenGeometry geometry, unsigned int timeStep,
                                 AlhazenFormat format, const void* xfm) {
    with_geometry(geometry, [&](Geometry& g) {
        need(g.type == ALHAZEN_GEOMETRY_TYPE_INSTANCE, ALHAZEN_ERROR_INVALID_OPERATION,
             "only an instance has a transform");
        need_argument(timeStep == 0, "there is one time step, 0");
        need_argument(xfm != nullptr, "the transform is NULL");
        g.transform = affine_of(format, static_cast<const float*>(xfm));
    });
}
void alhazenGetGeometryTransform(AlhazenGeometry geometry, float, AlhazenFormat format, void* xfm) {
    with_geometry(geometry, [&](Geometry& g) {
        need(g.type == ALHAZEN_GEOMETRY_TYPE_INSTANCE, ALHAZEN_ERROR_INVALID_OPERATION,
             "only an instance has a transform");
        need_argument(xfm != nullptr, "the transform is NULL");
        write_affine(g.transform, format, static_cast<float*>(xfm));
    });
}
void alhazenEnableGeometry(AlhazenGeometry geometry) {
    with_geometry(geometry, [](Geometry& g) { g.enabled = true; });
}
void alhazenDisableGeometry(AlhazenGeometry geometry) {
    with_geometry(geometry, [](Geometry& g) { g.enabled = false; });
}
void alhazenCommitGeometry(AlhazenGeometry geometry) {
    with_geometry(geometry, [](Geometry& g) { g.committed = true; });
}
