// Debian's Open3D 0.16.1 sets the masks of its rays to 0. The Embree that Open3D ships ignores
// masks; Debian's honours them and skips all geometry. Loaded before Open3D (RTLD_GLOBAL), these
// functions replace Embree's calls and set all masks.
#include <dlfcn.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace {

using Call = void (*)(void* scene, void* context, void* rays, unsigned count, std::size_t stride);

/// Embree's own function; the library has already been loaded by the caller.
Call embree(const char* name) {
    void* library = dlopen("libembree3.so.3", RTLD_NOW | RTLD_NOLOAD);
    void* symbol = library != nullptr ? dlsym(library, name) : nullptr;
    if (symbol == nullptr) std::abort();
    Call call = nullptr;
    std::memcpy(&call, &symbol, sizeof(call));
    return call;
}

void set_masks(void* rays, unsigned count, std::size_t stride) {
    // In RTCRay the mask follows origin, tnear, direction, time and tfar, nine floats.
    constexpr std::size_t kMask = 9 * sizeof(float);
    constexpr std::uint32_t kAll = 0xFFFFFFFF;
    for (unsigned i = 0; i < count; ++i) {
        std::memcpy(static_cast<char*>(rays) + i * stride + kMask, &kAll, sizeof(kAll));
    }
}

}  // namespace

extern "C" void rtcIntersect1M(void* scene, void* context, void* rays, unsigned count,
                               std::size_t stride) {
    static const Call call = embree("rtcIntersect1M");
    set_masks(rays, count, stride);
    call(scene, context, rays, count, stride);
}

extern "C" void rtcOccluded1M(void* scene, void* context, void* rays, unsigned count,
                              std::size_t stride) {
    static const Call call = embree("rtcOccluded1M");
    set_masks(rays, count, stride);
    call(scene, context, rays, count, stride);
}
