#pragma once
/// Lines that meet the surface of a solid, without the surfaces between media inside it.
///
/// Conventions: those of IsolatedSolid; directions that are named unit vectors have length 1.
/// Threads: used by one thread.

#include <span>
#include <vector>

#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

class SurfaceLine {
  public:
    using SurfacePoint = IsolatedSolid::SurfacePoint;

    /// The solid must outlive the object.
    explicit SurfaceLine(const IsolatedSolid& solid) : solid_(solid) {}

    /// The crossings between two t, ascending, until the next call of a function.
    const std::vector<SurfacePoint>& cross(const Vec3& from, const Vec3& along, double t_min,
                                           double t_max, bool with_hits = false);
    /// The hit of a crossing that the last call of `cross` with `with_hits` found.
    [[nodiscard]] const Hit& hit(std::size_t k) const { return hits_[k]; }
    /// The parts of the whole line inside the solid, until the next call of a function.
    const std::vector<Interval>& spans(const Vec3& from, const Vec3& along);
    bool inside(const Vec3& p);

    /// Distance along a unit vector, in either direction, to the surface; infinite beyond `limit`.
    double distance(const Vec3& from, const Vec3& along, double limit);
    /// True if the surface is within `limit` of a point along the unit vector `face` or one of
    /// seven others: near an edge the normal may miss the surface.
    bool is_near(const Vec3& p, const Vec3& face, double limit);
    /// True if the surface, seen from the side that the unit vector `face` points to, is within
    /// `limit` of a point along one of these vectors.
    bool faces(const Vec3& p, const Vec3& face, double limit);
    /// True if the surface is within `limit` of the middle of a part of a line, along a unit
    /// vector.
    bool is_thin(const Vec3& from, const Vec3& along, const Interval& part, double limit);

  private:
    const IsolatedSolid& solid_;
    std::vector<SurfacePoint> found_;
    std::vector<Hit> hits_;
    LineSpans line_;
};

}  // namespace alhazen
