#include "embree/embree_cylinders.h"

#include <algorithm>
#include <cmath>

namespace alhazen::bench {

namespace {

using Entry = EmbreeCylinders::Entry;

/// The nearest crossing in [tnear, tfar], or one beyond tfar.
struct Crossing {
    float t;
    float normal[3];  ///< not normalized
};

/// The ray in lane `i` of a packet of `n`.
struct LaneRay {
    float o[3], d[3];
    float tnear, tfar;

    LaneRay(RTCRayN* rays, unsigned n, unsigned i)
        : o{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
          d{RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
          tnear(RTCRayN_tnear(rays, n, i)),
          tfar(RTCRayN_tfar(rays, n, i)) {}
};

inline float dot3(const float* a, const float* b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline bool intersect(const Entry& c, const LaneRay& ray, bool normal_wanted, Crossing& hit) {
    const float o[3] = {ray.o[0] - c.center[0], ray.o[1] - c.center[1], ray.o[2] - c.center[2]};
    const float* d = ray.d;
    const float oz = dot3(o, c.axis), dz = dot3(d, c.axis);
    const float moment = c.axis[0] * (o[1] * d[2] - o[2] * d[1]) +
                         c.axis[1] * (o[2] * d[0] - o[0] * d[2]) +
                         c.axis[2] * (o[0] * d[1] - o[1] * d[0]);
    const float a = dot3(d, d) - dz * dz;
    const float b = dot3(o, d) - oz * dz;
    const float discriminant = a * c.radius * c.radius - moment * moment;
    if (!(discriminant >= 0.0f)) return false;
    const float root = std::sqrt(discriminant), inverse_a = 1.0f / a;
    const float side_entry = (-b - root) * inverse_a, side_exit = (-b + root) * inverse_a;
    const float inverse_dz = 1.0f / dz;
    const float reach = std::abs(c.half_height * inverse_dz), middle = -oz * inverse_dz;
    const float entry = std::max(side_entry, middle - reach);
    const float exit = std::min(side_exit, middle + reach);
    if (!(entry <= exit)) return false;
    const bool at_entry = entry >= ray.tnear;
    const float t = at_entry ? entry : exit;
    if (!(t >= ray.tnear && t <= ray.tfar)) return false;
    hit.t = t;
    if (!normal_wanted) return true;
    const bool on_side = at_entry ? entry == side_entry : exit == side_exit;
    const float z = oz + t * dz;
    for (int k = 0; k < 3; ++k) {
        hit.normal[k] =
            on_side ? o[k] + t * d[k] - z * c.axis[k] : std::copysign(1.0f, z) * c.axis[k];
    }
    return true;
}

void report_bounds(const RTCBoundsFunctionArguments* args) {
    const Entry& c = static_cast<const Entry*>(args->geometryUserPtr)[args->primID];
    float reach[3];
    for (int k = 0; k < 3; ++k) {
        const float across = std::sqrt(std::max(0.0f, 1.0f - c.axis[k] * c.axis[k]));
        // Margin for the rounding of this bound and of the test.
        reach[k] = 1.00001f * (c.half_height * std::abs(c.axis[k]) + c.radius * across);
    }
    RTCBounds& box = *args->bounds_o;
    box.lower_x = c.center[0] - reach[0];
    box.lower_y = c.center[1] - reach[1];
    box.lower_z = c.center[2] - reach[2];
    box.upper_x = c.center[0] + reach[0];
    box.upper_y = c.center[1] + reach[1];
    box.upper_z = c.center[2] + reach[2];
}

void report_nearest(const RTCIntersectFunctionNArguments* args) {
    const Entry& c = static_cast<const Entry*>(args->geometryUserPtr)[args->primID];
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
    for (unsigned i = 0; i < args->N; ++i) {
        Crossing hit;
        if (args->valid[i] != -1 || !intersect(c, LaneRay(rays, args->N, i), true, hit)) continue;
        RTCRayN_tfar(rays, args->N, i) = hit.t;
        RTCHitN_Ng_x(hits, args->N, i) = hit.normal[0];
        RTCHitN_Ng_y(hits, args->N, i) = hit.normal[1];
        RTCHitN_Ng_z(hits, args->N, i) = hit.normal[2];
        RTCHitN_u(hits, args->N, i) = 0;
        RTCHitN_v(hits, args->N, i) = 0;
        RTCHitN_primID(hits, args->N, i) = args->primID;
        RTCHitN_geomID(hits, args->N, i) = args->geomID;
        RTCHitN_instID(hits, args->N, i, 0) = args->context->instID[0];
    }
}

void report_any(const RTCOccludedFunctionNArguments* args) {
    const Entry& c = static_cast<const Entry*>(args->geometryUserPtr)[args->primID];
    for (unsigned i = 0; i < args->N; ++i) {
        Crossing hit;
        if (args->valid[i] != -1 || !intersect(c, LaneRay(args->ray, args->N, i), false, hit)) {
            continue;
        }
        RTCRayN_tfar(args->ray, args->N, i) = -HUGE_VALF;
    }
}

}  // namespace

EmbreeCylinders::EmbreeCylinders(const std::vector<Cylinder>& cylinders) {
    for (const Cylinder& c : cylinders) {
        const Vec3 center = 0.5 * (c.base + c.top), axis = normalize(c.top - c.base);
        Entry entry{};
        for (int k = 0; k < 3; ++k) {
            entry.center[k] = static_cast<float>(center[k]);
            entry.axis[k] = static_cast<float>(axis[k]);
        }
        entry.half_height = static_cast<float>(0.5 * length(c.top - c.base));
        entry.radius = static_cast<float>(c.radius);
        entries_.push_back(entry);
    }
}

RTCGeometry EmbreeCylinders::make_geometry(RTCDevice device) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(entries_.size()));
    rtcSetGeometryUserData(geometry, entries_.data());
    rtcSetGeometryBoundsFunction(geometry, report_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, report_nearest);
    rtcSetGeometryOccludedFunction(geometry, report_any);
    return geometry;
}

}  // namespace alhazen::bench
