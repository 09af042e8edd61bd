#include "alhazen/renderers/photon_mapping/photon_maps.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/photons/photon_shooting.h"
#include "alhazen/renderers/photons/projection_map.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

/// Bytes of a photon while its map is built: itself, its place and its number.
constexpr double kBytesOfPhoton = sizeof(Photon) + 9;

/// Adds the photons of a shot to the maps. False after a stop.
bool fill(const RenderJob& job, const Illumination& lights, const PhotonShot& shot,
          const PhotonMappingSettings& settings, PhotonMaps& maps, PhotonMap& map) {
    const double taken =
        static_cast<double>(maps.caustic.tree.photons().size() + maps.global.tree.photons().size());
    const double most = std::min(settings.memory * 1e6 / kBytesOfPhoton - taken,
                                 double{std::numeric_limits<std::uint32_t>::max()});
    ShotPhotons shot_photons = shoot_photons(
        job, lights, shot, most > 0.0 ? static_cast<std::size_t>(most) : 0, "photon_mapping");
    maps.counters += shot_photons.counters;
    if (!shot_photons.complete) return maps.complete = false;
    ThreadLimit threads(job.control.threads);
    threads.run([&] { map.tree = PhotonTree(std::move(shot_photons.photons)); });
    map.nearest = static_cast<std::size_t>(settings.nearest);
    map.filter = settings.filter;
    map.radius = settings.radius > 0.0 ? settings.radius : usual_radius(map.tree, map.nearest);
    return true;
}

}  // namespace

PhotonMaps make_photon_maps(const RenderJob& job, const Illumination& lights,
                            const PhotonMappingSettings& settings) {
    PhotonMaps maps;
    if (!lights.shines()) return maps;
    PhotonKinds kinds{PhotonKind::Indirect};
    if (settings.gather > 0) {
        kinds = {PhotonKind::Direct, PhotonKind::Caustic, PhotonKind::Indirect};
    } else if (settings.caustics == 0) {
        kinds = {PhotonKind::Caustic, PhotonKind::Indirect};
    }
    PhotonShot shot{settings.photons, kinds, settings.paths.depth, mix64(job.seed)};
    if (!fill(job, lights, shot, settings, maps, maps.global) || settings.caustics == 0) {
        return maps;
    }
    shot.count = settings.caustics;
    shot.kinds = {PhotonKind::Caustic};
    shot.seed = mix64(shot.seed);
    std::optional<ProjectionMap> projection;
    if (settings.projection) {
        ThreadLimit threads(job.control.threads);
        threads.run([&] { projection.emplace(job, lights, mix64(shot.seed), maps.counters); });
        shot.projection = &*projection;
    }
    fill(job, lights, shot, settings, maps, maps.caustic);
    return maps;
}

}  // namespace alhazen
