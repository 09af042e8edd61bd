#pragma once
/// Traces single photons from a light through the scene; stored at each surface that scatters with
/// a density, and at each scattering event in a volume.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 3; Arvo and Kirk,
/// "Particle Transport and Image Synthesis", SIGGRAPH 1990 (Russian roulette); Jensen and
/// Christensen, "Efficient Simulation of Light Transport in Scenes with Participating Media using
/// Photon Maps", SIGGRAPH 1998 (photons in volumes).
/// Differs: directions are sampled from the whole BSDF; the roulette keeps the largest channel of a
/// photon at its initial value, while its colour changes. Shading normals: Veach's factor.
/// Conventions: photons are numbered. The path of a photon depends only on the scene, the seed and
/// its number. A photon in a volume stands for fluence: power times the length of its path there.
/// Surfaces passed straight (thin sheets) receive light and are no events; null boundaries receive
/// none. No photon is stored where squared distances may be infinite.

#include <cstdint>
#include <memory>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/light_transport/light_starts.h"
#include "alhazen/renderers/photons/next_surface.h"
#include "alhazen/renderers/photons/photon.h"
#include "alhazen/renderers/photons/projection_map.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

/// The parameters of a shot.
struct PhotonShot {
    std::uint64_t count = 0;  ///< number of emitted photons
    PhotonKinds kinds;        ///< kinds to be stored
    int depth = 64;           ///< largest number of surfaces
    std::uint64_t seed = 0;
    const Wavelengths* waves = &kColorChannels;  ///< wavelengths of all photons at emission
    const ProjectionMap* projection = nullptr;   ///< directions of emission; null: unrestricted
    PhotonKinds in_volumes;                      ///< kinds to be stored in volumes
    ShutterPart shutter{};                       ///< interval of their times
};

class PhotonWalk {
  public:
    PhotonWalk(const Scene& scene, const Illumination& lights, const PhotonShot& shot,
               RayCounters& counters, TraversalStats* stats);

    /// Traces photon `number` of 0 .. count - 1 and appends its records. False if its light gave it
    /// no power.
    bool shoot(std::uint64_t number, std::vector<Photon>& stored);

  private:
    [[nodiscard]] LightRay leave_light(std::uint64_t number) const;
    /// The kind of the first segment of a photon whose light is found by either.
    [[nodiscard]] FirstSegment choose_first(PathEnd& path, const PathNumbers& numbers) const;
    /// For lights at a place: ratio of the light's falloff to that of its rays.
    [[nodiscard]] Spectrum falloff(const LightRay& light, const Vec3& point, double distance) const;
    void store(PhotonKind kind, const Spectrum& power, const Wavelengths& waves,
               std::vector<Photon>& stored) const;
    void store_in_volume(PhotonKind kind, const Spectrum& fluence, const Wavelengths& waves,
                         std::vector<Photon>& stored) const;
    [[nodiscard]] bool survives_roulette(PathEnd& path, const Spectrum& begun,
                                         const PathNumbers& numbers, std::uint64_t dimension) const;

    const Scene& scene_;
    const Illumination& lights_;
    PhotonShot shot_;
    bool caustics_only_;
    std::unique_ptr<Sampler> sampler_;  ///< for the rays that leave lights
    LightStarts starts_;
    NextSurface next_;
    ScatterPoint scatter_;
};

}  // namespace alhazen
