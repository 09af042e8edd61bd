#include "alhazen/geometry/polygon/convex_corners.h"

#include <algorithm>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// Half the side of the initial squares, in units of the spread of the planes' points.
constexpr double kReach = 1e5;
constexpr std::size_t kNoPlane = static_cast<std::size_t>(-1);

struct Corner {
    Vec3 p;
    std::size_t edge;  ///< the plane that made the edge from this corner to the next
};

double height(const OrientedPlane& plane, const Vec3& p) {
    return dot(plane.normal, p - plane.point);
}

/// The height below which a difference is a rounding error, so that a plane given twice does not
/// cut itself.
double slack(const OrientedPlane& plane, const Vec3& p) {
    return 1e-15 * length(p - plane.point);
}

std::vector<Corner> large_square(const OrientedPlane& plane, double half) {
    const Vec3 u = half * perpendicular(plane.normal);
    const Vec3 v = cross(plane.normal, u);
    return {{plane.point - u - v, kNoPlane},
            {plane.point + u - v, kNoPlane},
            {plane.point + u + v, kNoPlane},
            {plane.point - u + v, kNoPlane}};
}

/// Clips the polygon to the inner side of `planes[by]`.
void clip(std::vector<Corner>& polygon, const std::vector<OrientedPlane>& planes, std::size_t by,
          std::vector<Corner>& scratch) {
    scratch.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner& a = polygon[i];
        const Corner& b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
        const double ha = height(planes[by], a.p), hb = height(planes[by], b.p);
        const bool a_inside = ha <= slack(planes[by], a.p);
        const bool b_inside = hb <= slack(planes[by], b.p);
        if (a_inside) scratch.push_back(a);
        if (a_inside == b_inside) continue;
        const Vec3 cut = a.p + (ha / (ha - hb)) * (b.p - a.p);
        // The new edge begins where the polygon leaves the half space; the old edge continues where
        // it enters.
        scratch.push_back({cut, a_inside ? by : a.edge});
    }
    polygon.swap(scratch);
}

/// `p` moved to the common point of three planes, unless they are nearly dependent.
Vec3 common_point(const OrientedPlane& a, const OrientedPlane& b, const OrientedPlane& c,
                  const Vec3& p) {
    const Vec3 bc = cross(b.normal, c.normal);
    const double det = dot(a.normal, bc);
    if (!(std::abs(det) > 1e-9)) return p;
    const Vec3 step = height(a, p) * bc + height(b, p) * cross(c.normal, a.normal) +
                      height(c, p) * cross(a.normal, b.normal);
    return p - step / det;
}

}  // namespace

ConvexCorners convex_corners(const std::vector<OrientedPlane>& planes) {
    double spread = 0.0;
    for (const OrientedPlane& plane : planes) {
        spread = std::max(spread, max_component(abs(plane.point - planes.front().point)));
    }
    ConvexCorners solid;
    solid.bounded = planes.size() >= 4;
    std::vector<Corner> polygon, scratch;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        polygon = large_square(planes[i], kReach * spread);
        for (std::size_t k = 0; k < planes.size() && !polygon.empty(); ++k) {
            if (k != i) clip(polygon, planes, k, scratch);
        }
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const std::size_t before = polygon[k > 0 ? k - 1 : polygon.size() - 1].edge;
            const std::size_t after = polygon[k].edge;
            if (before == kNoPlane || after == kNoPlane) {
                solid.bounded = false;
                continue;
            }
            // Corrects twice, the second time for the rounding of the first correction.
            Vec3 p = common_point(planes[i], planes[before], planes[after], polygon[k].p);
            p = common_point(planes[i], planes[before], planes[after], p);
            solid.corners.push_back(p);
        }
        solid.face_ends.push_back(solid.corners.size());
    }
    if (solid.corners.empty() && planes.size() >= 4) solid.bounded = true;
    return solid;
}

double convex_volume(const ConvexCorners& solid) {
    if (solid.corners.empty()) return 0.0;
    const Vec3 origin = solid.corners.front();
    double six_times = 0.0;
    std::size_t first = 0;
    for (const std::size_t end : solid.face_ends) {
        for (std::size_t i = first + 1; i + 1 < end; ++i) {
            six_times += dot(solid.corners[first] - origin,
                             cross(solid.corners[i] - origin, solid.corners[i + 1] - origin));
        }
        first = end;
    }
    return six_times / 6.0;
}

}  // namespace alhazen
