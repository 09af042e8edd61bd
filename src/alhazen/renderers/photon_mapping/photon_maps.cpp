#include "alhazen/renderers/photon_mapping/photon_maps.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/photons/photon_passes.h"
#include "alhazen/renderers/photons/photon_shooting.h"
#include "alhazen/renderers/photons/projection_map.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

/// Number of sets of four wavelengths.
constexpr std::uint32_t kWaveSets = 16;

/// The share of one set, rounded up.
std::uint64_t share_of(std::uint64_t photons, const PhotonMaps& maps) {
    return (photons + maps.pairs.size() - 1) / maps.pairs.size();
}

/// Adds the photons of a shot to the maps. False after a stop.
bool fill(const RenderJob& job, const Illumination& lights, const PhotonShot& shot,
          const PhotonMappingSettings& settings, PhotonMaps& maps, PhotonMap& map,
          PhotonMap& in_volumes) {
    double taken = 0.0;
    for (const PhotonMapPair& pair : maps.pairs) {
        for (const PhotonMap* other :
             {&pair.caustic, &pair.global, &pair.caustic_in_volumes, &pair.global_in_volumes}) {
            taken += static_cast<double>(other->tree.photons().size());
        }
    }
    const double most = std::min(settings.memory * 1e6 / PhotonTree::kBytesOfPhoton - taken,
                                 double{std::numeric_limits<std::uint32_t>::max()});
    ShotPhotons shot_photons = shoot_photons(
        job, lights, shot, most > 0.0 ? static_cast<std::size_t>(most) : 0, "photon_mapping");
    maps.counters += shot_photons.counters;
    if (!shot_photons.complete) return maps.complete = false;
    ThreadLimit threads(job.control.threads);
    const std::uint64_t nearest = share_of(static_cast<std::uint64_t>(settings.nearest), maps);
    const auto build = [&](std::vector<Photon> photons, PhotonMap& of) {
        threads.run([&] { of.tree = PhotonTree(std::move(photons)); });
        of.nearest = std::max<std::size_t>(2, nearest);
        of.filter = settings.filter;
        of.radius = settings.radius > 0.0 ? settings.radius : usual_radius(of.tree, of.nearest);
    };
    build(std::move(shot_photons.photons), map);
    build(std::move(shot_photons.in_volumes), in_volumes);
    return true;
}

/// Fills both maps of a set. `seed`: of the previous photons, then of these; `projection`: made by
/// the first set. False after a stop.
bool fill_pair(const RenderJob& job, const Illumination& lights,
               const PhotonMappingSettings& settings, std::size_t set, std::uint64_t& seed,
               std::optional<ProjectionMap>& projection, PhotonMaps& maps) {
    PhotonMapPair& pair = maps.pairs[set];
    PhotonKinds kinds{PhotonKind::Indirect};
    if (settings.gather > 0) {
        kinds = {PhotonKind::Direct, PhotonKind::Caustic, PhotonKind::Indirect};
    } else if (settings.caustics == 0) {
        kinds = {PhotonKind::Caustic, PhotonKind::Indirect};
    }
    seed = mix64(seed);
    PhotonKinds in_volumes{PhotonKind::Indirect};
    if (settings.caustics == 0) in_volumes = {PhotonKind::Caustic, PhotonKind::Indirect};
    PhotonShot shot{share_of(settings.photons, maps), kinds, settings.paths.depth, seed,
                    &maps.waves[set]};
    shot.in_volumes = in_volumes;
    if (!fill(job, lights, shot, settings, maps, pair.global, pair.global_in_volumes)) {
        return false;
    }
    if (settings.irradiance) {
        ThreadLimit threads(job.control.threads);
        threads.run([&] { compute_irradiance(pair.global, job.control.stop); });
        if (job.stop_requested()) return maps.complete = false;
    }
    if (settings.caustics == 0) return true;
    seed = mix64(seed);
    shot.count = share_of(settings.caustics, maps);
    shot.kinds = shot.in_volumes = {PhotonKind::Caustic};
    shot.seed = seed;
    if (settings.projection && !projection) {
        ThreadLimit threads(job.control.threads);
        threads.run([&] { projection.emplace(job, lights, mix64(seed), maps.counters); });
    }
    if (projection) shot.projection = &*projection;
    return fill(job, lights, shot, settings, maps, pair.caustic, pair.caustic_in_volumes);
}

}  // namespace

PhotonMaps make_photon_maps(const RenderJob& job, const Illumination& lights,
                            const PhotonMappingSettings& settings) {
    PhotonMaps maps;
    const std::uint32_t sets = job.spectral ? kWaveSets : 1;
    for (std::uint32_t k = 0; k < sets; ++k) maps.waves.push_back(waves_of_pass(job, k));
    maps.pairs.resize(sets);
    if (!lights.emits()) return maps;
    std::uint64_t seed = job.seed;
    std::optional<ProjectionMap> projection;
    for (std::size_t k = 0; k < sets; ++k) {
        if (!fill_pair(job, lights, settings, k, seed, projection, maps)) break;
    }
    return maps;
}

}  // namespace alhazen
