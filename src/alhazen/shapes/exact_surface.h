#pragma once
/// A shape where it is placed, for questions about its nearest point.
///
/// Source: clipped_region.h for quadrics and what planes bound, flat_region.h for polygons; a
/// torus is a circle's surroundings; a cylinder or cone that is not stretched is lines in the plane
/// through its axis and the point.
/// Differs: a placement may be any affine transform, under which quadrics and planes stay what they
/// are and nearest points do not; a torus must be placed by one that keeps angles.
/// ADD A SHAPE HERE: a branch of `refusal_of` and an overload of `PieceMaker::add` in
/// exact_surface.cpp.
/// Conventions: points and normals are in space; normals are outward for closed shapes. What is
/// left of the exact distance is some roundings of the largest coordinate
/// (tests/unit/shapes/nearest_test.cpp), that of the point asked from included. Cones and
/// hyperboloids that are stretched aslant, and quadrics with mixed terms, lose more: as many as the
/// squared ratio of their longest to their shortest axis; the former are refused beyond 1e5.
/// Threads: const functions may be called from many.

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "alhazen/geometry/placement.h"
#include "alhazen/shapes/nearest/flat_region.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

/// Why the nearest point of a shape is not known; empty where it is.
[[nodiscard]] std::string nearest_refusal(const AnyShape& shape, const Affine& world_from_shape);

class ExactSurface {
  public:
    /// Precondition: the shape is prepared, and not refused.
    ExactSurface(const AnyShape& shape, const Placement& world);

    /// `from` is finite.
    [[nodiscard]] PointOnSurface nearest(const Vec3& from) const;
    /// With all that it keeps elsewhere.
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
        bool hollow = false;  ///< the normals lead to the axis
    };
    struct Wall {
        Vec3 point, normal;
    };
    // Large ones are kept elsewhere: there may be very many balls.
    struct Clipped {
        Vec3 origin;
        std::shared_ptr<const ClippedRegion> region;
        bool hollow = false;  ///< the normals lead to where f < 0
    };
    /// What a plane cuts out of the first region and leaves of the second, which may be null.
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
