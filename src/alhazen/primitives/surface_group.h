#pragma once
/// The points and normals of up to sixteen hits in lanes, for renderers that need no more of a
/// surface.
///
/// Source: `set_surface`, the same operations in the same order.
/// Conventions: each lane has the values of `set_surface` (zeros may differ in sign), or is left to
/// it. Hits inside at most one instance, on part 0 of shapes that have surfaces in lanes
/// (shapes/core/lane_surfaces.h), of spheres, cylinders and cones; no motion, no media.
/// Threads: a group is used by one thread.

#include <cstdint>

#include "alhazen/geometry/hit.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/shapes/quadrics/round_surfaces.h"

namespace alhazen {

/// What the surface of a primitive is computed from, the same for all its hits.
struct SurfaceSource {
    enum class Kind : std::uint8_t { None, Sphere, Side, OneShape };
    static constexpr std::size_t kKinds = 4;

    Kind kind = Kind::None;  ///< None: not in lanes
    bool in_place = false;   ///< of an instance whose placement is the identity
    bool turned = false;     ///< the normal is reversed
    MaterialId material{0};
    const void* shape = nullptr;
    const Placement* own = nullptr;       ///< of the shape; null: none
    const Placement* instance = nullptr;  ///< of the instance around it; null: none, or in place
    /// OneShape: sets the surfaces of one shape.
    std::uint32_t (*find)(const void* shape, std::uint32_t wanted, LaneSurfaces& lanes) = nullptr;
};

/// The source of the primitive of a hit.
[[nodiscard]] SurfaceSource surface_source(const Aggregate& aggregate, const Hit& hit);

class SurfaceGroup {
  public:
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] bool full() const { return count_ == kSurfaceLanes; }
    [[nodiscard]] std::size_t size() const { return count_; }
    /// True if a hit of the source may be added.
    [[nodiscard]] bool takes(const SurfaceSource& source) const {
        if (count_ == 0) return true;
        return source.kind == first_.kind && source.in_place == first_.in_place &&
               source.own == first_.own && source.instance == first_.instance &&
               (source.kind != SurfaceSource::Kind::OneShape || source.shape == first_.shape);
    }
    /// Adds a hit on part 0; returns its lane. Precondition: `takes(source)` and not full.
    std::size_t add(const SurfaceSource& source, const Ray& ray, const ShapeHit& hit) {
        const std::size_t lane = count_++;
        if (lane == 0) first_ = source;
        if (source.own == nullptr && source.instance == nullptr) {
            surfaces_.set(lane, ray, hit);
        } else {
            set_placed(lane, source, ray, hit);
        }
        if (source.kind == SurfaceSource::Kind::Sphere) {
            spheres_.set(lane, *static_cast<const Sphere*>(source.shape));
        } else if (source.kind == SurfaceSource::Kind::Side) {
            frusta_.set(lane, *static_cast<const Frustum*>(source.shape));
        }
        return lane;
    }
    /// Sets the surfaces; returns the lanes that are set.
    std::uint32_t find();
    void clear() { count_ = 0; }

    /// As the shapes have them: not reversed.
    [[nodiscard]] const LaneSurfaces& surfaces() const { return surfaces_; }
    /// True if the rays of `surfaces` are those added.
    [[nodiscard]] bool in_world() const {
        return first_.own == nullptr && first_.instance == nullptr;
    }
    [[nodiscard]] ShapeHit hit(std::size_t lane) const {
        return {surfaces_.t[lane], 0, surfaces_.v[lane], 0};
    }

  private:
    void set_placed(std::size_t lane, const SurfaceSource& source, const Ray& ray,
                    const ShapeHit& hit);

    SurfaceSource first_;
    std::size_t count_ = 0;
    LaneSurfaces surfaces_;
    SphereLanes spheres_;
    FrustumLanes frusta_;
};

}  // namespace alhazen
