#include <array>

#include "alhazen/sampling/samplers/grid_samplers.h"
#include "alhazen/sampling/samplers/low_discrepancy_samplers.h"
#include "alhazen/sampling/samplers/point_set_samplers.h"
#include "alhazen/sampling/samplers/sampler.h"
#include "alhazen/sampling/samplers/sobol_sampler.h"

namespace alhazen {

namespace {

template <class S>
std::unique_ptr<Sampler> make_of_kind(std::uint64_t seed, std::uint32_t count) {
    return std::make_unique<S>(seed, count);
}

}  // namespace

std::span<const SamplerEntry> samplers() {
    static constexpr std::array<SamplerEntry, 10> kSamplers{{
        {"regular", "centres of a grid's cells, the same in every pixel", false, 0.75,
         make_of_kind<RegularSampler>},
        {"jittered", "a random point in each cell of a grid", false, 0.75,
         make_of_kind<JitteredSetSampler>},
        {"multi_jittered", "jittered, and one point in each fine column and row", false, 0.75,
         make_of_kind<MultiJitteredSampler>},
        {"n_rooks", "one point in each of as many columns and rows", false, 0.5,
         make_of_kind<RooksSampler>},
        {"poisson_disc", "random points, none nearer to another than a radius", false, 0.75,
         make_of_kind<PoissonDiscSampler>},
        {"blue_noise", "best candidates: a spectrum like that of Poisson discs, progressive", true,
         0.75, make_of_kind<BlueNoiseSampler>},
        {"hammersley", "Hammersley's set, shifted in each pixel", false, 0.75,
         make_of_kind<HammersleySampler>},
        {"halton", "Halton's sequence, scrambled in each pixel, progressive", true, 0.75,
         make_of_kind<HaltonSampler>},
        {"sobol",
         "Sobol's sequence, Owen-scrambled, dealt to the pixels as blue noise, progressive", true,
         0.75, make_of_kind<SobolSampler>},
        {"independent", "independent random points, progressive", true, 0.5,
         make_of_kind<IndependentSampler>},
    }};
    return kSamplers;
}

const SamplerEntry* find_sampler(const std::string& name) {
    for (const SamplerEntry& entry : samplers()) {
        if (name == entry.name) return &entry;
    }
    return nullptr;
}

}  // namespace alhazen
