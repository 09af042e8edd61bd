#pragma once
/// The kernel of all quadric shapes: a quadric in a local frame, clipped by a box in that frame and
/// by planes, with or without caps.
///
/// Source: Foley, van Dam et al., "Computer Graphics", section 15.10.1; Roth 1982 (see
/// solid_frame.h).
/// Differs: intersects the at most two intervals of the quadric with that of the clip, so a line
/// crosses the closed surface an even number of times by construction.
/// Conventions: part 0 the quadric, 1 to 6 the faces of the box, 7 and above the planes. u runs
/// around the frame's z axis from its x axis; v along z, from 0 to 1 through `v_range`. On the
/// faces across z, v runs from the axis (0) to the distance 1 in the frame; on other faces uv are
/// the other two coordinates. Open ends: crossings outside the clip are omitted.

#include "alhazen/shapes/quadrics/quadric_line.h"

namespace alhazen {

struct ClippedQuadric {
    static constexpr int kMaxHits = 4;

    enum class V {
        Height,    ///< v along the frame's z axis
        Latitude,  ///< v by the angle above the frame's xy plane, from -z (0) to +z (1)
    };

    SolidFrame frame;
    QuadricLine quadric;
    Box3 clip_box{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
    std::vector<ClipPlane> planes;  ///< in the local frame
    bool capped = true;
    V v_kind = V::Height;
    Interval v_range{0, 1};
    double least_slope = 0;  ///< see set_uv

    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
    /// True if the line is inside at t = -infinity.
    [[nodiscard]] bool inside_at_minus_infinity(const Ray& ray) const;

  private:
    [[nodiscard]] ShapeSurface side_surface(const Vec3& p, const Vec3& before) const;
    [[nodiscard]] bool has_clip() const;
};

/// Surface on a face of a clip: `p` in the frame, projected to the face; uv as in the conventions
/// above.
[[nodiscard]] ShapeSurface clip_face_surface(const SolidFrame& frame, const Box3& clip_box,
                                             const std::vector<ClipPlane>& planes, Vec3 p,
                                             std::uint32_t part);

/// Cuts the line by the box and all planes; returns false when nothing is left.
[[nodiscard]] bool cut_by_clip(const SolidFrame& frame, const Vec3& o, const Vec3& d,
                               const Box3& box, const std::vector<ClipPlane>& planes,
                               ClipRange& range);

}  // namespace alhazen
