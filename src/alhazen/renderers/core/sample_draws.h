#pragma once
/// The numbers of a batch of samples. The first pairs of dimensions are drawn for all samples that
/// are left at once, when the first of them asks: neighbours in a pixel then share most of the
/// work.
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
        left_.resize(ids.size());
        for (std::uint32_t i = 0; i < ids.size(); ++i) left_[i] = i;
        for (std::vector<Vec2>& pair : together_) pair.clear();
    }
    /// `left`: the samples of the batch that ask from now on, fewer and fewer.
    void keep(std::span<const std::uint32_t> left) { left_.assign(left.begin(), left.end()); }
    [[nodiscard]] Vec2 at(std::uint32_t sample, std::uint32_t pair) {
        if (pair >= together_.size()) {
            return sampler_.at(ids_[sample].pixel, pair, ids_[sample].number);
        }
        std::vector<Vec2>& points = together_[pair];
        if (points.empty()) draw_all(pair, points);
        return points[sample];
    }

  private:
    void draw_all(std::uint32_t pair, std::vector<Vec2>& points) {
        points.resize(ids_.size());
        runs_.clear();
        for (const std::uint32_t sample : left_) {
            const SampleId& id = ids_[sample];
            if (!runs_.empty()) {
                SampleRun& last = runs_.back();
                if (id.number == last.first + last.count && id.pixel.id() == last.pixel.id()) {
                    ++last.count;
                    continue;
                }
            }
            runs_.push_back({id.pixel, id.number, 1});
        }
        drawn_.resize(left_.size());
        sampler_.points_of(runs_, pair, drawn_);
        for (std::size_t i = 0; i < left_.size(); ++i) points[left_[i]] = drawn_[i];
    }

    const Sampler& sampler_;
    std::span<const SampleId> ids_;
    std::vector<std::uint32_t> left_;          ///< samples of the batch
    std::vector<std::vector<Vec2>> together_;  ///< [pair][sample]; empty: not yet drawn
    std::vector<SampleRun> runs_;
    std::vector<Vec2> drawn_;  ///< [left]
};

}  // namespace alhazen
