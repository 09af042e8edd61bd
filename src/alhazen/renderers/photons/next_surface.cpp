#include "alhazen/renderers/photons/next_surface.h"

#include <limits>

#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

/// Dimensions from here on decide about coverage.
constexpr std::uint64_t kCoverage = std::uint64_t{1} << 32;

void absorb(PathEnd& path, double distance) {
    const Medium* const medium = path.media.here();
    if (medium == nullptr) return;
    path.throughput =
        path.throughput * transmittance(path.waves->absorption(medium->absorption), distance);
}

}  // namespace

double PathNumbers::at(std::uint64_t dimension) const {
    return random_at(seed, path, part, dimension);
}

bool NextSurface::find(PathEnd& path, const PathNumbers& numbers) {
    for (int passed = 0; passed <= kMaxPassedSurfaces; ++passed) {
        ++counters_[path.kind].cast;
        hit_ = Hit();
        if (!scene_.aggregate->closest(path.ray, hit_, {stats_, mask_of(path.kind), path.time})) {
            absorb(path, std::numeric_limits<double>::infinity());
            return false;
        }
        ++counters_[path.kind].hit;
        set_shading_point(
            scene_, path.ray, hit_,
            {!path.media.empty(), path.cone.width_at(hit_.t), path.time, path.kind != RayKind::Eye},
            {}, point_);
        path.cone = path.cone.from(hit_.t);
        path.travelled += hit_.t;
        absorb(path, hit_.t);
        const double coverage = point_.material->coverage;
        const std::uint32_t number = path.met++;
        if (coverage >= 1.0 || numbers.at(kCoverage + number) < coverage) return true;
        path.ray = leaving_ray(point_.surface, path.ray.direction);
    }
    return false;
}

void NextSurface::go_on(PathEnd& path, const ShapeSurface& at, const ScatterPoint& scatter,
                        const Scattered& drawn) {
    path.throughput = path.throughput * drawn.weight;
    if (drawn.transmitted) scatter.cross(path.media);
    path.kind = drawn.transmitted ? RayKind::Refraction : RayKind::Reflection;
    path.ray = leaving_ray(at, drawn.direction);
    if (!drawn.straight) path.travelled = 0.0;
}

}  // namespace alhazen
