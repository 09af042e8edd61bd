#pragma once
/// A blob: the region where the sum of soft balls and rods is at least a threshold.
///
/// Source: Blinn, "A Generalization of Algebraic Surface Drawing", ACM TOG 1(3), 1982; Nishimura et
/// al., "Object modeling by distribution function", 1985; Wyvill, McPheeters and Wyvill, "Data
/// structure for soft objects", The Visual Computer 2, 1986. The density s (1 - r^2 / R^2)^2 within
/// the radius R, r the distance from a point or from a segment, is that of POV-Ray's blobs.
/// Differs: along a ray the sum is a polynomial of degree four between the points where a component
/// begins or ends; it is computed anew in each of these spans, in Bernstein form, with a bound of
/// its error, and all its sign changes are isolated with certainty (math/bernstein_roots.h). A tree
/// finds the components.
/// Conventions: the threshold is positive, so that a blob is bounded; strengths may be negative. uv
/// are directions from the centre of the box, without derivatives.
/// Complexity: O(k log k + sum over the spans of the components there) for k components on the ray.

#include <cstdint>
#include <memory>
#include <span>

#include "alhazen/shapes/blobs/blob_tree.h"
#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct LaneSurfaces;

/// A soft ball about `base`, or a soft rod with round ends from `base` to `top`.
struct BlobComponent {
    Vec3 base{0, 0, 0}, top{0, 0, 0};
    double radius = 1;
    double strength = 1;
    bool rod = false;
};

struct Blob {
    static constexpr const char* kName = "blob";
    static constexpr int kMaxHits = kManyHits;
    static constexpr bool kClosed = true;

    std::vector<BlobComponent> components{};
    double threshold = 0.5;

    std::shared_ptr<const BlobTree> tree{};  ///< derived
    Box3 bounds{};                           ///< derived: of the components
    double reach = 0;                        ///< derived: largest coordinate of the bounds

    static constexpr auto kFields =
        std::make_tuple(field("threshold", &Blob::threshold, Unit::Number, Check::Shape),
                        field("components", &Blob::components, Unit::Compound, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const { return bounds; }
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    void intersect(const Ray& ray, ShapeHits& hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

/// The first crossings of a packet (shapes/core/first_hits.h).
[[nodiscard]] std::uint32_t first_hits(const Blob& shape, std::span<const Ray* const> rays,
                                       ShapeHit* hits);
/// Surfaces in lanes (shapes/core/lane_surfaces.h).
[[nodiscard]] std::uint32_t lane_surfaces(const Blob& shape, std::uint32_t wanted,
                                          LaneSurfaces& lanes);
/// The surface without texture coordinates (shapes/core/plain_surface.h).
[[nodiscard]] ShapeSurface plain_surface(const Blob& shape, const Ray& ray, const ShapeHit& hit);

}  // namespace alhazen
