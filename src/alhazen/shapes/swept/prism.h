#pragma once
/// A profile of lines and cubic curves swept along z, straight or towards an apex.
///
/// Source: Kajiya, "New Techniques for Ray Tracing Procedurally Defined Objects", SIGGRAPH 1983
/// (prisms: the ray in the plane of the profile).
/// Differs: also tapered: the size of the section is linear in the height, and a ray's plane
/// through the apex intersects the plane of the profile in a line. The crossings of that line with
/// a curve are the sign changes of a cubic, isolated with certainty (math/bernstein_roots.h); the
/// crossings with all loops, taken odd-even, form spans, which are clipped by the two ends. So a
/// line crosses the solid an even number of times by construction.
/// Conventions: the section at height z is the profile times 1 + (top_scale - 1) (z - h0) / (h1 -
/// h0). part 0 the end at h0, 1 the end at h1, 2 + i the side along curve i. On sides u runs around
/// all curves (0 to 1), v along the height; on ends uv are the profile's coordinates (of h0). A
/// line in the plane of an end or side is inside or outside by `keeps_face`. Loops may cross;
/// inside is then odd-even. Complexity: O(curves) per ray.

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/swept/profile.h"

namespace alhazen {

struct Prism {
    static constexpr const char* kName = "prism";
    static constexpr int kMaxHits = kManyHits;
    static constexpr bool kClosed = true;

    Profile profile{};  ///< in the plane z = h0; its loops close
    double h0 = 0, h1 = 1;
    double top_scale = 1;  ///< size at h1; 0 is an apex

    double growth = 0;  ///< derived: derivative of the size by the height
    double reach = 0;   ///< derived: largest coordinate of the profile
    Vec3 center{};      ///< derived
    double radius = 1;  ///< derived: of a sphere about the center that contains the prism

    static constexpr auto kFields =
        std::make_tuple(field("profile", &Prism::profile, Unit::Compound, Check::Shape),
                        field("h0", &Prism::h0, Unit::Length, Check::Shape),
                        field("h1", &Prism::h1, Unit::Length, Check::Shape),
                        optional_field("top_scale", &Prism::top_scale, Unit::Number, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    void intersect(const Ray& ray, ShapeHits& hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;

  private:
    [[nodiscard]] ShapeSurface side_surface(const Ray& ray, const ShapeHit& hit) const;
    [[nodiscard]] ShapeSurface end_surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
