#pragma once
/// The peer: the same triangles and rays in Embree 3, single rays, one thread.

#include <cstddef>
#include <memory>

#include "kernel_rays.h"

namespace alhazen::bench {

class EmbreeTracer {
  public:
    /// Quality high; `robust` sets RTC_SCENE_FLAG_ROBUST.
    EmbreeTracer(const TriangleMesh& mesh, bool robust);
    ~EmbreeTracer();
    EmbreeTracer(const EmbreeTracer&) = delete;
    EmbreeTracer& operator=(const EmbreeTracer&) = delete;

    /// Traces all rays of the set by rtcIntersect1 or rtcOccluded1; the number that hit.
    [[nodiscard]] std::size_t trace(const RaySet& set) const;
    [[nodiscard]] double build_seconds() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen::bench
