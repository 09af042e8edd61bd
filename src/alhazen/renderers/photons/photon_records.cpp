#include "alhazen/renderers/photons/photon_records.h"

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/core/local_shading.h"

namespace alhazen {

void add_to_cloud(std::span<const Photon> photons, bool caustic, PhotonCloud* cloud,
                  const Wavelengths& waves) {
    if (cloud == nullptr) return;
    for (const Photon& photon : photons) {
        const Vec3 along = -photon.from.vector();
        const Rgb power = waves.color(photon.light());
        cloud->photons.push_back({photon.position,
                                  {static_cast<float>(along.x), static_cast<float>(along.y),
                                   static_cast<float>(along.z)},
                                  {static_cast<float>(power.r), static_cast<float>(power.g),
                                   static_cast<float>(power.b)},
                                  static_cast<std::uint8_t>(caustic)});
    }
}

void record_photon_layer(const RenderJob& job, const Film& film, const PhotonCount& count) {
    if (job.aovs == nullptr || !job.aovs->wanted().has(AovKind::Photons)) return;
    const PixelBox& crop = film.crop();
    ThreadLimit threads(job.control.threads);
    threads.run([&] {
        parallel_for(std::size_t(crop.height()), 1, [&](std::size_t begin, std::size_t end) {
            VisibleHit seen;
            for (std::size_t row = begin; row < end && !job.stop_requested(); ++row) {
                const int y = crop.y0 + static_cast<int>(row);
                for (int x = crop.x0; x < crop.x1; ++x) {
                    const Ray ray = eye_ray(job.camera, (x + 0.5) / film.frame_width(),
                                            1.0 - (y + 0.5) / film.frame_height());
                    if (!first_visible_hit(job.scene, ray, {}, false, nullptr, seen)) continue;
                    const double here = count(seen.point.surface.point, seen.point.geometric);
                    job.aovs->set(AovKind::Photons, x, y, {&here, 1});
                }
            }
        });
    });
}

}  // namespace alhazen
