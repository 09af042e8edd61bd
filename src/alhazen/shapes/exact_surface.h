#pragma once
/// A placed shape prepared for nearest-point queries.
///
/// Source: clipped_region.h for quadrics and solids bounded by planes, flat_region.h for polygons.
/// The nearest point of a torus follows from its circle; that of a cylinder or cone that is not
/// stretched from line segments in the plane through its axis and the query point.
/// Differs: placements may be any affine transform, which preserves quadrics and planes though not
/// nearest points; a torus requires a similarity transform.
/// ADD A SHAPE HERE: a branch of `refusal_of` and an overload of `PieceMaker::add` in
/// exact_surface_pieces.cpp.
/// Conventions: points and normals are in world space; normals are outward for closed shapes. The
/// error of a distance is some roundings of the largest coordinate, including that of the query
/// point (tests/unit/shapes/nearest_test.cpp). It is larger for obliquely stretched cones and
/// hyperboloids and for quadrics with mixed terms, by the squared ratio of their longest to their
/// shortest axis; the former are refused beyond 1e5.
/// Threads: const functions may be called concurrently.

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "alhazen/geometry/placement.h"
#include "alhazen/shapes/nearest/flat_region.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

/// Why nearest points of a shape are not supported; empty if they are.
[[nodiscard]] std::string nearest_refusal(const AnyShape& shape, const Affine& world_from_shape);

class ExactSurface {
  public:
    /// Precondition: the shape is prepared and not refused.
    ExactSurface(const AnyShape& shape, const Placement& world);

    /// The nearest point; `from` must be finite.
    [[nodiscard]] PointOnSurface nearest(const Vec3& from) const;
    /// Memory, including heap allocations.
    [[nodiscard]] std::size_t bytes() const;

  private:
    friend class PieceMaker;
    struct Ball {
        Vec3 center;
        double radius = 1;
    };
    struct Ring {
        Vec3 center, axis;
        double major = 1, minor = 0.25;
    };
    /// A cylinder or a frustum of a cone.
    struct Spindle {
        Vec3 center, axis;
        double half_height = 1, base_radius = 1, top_radius = 1;
        bool capped = true;
        bool hollow = false;  ///< the normals point to the axis
    };
    struct Wall {
        Vec3 point, normal;
    };
    // Allocated separately because of their size: there may be very many balls.
    struct Clipped {
        Vec3 origin;
        std::shared_ptr<const ClippedRegion> region;
        bool hollow = false;  ///< the normals point to where f < 0
    };
    /// The part of a plane inside the first region and outside the second, which may be null.
    struct Annulus {
        Vec3 origin;
        std::shared_ptr<const ClippedRegion> outer, hole;
    };
    struct Flat {
        std::shared_ptr<const FlatRegion> region;
    };
    using Piece = std::variant<Ball, Ring, Spindle, Wall, Clipped, Annulus, Flat>;

    [[nodiscard]] static std::optional<PointOnSurface> nearest_of(const Ball& ball,
                                                                  const Vec3& from);
    [[nodiscard]] static std::optional<PointOnSurface> nearest_of(const Ring& ring,
                                                                  const Vec3& from);
    [[nodiscard]] static std::optional<PointOnSurface> nearest_of(const Spindle& spindle,
                                                                  const Vec3& from);
    [[nodiscard]] static std::optional<PointOnSurface> nearest_of(const Wall& wall,
                                                                  const Vec3& from);
    [[nodiscard]] static std::optional<PointOnSurface> nearest_of(const Clipped& clipped,
                                                                  const Vec3& from);
    [[nodiscard]] static std::optional<PointOnSurface> nearest_of(const Annulus& annulus,
                                                                  const Vec3& from);
    [[nodiscard]] static std::optional<PointOnSurface> nearest_of(const Flat& flat,
                                                                  const Vec3& from) {
        return flat.region->nearest(from);
    }

    std::vector<Piece> pieces_;
};

}  // namespace alhazen
