#pragma once
/// Random CSG solids as scene descriptions, and point membership by direct evaluation of the
/// expression.

#include <cmath>
#include <string>
#include <vector>

#include "alhazen/sampling/random.h"
#include "support/scene_maker.h"

namespace alhazen::testing {

/// A function of the point that is negative inside the leaf and 0 on its surface, in the units of
/// the leaf's frame.
inline double side_of(const AnyShape& shape, const Vec3& p) {
    if (const auto* s = std::get_if<Sphere>(&shape)) return length(p - s->center) - s->radius;
    if (const auto* b = std::get_if<BoxShape>(&shape)) {
        double most = -1e300;
        for (int k = 0; k < 3; ++k) {
            most = std::fmax(most, std::fmax(b->lo[k] - p[k], p[k] - b->hi[k]));
        }
        return most;
    }
    const auto frustum = [&](const Vec3& base, const Vec3& top, double r0, double r1) {
        const double height = length(top - base);
        const Vec3 axis = (top - base) / height;
        const double h = dot(p - base, axis);
        const double radius = r0 + (r1 - r0) * h / height;
        const double across = length(p - base - h * axis);
        return std::fmax(std::fmax(-h, h - height), across - radius);
    };
    if (const auto* c = std::get_if<Cylinder>(&shape)) {
        return frustum(c->base, c->top, c->radius, c->radius);
    }
    const auto& c = std::get<Cone>(shape);
    return frustum(c.base, c.top, c.base_radius, c.top_radius);
}

/// Position of a point relative to the object, or on the surface of one of its leaves.
enum class Side { Outside, Inside, OnSurface };

inline Side side_of(const SceneDescription& d, ObjectIndex object, const Vec3& p,
                    double margin = 1e-7) {
    const ObjectDescription& o = d.objects[static_cast<std::size_t>(object)];
    bool value = false;
    bool first = true;
    for (const Part& part : o.parts) {
        const Vec3 q = inverse(part.object_from_part).point(p);
        bool inside;
        if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
            const Side side = side_of(d, *child, q, margin);
            if (side == Side::OnSurface) return side;
            inside = side == Side::Inside;
        } else {
            const double f = side_of(std::get<AnyShape>(part.what), q);
            if (std::abs(f) < margin) return Side::OnSurface;
            inside = f < 0.0;
        }
        if (first) {
            value = inside;
        } else if (o.combine == Combine::Intersection) {
            value = value && inside;
        } else if (o.combine == Combine::Difference) {
            value = value && !inside;
        } else {
            value = value || inside;
        }
        first = false;
    }
    return value ? Side::Inside : Side::Outside;
}

/// Makes trees of operators over spheres, boxes, cylinders and cones around the origin.
class RandomSolids {
  public:
    /// `lattice`: coordinates are multiples of one half, so that many surfaces coincide.
    RandomSolids(SceneMaker& maker, RandomStream& random, bool lattice)
        : maker_(maker), random_(random), lattice_(lattice) {}

    /// An object with at most `leaves` leaves, some of its operands shared.
    ObjectIndex tree(int leaves) {
        const ObjectIndex object = maker_.object("node");
        const Combine kinds[] = {Combine::Union, Combine::Intersection, Combine::Difference,
                                 Combine::Difference};
        maker_.description().objects[static_cast<std::size_t>(object)].combine = kinds[index(4)];
        int left = leaves;
        while (left > 0) {
            const int here = 1 + index(left);
            if (here >= 2 && index(3) > 0) {
                const ObjectIndex child = tree(here);
                maker_.add(child, MaterialId{0}, placement(), object);
                if (index(6) == 0) maker_.add(child, MaterialId{0}, placement(), object);
                left -= here;
            } else {
                maker_.add(leaf(), MaterialId{0}, placement(), object);
                --left;
            }
        }
        return object;
    }

    Ray ray() {
        const auto point = [&](double reach) {
            return Vec3{number(-reach, reach), number(-reach, reach), number(-reach, reach)};
        };
        const Vec3 origin = point(4);
        if (!lattice_ || index(3) > 0) {
            return {origin,
                    Vec3{random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1)} -
                        (index(2) ? 0.3 : 0.0) * origin};
        }
        Vec3 direction{};
        direction[index(3)] = index(2) ? 1.0 : -1.0;
        return {origin, direction};
    }

  private:
    int index(int n) { return static_cast<int>(random_.uniform(0, 1) * n) % n; }
    double number(double lo, double hi) {
        const double x = random_.uniform(lo, hi);
        return lattice_ ? std::round(2 * x) / 2 : x;
    }
    double size() { return lattice_ ? 0.5 * (1 + index(3)) : random_.uniform(0.2, 1.2); }
    Vec3 point() { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }

    Affine placement() {
        if (index(3) > 0) return {};
        if (lattice_) return Affine::translate(point());
        return Affine::translate(0.4 * point()) *
               Affine::rotate({random_.uniform(-1, 1), random_.uniform(-1, 1), 1.0},
                              random_.uniform(0, 6)) *
               Affine::scale({random_.uniform(0.6, 1.5), index(4) ? 1.0 : -1.0, 1.0});
    }

    AnyShape leaf() {
        const Vec3 p = point();
        switch (index(5)) {
            case 0:
                return Sphere{p, size()};
            case 1:
                return Cylinder{.base = p, .top = p + end(), .radius = size()};
            case 2:
                return Cone{.base = p,
                            .top = p + end(),
                            .base_radius = size(),
                            .top_radius = index(2) ? 0.0 : size()};
            default:
                return BoxShape{p, p + Vec3{size(), size(), size()}};
        }
    }
    Vec3 end() {
        if (!lattice_) return {random_.uniform(-1, 1), random_.uniform(-1, 1), 1.0};
        Vec3 v{};
        v[index(3)] = size();
        return v;
    }

    SceneMaker& maker_;
    RandomStream& random_;
    bool lattice_;
};

}  // namespace alhazen::testing
