#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

bool cut_by_clip(const SolidFrame& frame, const Vec3& o, const Vec3& d, const Box3& box,
                 const std::vector<ClipPlane>& planes, ClipRange& range) {
    if (!cut_by_box(frame, o, d, box, range)) return false;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        // With the far side infinitely far, only one of the slab's two parts can be hit.
        const std::uint32_t part = kFirstClipPlanePart + static_cast<std::uint32_t>(i);
        const double climb = dot(planes[i].normal, d);
        const Vec3 outward =
            climb == 0.0 ? transpose_times(frame.local_from_object, planes[i].normal) : Vec3{};
        if (!range.cut(dot(planes[i].normal, o), climb, -kInfinity, planes[i].offset, part - 1,
                       outward)) {
            return false;
        }
    }
    return true;
}

bool ClippedQuadric::has_clip() const {
    return clip_box.lo.x > -kInfinity || clip_box.lo.y > -kInfinity || clip_box.lo.z > -kInfinity ||
           clip_box.hi.x < kInfinity || clip_box.hi.y < kInfinity || clip_box.hi.z < kInfinity ||
           !planes.empty();
}

int ClippedQuadric::intersect(const Ray& ray, ShapeHit* hits) const {
    ClipRange range;
    if (has_clip()) {
        const Vec3 o = frame.to_local(ray.origin);
        const Vec3 d = frame.local_from_object * ray.direction;
        if (!cut_by_clip(frame, o, d, clip_box, planes, range)) return 0;
        if (!(range.exit >= ray.t_min && range.entry <= ray.t_max)) return 0;
    }
    const QuadricSpans spans = quadric.spans(frame, ray);
    bool inside = spans.inside_first;
    double t[2];
    int count = 0;
    for (int i = 0; i < spans.count; ++i) {
        if (spans.t[i] < range.entry) {
            inside = !inside;
        } else if (spans.t[i] <= range.exit) {
            t[count++] = spans.t[i];
        }
    }
    return report_solid(ray, range, inside, t, count, capped, hits);
}

bool ClippedQuadric::inside_at_minus_infinity(const Ray& ray) const {
    ClipRange range;
    const Vec3 o = frame.to_local(ray.origin);
    const Vec3 d = frame.local_from_object * ray.direction;
    if (!cut_by_clip(frame, o, d, clip_box, planes, range) || range.entry > -kInfinity)
        return false;
    return quadric.spans(frame, ray).inside_first;
}

ShapeSurface clip_face_surface(const SolidFrame& frame, const Box3& clip_box,
                               const std::vector<ClipPlane>& planes, Vec3 p, std::uint32_t part) {
    ShapeSurface surface;
    LocalUv local;
    Vec3 normal{};
    Vec3 off_face{};
    if (part < kFirstClipPlanePart) {
        const int axis = static_cast<int>((part - 1) / 2);
        const bool high = part % 2 == 0;
        p[axis] = high ? clip_box.hi[axis] : clip_box.lo[axis];
        normal[axis] = high ? 1.0 : -1.0;
        if (axis == 2) {
            local = turn_uv(p);
            const double distance = std::hypot(p.x, p.y);
            local.uv.y = distance;
            if (distance > 0.0) local.v_gradient = Vec3{p.x, p.y, 0.0} / distance;
        } else {
            local.uv = {p[axis == 0 ? 1 : 0], p.z};
            local.u_gradient[axis == 0 ? 1 : 0] = 1.0;
            local.v_gradient.z = 1.0;
        }
    } else {
        const ClipPlane& plane = planes[part - kFirstClipPlanePart];
        const double squared = length_squared(plane.normal);
        p -= ((dot(plane.normal, p) - plane.offset) / squared) * plane.normal;
        normal = plane.normal / std::sqrt(squared);
        off_face = gamma_bound(8) *
                   (dot(abs(normal), abs(p)) + std::abs(plane.offset) / std::sqrt(squared)) *
                   abs(normal);
        const Vec3 across = perpendicular(normal);
        local.u_gradient = across;
        local.v_gradient = cross(normal, across);
        local.uv = {dot(local.u_gradient, p), dot(local.v_gradient, p)};
    }
    surface.point = frame.to_object(p);
    surface.normal = surface.shading_normal = object_normal(frame, normal, {0, 0, 1});
    set_uv(frame, local, normal, surface);
    const Mat3& m = frame.object_from_local;
    surface.error = frame.object_error(p, 8) + off_face.x * abs(m.x_axis) +
                    off_face.y * abs(m.y_axis) + off_face.z * abs(m.z_axis);
    return surface;
}

ShapeSurface ClippedQuadric::side_surface(const Vec3& start, const Vec3& before) const {
    const QuadricForm& form = quadric.form();
    Vec3 p = start;
    Vec3 gradient = form.gradient(p);
    double residual = 0.0;
    // The value in double-double: the remaining error is the rounding of p.
    const auto value = [&] { return form.value(to_real<DoubleDouble>(p)).high; };
    for (int i = 0; i < 2; ++i) {
        const double squared = length_squared(gradient);
        if (!(squared > 0.0)) break;
        p -= (value() / squared) * gradient;
        gradient = form.gradient(p);
    }
    const double steepness = length(gradient);
    if (steepness > 0.0) residual = std::abs(value()) / steepness;
    // At an apex the normal is taken just before it on the ray.
    const Vec3 usable = steepness > 0.0 ? gradient : form.gradient(before);

    ShapeSurface surface;
    surface.point = frame.to_object(p);
    surface.normal = surface.shading_normal = object_normal(frame, usable, {0, 0, 1});
    LocalUv local = turn_uv(p);
    const double across = std::hypot(p.x, p.y);
    if (v_kind == V::Latitude) {
        local.uv.y = 0.5 + std::atan2(p.z, across) / kPi;
        const double squared = kPi * length_squared(p);
        if (across > 0.0) {
            local.v_gradient = Vec3{-p.z * p.x / across, -p.z * p.y / across, across} / squared;
        }
    } else {
        const double height = v_range.hi - v_range.lo;
        local.uv.y = (p.z - v_range.lo) / height;
        local.v_gradient.z = 1.0 / height;
    }
    set_uv(frame, local, usable, surface, least_slope);
    const Mat3& m = frame.object_from_local;
    surface.error =
        frame.object_error(p, 8) + 2.0 * residual * (abs(m.x_axis) + abs(m.y_axis) + abs(m.z_axis));
    return surface;
}

ShapeSurface ClippedQuadric::surface(const Ray& ray, const ShapeHit& hit) const {
    const Vec3 p = frame.to_local(ray.at(hit.t));
    if (hit.part > 0) return clip_face_surface(frame, clip_box, planes, p, hit.part);
    const Vec3 d = unit_or(frame.local_from_object * ray.direction, {0, 0, 1});
    return side_surface(p, p - (1e-6 * (1.0 + length(p))) * d);
}

}  // namespace alhazen
