#include "alhazen/renderers/manifold/specular_chain.h"

#include <cmath>

#include "alhazen/renderers/manifold/normal_change.h"

namespace alhazen {

namespace {

/// Largest number of surfaces of other parts that a ray passes before the part.
constexpr int kMostPassed = 64;

}  // namespace

bool ChainTracer::find(Ray ray, std::uint64_t part, RayKind kind, float time,
                       ChainVertex& vertex) const {
    double travelled = 0.0;
    for (int passed = 0; passed < kMostPassed; ++passed) {
        ++counters_[kind].cast;
        vertex.hit = Hit();
        if (!scene_.aggregate->closest(ray, vertex.hit, {nullptr, mask_of(kind), time})) {
            return false;
        }
        ++counters_[kind].hit;
        set_surface(*scene_.aggregate, ray, vertex.hit, CoordinateNeed::none(), vertex.surface,
                    time);
        travelled += vertex.hit.t;
        if (part_key(vertex.surface) == part) {
            const Vec3& d = ray.direction;
            vertex.ray = ray;
            vertex.arriving = d;
            vertex.travelled = travelled;
            vertex.entering = dot(d, vertex.surface.normal) < 0.0;
            const Vec3& n = vertex.surface.shading_normal;
            vertex.normal = dot(d, n) > 0.0 ? -n : n;
            return true;
        }
        ray = leaving_ray(vertex.surface, ray.direction);
    }
    return false;
}

bool ChainTracer::bend(bool refracted, ChainVertex& vertex) {
    const Vec3& n = vertex.normal;
    const Vec3& d = vertex.arriving;
    const double cosine = -dot(d, n);
    if (refracted) {
        const double squared = 1.0 - vertex.eta * vertex.eta * (1.0 - cosine * cosine);
        if (!(squared > 0.0)) return false;
        vertex.leaving = vertex.eta * d + (vertex.eta * cosine - std::sqrt(squared)) * n;
    } else {
        vertex.leaving = d + (2.0 * cosine) * n;
    }
    vertex.leaving = normalize(vertex.leaving);
    const bool goes_on = dot(vertex.leaving, vertex.surface.normal) < 0.0;
    return cosine > 0.0 && (goes_on == vertex.entering) == refracted;
}

bool ChainTracer::follow(const ShapeSurface& from, const Vec3& direction, ChainKind kind,
                         std::uint64_t part, const ChainIndices& indices, float time,
                         Chain& chain) const {
    chain.kind = kind;
    chain.direction = direction;
    Ray ray = leaving_ray(from, direction);
    RayKind ray_kind = RayKind::Reflection;
    for (int i = 0; i < length_of(kind); ++i) {
        const auto k = static_cast<std::size_t>(i);
        ChainVertex& vertex = chain.at[k];
        if (!find(ray, part, ray_kind, time, vertex)) return false;
        vertex.eta = indices.eta[k];
        if (refracts(kind) && vertex.entering != indices.entering[k]) return false;
        if (!bend(refracts(kind), vertex)) return false;
        ray = leaving_ray(vertex.surface, vertex.leaving);
        ray_kind = RayKind::Refraction;
    }
    return true;
}

std::optional<ChainSlope> ChainTracer::slope(const Chain& chain, float time) const {
    ChainSlope slope;
    const Vec3 a = perpendicular(chain.direction);
    slope.first = {a, cross(chain.direction, a)};
    std::array<Vec3, 2> moved{}, turned = slope.first;
    for (int i = 0; i < chain.length(); ++i) {
        const ChainVertex& v = chain.at[static_cast<std::size_t>(i)];
        auto change = normal_change(*scene_.aggregate, v.ray, v.hit, v.surface, time);
        if (!change) return std::nullopt;
        const Vec3& d = v.arriving;
        const Vec3& n = v.normal;
        const double sign = dot(n, v.surface.shading_normal) < 0.0 ? -1.0 : 1.0;
        const double facing = dot(v.surface.normal, d), cosine = -dot(d, n);
        if (facing == 0.0) return std::nullopt;
        const double behind =
            refracts(chain.kind) ? std::sqrt(1.0 - v.eta * v.eta * (1.0 - cosine * cosine)) : 0.0;
        for (std::size_t k = 0; k < 2; ++k) {
            const Vec3 carried = moved[k] + v.travelled * turned[k];
            moved[k] = carried - (dot(v.surface.normal, carried) / facing) * d;
            const Vec3 tilted = sign * (*change * moved[k]);
            const double closer = -(dot(turned[k], n) + dot(d, tilted));
            if (refracts(chain.kind)) {
                const double mu = v.eta * cosine - behind;
                const double mu_change = v.eta * closer * (1.0 - v.eta * cosine / behind);
                turned[k] = v.eta * turned[k] + mu_change * n + mu * tilted;
            } else {
                turned[k] = turned[k] + (2.0 * closer) * n + (2.0 * cosine) * tilted;
            }
        }
        if (i == 0) slope.point = moved;
    }
    slope.end = moved;
    slope.direction = turned;
    return slope;
}

}  // namespace alhazen
