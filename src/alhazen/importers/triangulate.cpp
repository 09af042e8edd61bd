#include "alhazen/importers/triangulate.h"

#include <cstddef>

namespace alhazen {

namespace {

/// Twice the signed area of a triangle in the plane.
double cross_2d(Vec2 a, Vec2 b, Vec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon in the plane, counter-clockwise.
std::vector<Vec2> flatten(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                          const Vec3& normal) {
    const int drop = dominant_axis(normal);
    const int a = (drop + 1) % 3;
    const int b = (drop + 2) % 3;
    const bool flip = normal[drop] < 0.0;
    // Relative to the first vertex: far from the origin the products would lose all digits.
    const Vec3 origin = positions[polygon[0]];
    std::vector<Vec2> flat;
    flat.reserve(polygon.size());
    for (const std::uint32_t index : polygon) {
        const Vec3 p = positions[index] - origin;
        flat.push_back(flip ? Vec2{p[b], p[a]} : Vec2{p[a], p[b]});
    }
    return flat;
}

/// True when no corner turns right and the turns add up to one revolution (a star turns left at
/// every corner, but more than once around).
bool is_convex(const std::vector<Vec2>& flat) {
    const std::size_t n = flat.size();
    int x_changes = 0;
    double last_dx = 0.0;
    double first_dx = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 p = flat[i];
        const Vec2 q = flat[i + 1 < n ? i + 1 : 0];
        const Vec2 r = flat[i + 2 < n ? i + 2 : i + 2 - n];
        if (!(cross_2d(p, q, r) >= 0.0)) return false;
        const double dx = q.x - p.x;
        if (dx == 0.0) continue;
        if (last_dx == 0.0) {
            first_dx = dx;
        } else if ((dx < 0.0) != (last_dx < 0.0)) {
            ++x_changes;
        }
        last_dx = dx;
    }
    if ((first_dx < 0.0) != (last_dx < 0.0)) ++x_changes;
    return x_changes <= 2;
}

class EarClipper {
  public:
    explicit EarClipper(const std::vector<Vec2>& flat) : flat_(flat), corners_(flat.size()) {
        const std::size_t n = flat.size();
        for (std::size_t i = 0; i < n; ++i) {
            corners_[i].previous = std::uint32_t(i == 0 ? n - 1 : i - 1);
            corners_[i].next = std::uint32_t(i + 1 == n ? 0 : i + 1);
        }
        for (std::uint32_t i = 0; i < n; ++i) {
            classify(i);
            if (corners_[i].reflex) reflex_.push_back(i);
        }
        for (std::uint32_t i = 0; i < n; ++i) update_ear(i);
    }

    /// Calls emit(previous, corner, next) for each triangle.
    template <class Emit>
    void clip(const Emit& emit) {
        std::uint32_t at = 0;
        for (std::size_t left = corners_.size(); left > 2; --left) {
            at = next_ear(at, left);
            const Corner ear = corners_[at];
            emit(ear.previous, at, ear.next);
            corners_[at].gone = true;
            corners_[ear.previous].next = ear.next;
            corners_[ear.next].previous = ear.previous;
            classify(ear.previous);
            classify(ear.next);
            update_ear(ear.previous);
            update_ear(ear.next);
            at = ear.next;  // going on around keeps triangles from gathering at one vertex
        }
    }

  private:
    struct Corner {
        std::uint32_t previous = 0, next = 0;
        bool reflex = false, ear = false, gone = false;
    };

    void classify(std::uint32_t i) {
        Corner& corner = corners_[i];
        corner.reflex = !(cross_2d(flat_[corner.previous], flat_[i], flat_[corner.next]) >= 0.0);
    }
    void update_ear(std::uint32_t i) {
        Corner& corner = corners_[i];
        corner.ear = !corner.reflex && is_empty(i);
    }
    /// No other reflex vertex in the triangle at corner `i`; vertices in the same place do not
    /// count.
    bool is_empty(std::uint32_t i) {
        const Vec2 a = flat_[corners_[i].previous];
        const Vec2 b = flat_[i];
        const Vec2 c = flat_[corners_[i].next];
        for (std::size_t k = 0; k < reflex_.size();) {
            const std::uint32_t j = reflex_[k];
            if (corners_[j].gone || !corners_[j].reflex) {
                // A corner that has become convex stays so: forget it.
                reflex_[k] = reflex_.back();
                reflex_.pop_back();
                continue;
            }
            ++k;
            const Vec2 p = flat_[j];
            if (p == a || p == b || p == c) continue;
            if (cross_2d(a, b, p) >= 0.0 && cross_2d(b, c, p) >= 0.0 && cross_2d(c, a, p) >= 0.0) {
                return false;
            }
        }
        return true;
    }
    /// The first ear from `start` on; without one, the first corner that does not turn right, else
    /// `start`.
    std::uint32_t next_ear(std::uint32_t start, std::size_t left) const {
        std::uint32_t at = start;
        std::uint32_t fallback = start;
        bool found = false;
        for (std::size_t k = 0; k < left; ++k, at = corners_[at].next) {
            if (corners_[at].ear) return at;
            if (!found && !corners_[at].reflex) {
                fallback = at;
                found = true;
            }
        }
        return fallback;
    }

    const std::vector<Vec2>& flat_;
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> reflex_;
};

}  // namespace

Vec3 newell_normal(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon) {
    const Vec3 origin = positions[polygon[0]];
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        sum += cross(positions[polygon[i]] - origin, positions[polygon[i + 1]] - origin);
    }
    return sum;
}

bool triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<std::array<std::uint32_t, 3>>& triangles) {
    if (polygon.size() == 3) {
        triangles.push_back({polygon[0], polygon[1], polygon[2]});
        return true;
    }
    const std::vector<Vec2> flat = flatten(positions, polygon, newell_normal(positions, polygon));
    if (is_convex(flat)) {
        for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
            triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
        }
        return true;
    }
    if (polygon.size() > kMaxConcaveVertices) return false;
    EarClipper(flat).clip([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        triangles.push_back({polygon[a], polygon[b], polygon[c]});
    });
    return true;
}

}  // namespace alhazen
