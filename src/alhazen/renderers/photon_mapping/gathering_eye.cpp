#include "alhazen/renderers/photon_mapping/gathering_eye.h"

#include <cmath>

#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

double fraction(double v) {
    return std::min(v - std::floor(v), 0x1.fffffffffffffp-1);
}

/// The bits of a number behind the point (van der Corput).
double mirrored_bits(std::uint32_t n) {
    double value = 0.0;
    for (double bit = 0.5; n != 0; n >>= 1, bit *= 0.5) value += (n & 1) != 0 ? bit : 0.0;
    return value;
}

}  // namespace

Rgb GatheringEye::photon_light(const SeenPoint& at) {
    const Vec3& point = at.surface.point;
    const Rgb caustic = density_.radiance(maps_.caustic, at.scatter, point, LightPart::NotGlossy);
    if (gather_ > 0) return caustic + gathered(at);
    return caustic + density_.radiance(maps_.global, at.scatter, point, LightPart::NotGlossy);
}

Rgb GatheringEye::gathered(const SeenPoint& at) {
    constexpr double kGolden = 0.6180339887498949;
    const Vec3 shift{at.numbers.at(0), at.numbers.at(1), at.numbers.at(2)};
    Rgb sum;
    for (int k = 0; k < gather_; ++k) {
        const Vec2 u{fraction(static_cast<double>(k) / gather_ + shift.x),
                     fraction(mirrored_bits(static_cast<std::uint32_t>(k)) + shift.y)};
        const auto drawn =
            at.scatter.sample(fraction(k * kGolden + shift.z), u, Transport::Radiance);
        if (!drawn || drawn->singular || drawn->density > kGlossyDensity) continue;
        PathEnd path;
        path.time = at.path.time;
        path.media = at.path.media;
        NextSurface::go_on(path, at.surface, at.scatter, *drawn);
        const PathNumbers numbers{mix64(at.numbers.seed) + static_cast<std::uint64_t>(k),
                                  at.numbers.path, at.numbers.part};
        sum += arriving(path, numbers);
    }
    return (1.0 / gather_) * sum;
}

Rgb GatheringEye::arriving(PathEnd& path, const PathNumbers& numbers) {
    Rgb sum;
    for (int surface = 0; surface < settings_.depth; ++surface) {
        if (!next_.find(path, numbers)) return sum;
        const ShadingPoint& point = next_.point();
        if (point.material->unlit) return sum;
        met_.set(scene_, point, path.media);
        if (met_.has_density()) {
            sum += path.throughput *
                   density_.radiance(maps_.global, met_, point.surface.point, LightPart::All);
        }
        const std::uint64_t first = 3 * static_cast<std::uint64_t>(surface);
        const auto drawn = met_.sample(
            numbers.at(first), {numbers.at(first + 1), numbers.at(first + 2)}, Transport::Radiance);
        if (!drawn || !drawn->singular || drawn->weight.is_black()) return sum;
        NextSurface::go_on(path, point.surface, met_, *drawn);
    }
    return sum;
}

}  // namespace alhazen
