#include "alhazen/shapes/polygons/half_space.h"

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

void HalfSpace::prepare() {
    face.point = point;
    face.normal = normal;
    face.prepare();
}

void HalfSpace::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
}

// The box of the whole solid, not only of its face.
Box3 HalfSpace::box() const {
    Box3 box = face.box();
    for (int k = 0; k < 3; ++k) {
        if (normal[k] > 0.0) box.lo[k] = -kInfinity;
        if (normal[k] < 0.0) box.hi[k] = kInfinity;
    }
    return box;
}

Interval HalfSpace::extent(const Vec3& axis) const {
    Interval range = face.extent(axis);
    if (dot(axis, face.unit_normal) > 0.0) {
        range.lo = -kInfinity;
    } else {
        range.hi = kInfinity;
    }
    return range;
}

int HalfSpace::intersect(const Ray& ray, ShapeHit* hits) const {
    return face.intersect(ray, hits);
}

ShapeSurface HalfSpace::surface(const Ray& ray, const ShapeHit& hit) const {
    return face.surface(ray, hit);
}

bool HalfSpace::inside_at_minus_infinity(const Ray& ray) const {
    // Keeps the parity: a crossing whose t overflows is omitted.
    Ray line = ray;
    line.t_min = -kInfinity;
    line.t_max = kInfinity;
    ShapeHit hit;
    if (face.intersect(line, &hit) == 1) return dot(face.unit_normal, ray.direction) > 0.0;
    const double depth = dot(face.unit_normal, face.point - ray.origin);
    return depth > 0.0 || (depth == 0.0 && keeps_face(face.unit_normal));
}

}  // namespace alhazen
