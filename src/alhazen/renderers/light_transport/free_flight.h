#pragma once
/// Probabilities that a random walk passes a segment through scattering volumes, for the weights of
/// paths.
///
/// Source: Pauly, Kollig and Keller, "Metropolis Light Transport for Participating Media", EGWR
/// 2000 (densities of vertices in volumes).
/// Differs: all channels have the same weight, whichever of them drew the distance
/// (volume_scattering.h): the density depends on the segment only, neither on its direction nor on
/// how the path was found.

#include <cmath>

#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

class FreeFlight {
  public:
    /// Begins an empty segment.
    void begin() { scatters_ = false; }
    /// Adds a part in a scattering medium; `length` may be infinite.
    void add(const Spectrum& extinction, double length) {
        if (!scatters_) depth_ = {};
        scatters_ = true;
        for (int i = 0; i < Spectrum::kCount; ++i) {
            if (extinction[i] > 0.0) depth_[i] += extinction[i] * length;
        }
    }
    [[nodiscard]] bool scatters() const { return scatters_; }
    /// The probability of reaching the end of the segment.
    [[nodiscard]] double passing() const { return scatters_ ? mean(Spectrum::all(1)) : 1.0; }
    /// The density by length of stopping at its end, in a medium of that extinction.
    [[nodiscard]] double stopping(const Spectrum& extinction) const { return mean(extinction); }

  private:
    [[nodiscard]] double mean(const Spectrum& of) const {
        double sum = 0.0;
        for (int i = 0; i < Spectrum::kCount; ++i) sum += of[i] * std::exp(-depth_[i]);
        return sum / Spectrum::kCount;
    }

    Spectrum depth_;  ///< optical depth
    bool scatters_ = false;
};

}  // namespace alhazen
