#pragma once
/// The triangles, spheres and cylinders of a benchmark scene in Embree 3.
/// Triangles are triangle meshes and spheres sphere points. Embree has no capped cylinders: they
/// are either linear cone curves or user geometry with callbacks in float (embree_cylinders.h);
/// both are measured.
/// Threads: several threads may trace.

#include <embree3/rtcore.h>

#include <memory>
#include <string>

#include "kernel_scenes.h"

namespace alhazen::bench {

struct EmbreeOptions {
    bool robust = true;  ///< RTC_SCENE_FLAG_ROBUST
    RTCBuildQuality quality = RTC_BUILD_QUALITY_HIGH;
    bool cylinders_are_curves = false;  ///< false: user geometry
    int threads = 0;                    ///< for building; 0: all cores
    std::string isa;                    ///< Embree's instruction set: "avx2"; empty: the best
};

class EmbreeScene {
  public:
    /// Copies the required data from `scene`. Throws Error (Resource) if Embree reports an error.
    EmbreeScene(const KernelScene& scene, const EmbreeOptions& options);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    [[nodiscard]] RTCScene handle() const;
    /// Time of rtcCommitScene alone, in seconds; the buffers are filled before.
    [[nodiscard]] double build_seconds() const;
    /// Bytes that Embree has allocated for the scene, by its memory monitor. Excludes vertices and
    /// indices, which are in shared buffers.
    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen::bench
