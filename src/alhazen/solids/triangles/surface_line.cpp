#include "alhazen/solids/triangles/surface_line.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

const double kDiagonal = std::sqrt(1.0 / 3.0);
const std::array<Vec3, 7> kDirections{{{1, 0, 0},
                                       {0, 1, 0},
                                       {0, 0, 1},
                                       {kDiagonal, kDiagonal, kDiagonal},
                                       {-kDiagonal, kDiagonal, kDiagonal},
                                       {kDiagonal, -kDiagonal, kDiagonal},
                                       {kDiagonal, kDiagonal, -kDiagonal}}};

}  // namespace

const std::vector<SurfaceLine::SurfacePoint>& SurfaceLine::cross(const Vec3& from,
                                                                 const Vec3& along, double t_min,
                                                                 double t_max, bool with_hits) {
    found_.clear();
    hits_.clear();
    solid_.crossings({from, along, t_min, t_max}, found_, with_hits ? &hits_ : nullptr);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < found_.size(); ++k) {
        const SurfacePoint& p = found_[k];
        const bool leaves = dot(p.normal, along) > 0.0;
        const bool wall = kept > 0 && found_[kept - 1].t == p.t && !leaves &&
                          dot(found_[kept - 1].normal, along) > 0.0;
        if (wall) {
            --kept;
            continue;
        }
        found_[kept] = p;
        if (with_hits) hits_[kept] = hits_[k];
        ++kept;
    }
    found_.resize(kept);
    return found_;
}

const std::vector<Interval>& SurfaceLine::spans(const Vec3& from, const Vec3& along) {
    solid_.cross({from, along, -kInfinity, kInfinity}, false, line_);
    return line_.spans;
}

bool SurfaceLine::inside(const Vec3& p) {
    const auto& all = spans(p, {0, 0, 1});
    return std::any_of(all.begin(), all.end(),
                       [](const Interval& s) { return s.lo <= 0.0 && 0.0 < s.hi; });
}

double SurfaceLine::distance(const Vec3& from, const Vec3& along, double limit) {
    double nearest = kInfinity;
    hits_.clear();
    solid_.hits({from, along, -limit, limit}, hits_);
    // Normals tell walls from surfaces; a wall is two hits at one place.
    const auto at_one = [](const Hit& a, const Hit& b) { return a.t == b.t; };
    if (std::adjacent_find(hits_.begin(), hits_.end(), at_one) == hits_.end()) {
        for (const Hit& hit : hits_) nearest = std::min(nearest, std::abs(hit.t));
        return nearest;
    }
    for (const SurfacePoint& p : cross(from, along, -limit, limit)) {
        nearest = std::min(nearest, std::abs(p.t));
    }
    return nearest;
}

bool SurfaceLine::is_near(const Vec3& p, const Vec3& face, double limit) {
    if (distance(p, face, limit) <= limit) return true;
    return std::any_of(kDirections.begin(), kDirections.end(),
                       [&](const Vec3& along) { return distance(p, along, limit) <= limit; });
}

bool SurfaceLine::faces(const Vec3& p, const Vec3& face, double limit) {
    const auto meets = [&](const Vec3& along) {
        const std::vector<SurfacePoint>& all = cross(p, along, -limit, limit);
        return std::any_of(all.begin(), all.end(), [&](const SurfacePoint& point) {
            return dot(point.normal, face) > 0.0;
        });
    };
    return meets(face) || std::any_of(kDirections.begin(), kDirections.end(), meets);
}

bool SurfaceLine::is_thin(const Vec3& from, const Vec3& along, const Interval& part, double limit) {
    if (0.5 * (part.hi - part.lo) <= limit) return true;
    const Vec3 middle = from + 0.5 * (part.lo + part.hi) * along;
    const Vec3 u = perpendicular(along), v = alhazen::cross(along, u);
    const double c = std::sqrt(0.5);
    for (const Vec3& aside : {u, v, c * (u + v), c * (u - v)}) {
        if (distance(middle, aside, limit) <= limit) return true;
    }
    return false;
}

}  // namespace alhazen
