#pragma once
/// Settings of the renderers of paths.

#include <cstdint>

namespace alhazen {

struct PathSettings {
    /// Each bounce has its own dimensions of the sampler, and a vertex in memory.
    static constexpr int kMostDepth = 1024;

    int depth = 64;             ///< largest number of scatterings of a path
    int roulette = 4;           ///< scatterings after which a path may end by chance
    bool manifold = false;      ///< chains of mirrors and glass are sought from each surface
    bool polarization = false;  ///< light is polarised, and seen to be
    /// Of renderers with photons: where smooth glass reflects and refracts at least this share of a
    /// sample's light, both ways are followed, else one by chance.
    double split = 0.03;
    /// Of the same: the dimmer way at smooth glass that has less than `split` is followed by one of
    /// up to so many successive samples of a pixel, and counts as often. 1, 2, 4, 8 or 16. Not
    /// with wavelengths, which samples have in turn, too.
    std::uint32_t turns = 16;
    /// Of the same: shadow rays from each surface that is seen.
    std::uint32_t shadows = 1;
    /// Of photon_mapping: of 1, 2, 4 or 8 successive samples one looks at the photons of the
    /// surface that it sees straight, and counts for all. Not with wavelengths, of which each set
    /// needs its looks.
    std::uint32_t every = 1;
    /// Largest contribution of indirect light to a sample, with photons that of a lamp seen by way
    /// of mirrors and glass along one branch of its path, by the largest channel or wavelength;
    /// 0: none.
    double clamp = 0.0;
};

}  // namespace alhazen
