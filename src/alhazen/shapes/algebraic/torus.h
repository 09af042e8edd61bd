#pragma once
/// A torus: a tube around a circle.
///
/// Source: Hanrahan, "Ray Tracing Algebraic Surfaces", SIGGRAPH 1983 (the quartic);
/// polynomial_solid.h.
/// Differs: computed in a frame where the circle has radius 1, as (|p|^2 + 1 - r^2)^2 - 4 (x^2 +
/// y^2), whose Bernstein coefficients follow from the dot products of the ends of the line's
/// segment.
/// Conventions: u runs around the axis (0 to 1), v around the tube from its outermost circle (0)
/// towards the direction of the axis.

#include <cstdint>
#include <span>

#include "alhazen/shapes/core/solid_frame.h"

namespace alhazen {

struct LaneSurfaces;

struct Torus {
    static constexpr const char* kName = "torus";
    static constexpr int kMaxHits = 4;
    static constexpr bool kClosed = true;

    Vec3 center{0, 0, 0};
    Vec3 axis{0, 0, 1};
    double major_radius = 1;     ///< radius of the circle
    double minor_radius = 0.25;  ///< radius of the tube; at most the major radius
    SolidFrame frame{};          ///< derived
    Vec3 unit_axis{0, 0, 1};     ///< derived
    double tube = 0.25;          ///< derived: minor over major radius

    static constexpr auto kFields =
        std::make_tuple(field("center", &Torus::center, Unit::Point, Check::Point),
                        field("axis", &Torus::axis, Unit::Direction, Check::Vector),
                        field("major_radius", &Torus::major_radius, Unit::Length, Check::Length),
                        field("minor_radius", &Torus::minor_radius, Unit::Length, Check::Length));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

/// The first crossing (shapes/core/first_hit.h).
[[nodiscard]] bool first_hit(const Torus& shape, const Ray& ray, ShapeHit& hit);
/// The first crossings of a packet (shapes/core/first_hits.h).
[[nodiscard]] std::uint32_t first_hits(const Torus& shape, std::span<const Ray* const> rays,
                                       ShapeHit* hits);
/// Surfaces in lanes (shapes/core/lane_surfaces.h).
[[nodiscard]] std::uint32_t lane_surfaces(const Torus& shape, std::uint32_t wanted,
                                          LaneSurfaces& lanes);
/// The surface without texture coordinates (shapes/core/plain_surface.h).
[[nodiscard]] ShapeSurface plain_surface(const Torus& shape, const Ray& ray, const ShapeHit& hit);

}  // namespace alhazen
