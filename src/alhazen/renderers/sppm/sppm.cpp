#include "alhazen/renderers/sppm/sppm.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "alhazen/illumination/illumination.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/photons/photon_density.h"
#include "alhazen/renderers/photons/photon_eye.h"
#include "alhazen/renderers/photons/photon_grid.h"
#include "alhazen/renderers/photons/photon_passes.h"
#include "alhazen/renderers/photons/photon_records.h"
#include "alhazen/renderers/photons/photon_shooting.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr std::size_t kEyePathsAtOnce = 256;

/// The eye part of one pass.
class PassEye final : public PhotonEye {
  public:
    PassEye(const RenderJob& job, std::size_t, RayCounters& counters, const Illumination& lights,
            const PathSettings& paths, const PhotonGrid& grid, const PhotonGrid& in_volumes,
            const Wavelengths* waves)
        : PhotonEye(job, counters, lights, paths, {waves, 1}),
          grid_(grid),
          in_volumes_(in_volumes) {}

  private:
    [[nodiscard]] Spectrum photon_light(const SeenPoint& at) override {
        const PhotonFits fits(at.scatter);
        const PhotonScattering scattered(at.scatter, LightPart::NotGlossy,
                                         at.path.waves->hero_only());
        Spectrum sum;
        grid_.for_near(at.surface.point, [&](const Photon& photon) {
            if (fits(photon)) sum += scattered(photon);
        });
        return (1.0 / (kPi * grid_.radius() * grid_.radius())) * sum;
    }

    [[nodiscard]] Spectrum photon_light(const SeenVolume& at) override {
        const bool hero_only = at.path.waves->hero_only();
        Spectrum sum;
        in_volumes_.for_near(at.place.point, [&](const Photon& photon) {
            sum += scattered_light(at.place, photon, hero_only);
        });
        const double r = in_volumes_.radius();
        return (3.0 / (4.0 * kPi * r * r * r)) * sum;
    }

    const PhotonGrid& grid_;
    const PhotonGrid& in_volumes_;
};

void record_photons_of(const PhotonGrid& grid, const RenderJob& job, const Film& film) {
    record_photon_layer(job, film, [&](const Vec3& point, const Vec3& normal) {
        const PhotonFits fits(normal, false);
        double count = 0.0;
        grid.for_near(point, [&](const Photon& photon) { count += fits(photon) ? 1.0 : 0.0; });
        return count / (kPi * grid.radius() * grid.radius());
    });
}

}  // namespace

RenderReport Sppm::render(const RenderJob& job, Film& film) const {
    PhotonPasses passes(job, film, "sppm");
    const Illumination lights(job.scene);
    double radius = settings_.radius > 0.0 ? settings_.radius : radius_of_pixels(job, film);
    double in_volumes_radius = radius;
    PhotonShot shot{settings_.photons,
                    {PhotonKind::Caustic, PhotonKind::Indirect},
                    settings_.paths.depth,
                    mix64(job.seed)};
    shot.in_volumes = shot.kinds;
    const auto most = static_cast<std::size_t>(
        std::min(settings_.memory * 1e6 / PhotonGrid::kBytesOfPhoton, 0x1p31));
    note_silent_lights(lights, "sppm", passes.report());
    for (std::uint32_t pass = 0; pass < passes.count(); ++pass) {
        const Wavelengths waves = waves_of_pass(job, pass);
        shot.waves = &waves;
        shot.shutter = shutter_of_pass(passes.job(), pass);
        ShotPhotons photons;
        if (lights.emits()) photons = shoot_photons(passes.job(), lights, shot, most, "sppm");
        passes.report().counters += photons.counters;
        if (!photons.complete) return passes.stopped();
        if (pass == 0) {
            add_to_cloud(photons.photons, false, job.photons, waves);
            add_to_cloud(photons.in_volumes, false, job.photons, waves);
        }
        const PhotonGrid grid(std::move(photons.photons), radius);
        const PhotonGrid in_volumes(std::move(photons.in_volumes), in_volumes_radius);
        if (pass == 0) record_photons_of(grid, job, film);
        const bool complete = passes.look([&](const RenderJob& part) {
            return std::make_unique<RoundRenderer<PassEye>>(
                part, kEyePathsAtOnce, lights, settings_.paths, grid, in_volumes, &waves);
        });
        if (!complete) break;
        shot.seed = mix64(shot.seed);
        // Radii on surfaces shrink by area, in volumes by volume.
        const double step = squared_radius_step(settings_.alpha, static_cast<int>(pass) + 1);
        radius *= std::sqrt(step);
        in_volumes_radius *= std::cbrt(step);
    }
    return passes.report();
}

}  // namespace alhazen
