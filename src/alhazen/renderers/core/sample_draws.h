#pragma once
/// The numbers of a batch of samples. The first pairs of dimensions are drawn for all samples at
/// once, when the first of them asks: neighbours in a pixel then share most of the work.
///
/// Conventions: values are those of Sampler::at. Threads: used by one thread.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/renderers/core/estimator.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

class SampleDraws {
  public:
    /// `together`: pairs that most samples use.
    SampleDraws(const Sampler& sampler, std::uint32_t together)
        : sampler_(sampler), together_(together) {}

    /// `ids`: of the samples from now on; they must stay valid.
    void begin(std::span<const SampleId> ids) {
        ids_ = ids;
        for (std::vector<Vec2>& pair : together_) pair.clear();
    }
    [[nodiscard]] Vec2 at(std::uint32_t sample, std::uint32_t pair) {
        if (pair >= together_.size()) {
            return sampler_.at(ids_[sample].pixel, pair, ids_[sample].number);
        }
        std::vector<Vec2>& points = together_[pair];
        if (points.empty()) draw_all(pair, points);
        return points[sample];
    }

  private:
    void draw_all(std::uint32_t pair, std::vector<Vec2>& points) const {
        points.resize(ids_.size());
        for (std::size_t i = 0, end = 0; i < ids_.size(); i = end) {
            const auto goes_on = [&](std::size_t k) {
                return ids_[k].pixel.id() == ids_[i].pixel.id() &&
                       ids_[k].number == ids_[i].number + (k - i);
            };
            for (end = i + 1; end < ids_.size() && goes_on(end);) ++end;
            sampler_.points(ids_[i].pixel, pair, ids_[i].number,
                            std::span(points).subspan(i, end - i));
        }
    }

    const Sampler& sampler_;
    std::span<const SampleId> ids_;
    std::vector<std::vector<Vec2>> together_;  ///< [pair][sample]; empty: not yet drawn
};

}  // namespace alhazen
