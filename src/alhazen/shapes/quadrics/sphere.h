#pragma once
/// A sphere.
///
/// Source: Foley, van Dam et al., "Computer Graphics", eq. 15.12-15.17; Haines, Günther and
/// Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019,
/// ch. 7.
/// Differs: the direction need not be unit.
/// Conventions: u runs around the z axis from +x (0 to 1), v from the -z pole (0) to the +z pole
/// (1).

#include <cstdint>
#include <span>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct Sphere {
    static constexpr const char* kName = "sphere";
    static constexpr int kMaxHits = 2;
    static constexpr bool kClosed = true;

    Vec3 center{0, 0, 0};
    double radius = 1;

    static constexpr auto kFields =
        std::make_tuple(field("center", &Sphere::center, Unit::Point, Check::Point),
                        field("radius", &Sphere::radius, Unit::Length, Check::Length));

    void prepare() {}
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

/// The first crossings of a packet (shapes/core/first_hits.h).
[[nodiscard]] std::uint32_t first_hits(const Sphere& shape, std::span<const Ray* const> rays,
                                       ShapeHit* hits);
/// The first crossings of the rays of a set that is already in lanes; one hit per lane.
[[nodiscard]] std::uint32_t first_hits(const Sphere& shape, const RayLanes& rays,
                                       std::uint32_t wanted, ShapeHit* hits);
/// The surface without texture coordinates (shapes/core/plain_surface.h).
[[nodiscard]] ShapeSurface plain_surface(const Sphere& shape, const Ray& ray, const ShapeHit& hit);

}  // namespace alhazen
