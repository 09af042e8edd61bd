#pragma once
/// How likely walks are to get along a way through volumes that scatter, for the weights of paths.
///
/// Source: Pauly, Kollig and Keller, "Metropolis Light Transport for Participating Media", EGWR
/// 2000 (densities of vertices in volumes).
/// Differs: channels count alike, whichever of them drew the distance (volume_scattering.h), so
/// that the density depends on the way alone: not on its direction, nor on how a path was found.

#include <cmath>

#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

class FreeFlight {
  public:
    /// Of a way without parts.
    void begin() { scatters_ = false; }
    /// A part of the way, in a medium that scatters; `length` may be infinite.
    void add(const Spectrum& extinction, double length) {
        if (!scatters_) depth_ = {};
        scatters_ = true;
        for (int i = 0; i < Spectrum::kCount; ++i) {
            if (extinction[i] > 0.0) depth_[i] += extinction[i] * length;
        }
    }
    [[nodiscard]] bool scatters() const { return scatters_; }
    /// The probability of coming to its end.
    [[nodiscard]] double passing() const { return scatters_ ? mean(Spectrum::all(1)) : 1.0; }
    /// By length: of being scattered at its end, in a medium of that extinction.
    [[nodiscard]] double stopping(const Spectrum& extinction) const { return mean(extinction); }

  private:
    [[nodiscard]] double mean(const Spectrum& of) const {
        double sum = 0.0;
        for (int i = 0; i < Spectrum::kCount; ++i) sum += of[i] * std::exp(-depth_[i]);
        return sum / Spectrum::kCount;
    }

    Spectrum depth_;  ///< optical
    bool scatters_ = false;
};

}  // namespace alhazen
