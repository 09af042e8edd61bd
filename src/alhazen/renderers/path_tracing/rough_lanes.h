#pragma once
/// BSDFs of a single rough reflection at VertexLanes: values, densities and next directions.
///
/// Source: those of RoughReflection.
/// Conventions: the bits are those of `Bsdf::value`, `density` and `sample`, one lane after the
/// other.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "alhazen/renderers/path_tracing/vertex_lanes.h"
#include "alhazen/shading/bsdf/bsdf.h"
#include "alhazen/shading/microfacets/anisotropic_albedo.h"
#include "alhazen/shading/microfacets/ggx_albedo.h"

namespace alhazen {

/// A BSDF of a single rough reflection.
struct RoughLobe {
    Ggx ggx;
    Vec2 axis;
    double mean_single;
    Spectrum several, f0, f90, weight;
    AlbedoTable::Slice singles;  ///< of equal alphas
    std::optional<AnisotropicAlbedo> anisotropic;

    /// Single-scattering albedo.
    [[nodiscard]] double single(const Vec3& v) const {
        if (!anisotropic) return singles.at(v.z);
        return anisotropic->at({axis.x * v.x + axis.y * v.y, axis.x * v.y - axis.y * v.x, v.z});
    }
    /// Null for other BSDFs.
    [[nodiscard]] static std::unique_ptr<const RoughLobe> of(const Bsdf& bsdf);
};

class RoughLanes {
  public:
    static constexpr std::size_t kMost = VertexLanes::kMost;

    RoughLanes();

    /// Adds a lane for `scatter`. `choice`: that of `Bsdf::sample`. The lobe must outlive the
    /// object, unchanged.
    void set(std::size_t lane, const RoughLobe& lobe, double choice);
    /// Removes all lanes.
    void clear() { numbers_.lanes = 0; }
    /// After VertexLanes::scatter: replaces its results in the lanes added.
    void scatter(VertexLanes& vertices);

    /// Input and output of the kernels.
    struct Numbers {
        using Lane = VertexLanes::Numbers;

        alignas(64) Lane alpha[2] = {}, axis[2] = {};
        alignas(64) Lane mean_single = {};
        alignas(64) VertexLanes::Spectra several = {}, f0 = {}, f90 = {}, weight = {};
        alignas(64) Lane choice = {};
        /// Single-scattering albedos for the view, the direction to the light and the next one.
        alignas(64) Lane of_view = {}, of_light = {}, of_next = {};
        std::uint32_t lanes = 0;
    };

  private:
    Numbers numbers_;
    std::array<const RoughLobe*, kMost> lobes_{};
};

}  // namespace alhazen
