#pragma once
/// Recursive ray tracing: eye, shadow, reflection and refraction rays.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980; the
/// equation and the rules for interpolated normals of the UW CSE 457 Trace project:
///   I = ke + sum_j [ kd ILa_j + Ashadow Adist IL_j Bj (kd (N.L) + ks (N.H)+^ns) ] + kr I(Q,R) + kt
///   I(Q,T).
/// Differs: secondary rays start outside the error bound of the hit point instead of at a global
/// epsilon; shadow rays count every surface they cross once, in one query; differences between
/// formats are read from ShadingConventions; many rays of a generation are traced together
/// (wavefront.h), with the bits of the recursion.

#include <cstddef>
#include <optional>

#include "alhazen/renderers/antialias/single_rays.h"
#include "alhazen/renderers/volumes/exact_optics.h"
#include "alhazen/renderers/whitted/wave_split.h"

namespace alhazen {

class Whitted final : public SingleRayRenderer {
  public:
    /// `rays_at_once`: size of a batch, at least 1; pixels do not depend on it.
    explicit Whitted(std::size_t rays_at_once = kRaysAtOnce) : rays_at_once_(rays_at_once) {}
    /// `waves`: number of wavelengths into which dispersing glass splits a ray; 0: no dispersion.
    explicit Whitted(const OpticsSettings& optics, int waves = 0) : optics_(optics) {
        if (waves > 0) split_.emplace(waves);
    }

    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override;
    [[nodiscard]] std::unique_ptr<RayAnswers> answers(const RenderJob& job) const override;
    void adjust(ShadingConventions& c) const override { optics_.adjust(c.optics); }
    [[nodiscard]] bool heeds_optics() const override { return true; }

  private:
    [[nodiscard]] const WaveSplit* split() const { return split_ ? &*split_ : nullptr; }

    static constexpr std::size_t kRaysAtOnce = 256;
    std::size_t rays_at_once_ = kRaysAtOnce;
    OpticsSettings optics_;
    std::optional<WaveSplit> split_;
};

}  // namespace alhazen
