#pragma once
/// An algebraic surface: the zeros of a polynomial in x, y and z of degree at most 12, within a
/// box; as a solid, the part of the box where the polynomial is negative.
///
/// Source: Hanrahan, "Ray Tracing Algebraic Surfaces", SIGGRAPH 1983; polynomial_solid.h.
/// Differs: as in polynomial_solid.h.
/// Conventions: part 0 is the surface, 1 to 6 are the faces -x +x -y +y -z +z of the box, which
/// close the solid where f < 0. Normals point along the gradient; at a singular point (a node) the
/// normal is that of a nearby point. u runs around the z axis through the centre of the box (0 to
/// 1), v is the angle from there above the xy plane, from -z (0) to +z (1); for faces see
/// clipped_quadric.h.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "alhazen/shapes/algebraic/polynomial_expression.h"

namespace alhazen {

struct LaneSurfaces;

struct Algebraic {
    static constexpr const char* kName = "algebraic";
    static constexpr int kMaxHits = PolynomialExpression::kMaxDegree + 2;
    static constexpr bool kClosed = true;

    std::string expression = "x^2 + y^2 + z^2 - 1";  ///< see polynomial_expression.h
    Box3 clip_box{{-2, -2, -2}, {2, 2, 2}};
    bool capped = true;                                        ///< closed by the faces of the box
    std::shared_ptr<const PolynomialExpression> polynomial{};  ///< derived
    double magnitude = 1, roundings = 1, size = 1;             ///< derived: for error bounds

    static constexpr auto kFields =
        std::make_tuple(field("expression", &Algebraic::expression, Unit::Text, Check::Shape),
                        field("clip_box", &Algebraic::clip_box, Unit::Compound, Check::Shape),
                        optional_field("capped", &Algebraic::capped, Unit::Flag, Check::None));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return capped; }
    [[nodiscard]] Box3 box() const { return clip_box; }
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

/// The first crossing (shapes/core/first_hit.h).
[[nodiscard]] bool first_hit(const Algebraic& shape, const Ray& ray, ShapeHit& hit);
/// The first crossings of a packet (shapes/core/first_hits.h).
[[nodiscard]] std::uint32_t first_hits(const Algebraic& shape, std::span<const Ray* const> rays,
                                       ShapeHit* hits);
/// Surfaces in lanes (shapes/core/lane_surfaces.h).
[[nodiscard]] std::uint32_t lane_surfaces(const Algebraic& shape, std::uint32_t wanted,
                                          LaneSurfaces& lanes);
/// The surface without texture coordinates (shapes/core/plain_surface.h).
[[nodiscard]] ShapeSurface plain_surface(const Algebraic& shape, const Ray& ray,
                                         const ShapeHit& hit);

}  // namespace alhazen
