#pragma once
/// The same triangles, spheres and cylinders in Embree 3.
/// Triangles are triangle meshes and spheres sphere points. Embree has no capped cylinders: they
/// are either linear cone curves or user geometry with callbacks in float (embree_cylinders.h);
/// both are measured.
/// Threads: tracing from many threads is allowed.

#include <embree3/rtcore.h>

#include <memory>

#include "kernel_scenes.h"

namespace alhazen::bench {

struct EmbreeOptions {
    bool robust = true;  ///< RTC_SCENE_FLAG_ROBUST
    RTCBuildQuality quality = RTC_BUILD_QUALITY_HIGH;
    bool cylinders_are_curves = false;  ///< else user geometry
    int threads = 0;                    ///< for building; 0: all cores
};

class EmbreeScene {
  public:
    /// Copies the data it needs from `scene`. Throws Error (Resource) when Embree reports an error.
    EmbreeScene(const KernelScene& scene, const EmbreeOptions& options);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    [[nodiscard]] RTCScene handle() const;
    /// Time of rtcCommitScene alone; buffers are filled before.
    [[nodiscard]] double build_seconds() const;
    /// Bytes that Embree has allocated for the scene, by its memory monitor. Excludes vertices and
    /// indices, which are shared buffers.
    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen::bench
