#include "alhazen/renderers/vcm/vcm_tracer.h"

#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/renderers/photons/photon_density.h"

namespace alhazen {

VcmTracer::VcmTracer(const RenderJob& job, std::size_t at_once, RayCounters& counters,
                     const Illumination& lights, const PathSettings& settings,
                     LensLight* lens_light, MergePass* pass)
    : BidirectionalTracer(job, at_once, counters, lights, settings, lens_light), pass_(*pass) {
    set_merging(pass->merging);
    set_waves(pass->waves);
}

void VcmTracer::merge(Spectrum& sum) {
    const std::vector<PathVertex>& path = eye_path();
    if (!(pass_.merging > 0.0)) return;
    SideSums sums;
    std::uint64_t merged = 0;
    // Merged paths have two surfaces on the light's side, including the merged one.
    for (std::size_t b = 1; b <= path.size() && static_cast<int>(b) < settings().depth; ++b) {
        const PathVertex& z = path[b - 1];
        if (b == 1) {
            sums = SideSums::at_lens(z.density);
        } else {
            const PathVertex& last = path[b - 2];
            // Density of the previous vertex on a path that comes from here.
            const double before = b >= 3 ? path[b - 3].reverse : 0.0;
            sums = sums.after(before, last.singular, !last.in_volume, pass_.merging, z.density);
        }
        if (z.connects() && !z.in_volume) sum += z.throughput * merged_at(b, sums, merged);
    }
    pass_.merged.fetch_add(merged, std::memory_order_relaxed);
}

Spectrum VcmTracer::merged_at(std::size_t b, const SideSums& eye, std::uint64_t& merged) const {
    const PathVertex& z = eye_path()[b - 1];
    double facing = 0.0;
    if (b >= 2) {
        const PathVertex& last = eye_path()[b - 2];
        facing = last.facing(z.scatter.view()) / (z.distance * z.distance) * z.backward;
    }
    const PhotonFits fits(z.scatter);
    const auto most = static_cast<std::uint32_t>(settings().depth) + 1;
    Spectrum light;
    pass_.grid.for_near(z.point(), [&](const LightVertex& y) {
        if (y.number + b > most || !fits(y.photon)) return;
        ++merged;
        const Spectrum scattered =
            scattered_light(z.scatter, y.photon, LightPart::All, z.hero_only);
        if (scattered.is_black()) return;
        const Vec3 from = y.photon.from.vector();
        light += weight_of_merged(y.sums, y.facing * z.scatter.density(from), eye,
                                  facing * z.scatter.reverse_density(from), pass_.merging) *
                 scattered;
    });
    const double radius = pass_.grid.radius();
    return (1.0 / (kPi * radius * radius)) * light;
}

}  // namespace alhazen
