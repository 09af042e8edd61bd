#pragma once
/// Settings of the path-based renderers.

#include <cstdint>

namespace alhazen {

struct PathSettings {
    /// Limit of `depth`: each bounce uses dimensions of the sampler and memory for a vertex.
    static constexpr int kMostDepth = 1024;

    int depth = 64;             ///< largest number of scatterings of a path
    int roulette = 4;           ///< scatterings after which a path may end by chance
    bool manifold = false;      ///< light by way of mirrors and glass is found by manifold search
    bool polarization = false;  ///< light is polarised by scattering
    /// Renderers with photons: smooth glass is followed along both branches if each has at least
    /// this share of a sample's light, else one branch is chosen at random.
    double split = 0.03;
    /// Renderers with photons: the dimmer branch at smooth glass, if below `split`, is followed by
    /// one in up to this many successive samples of a pixel, with that weight. 1, 2, 4, 8 or 16.
    /// Not used with wavelengths, since these alternate between samples, too.
    std::uint32_t turns = 16;
    /// Renderers with photons: number of shadow rays from each visible surface.
    std::uint32_t shadows = 1;
    /// photon_mapping: one in 1, 2, 4 or 8 successive samples looks up the photons at the directly
    /// visible surface, with that weight. Not with wavelengths: each set needs its own lookups.
    std::uint32_t every = 1;
    /// Largest contribution to a sample, in the largest channel or wavelength, of indirect light;
    /// with photons, of a light seen by mirrors and glass along one branch. 0: unlimited.
    double clamp = 0.0;
};

}  // namespace alhazen
