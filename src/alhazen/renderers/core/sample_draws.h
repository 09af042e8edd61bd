#pragma once
/// The random numbers of a batch of samples. The first pairs of dimensions are drawn for all
/// remaining samples together on first use, since samples of a pixel share most of the work.
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
    /// `together`: number of pairs that are drawn for all samples together.
    SampleDraws(const Sampler& sampler, std::uint32_t together)
        : sampler_(sampler), together_(together) {}

    /// Begins a batch. `ids` must stay valid.
    void begin(std::span<const SampleId> ids) {
        ids_ = ids;
        left_.resize(ids.size());
        for (std::uint32_t i = 0; i < ids.size(); ++i) left_[i] = i;
        has_all_ = true;
        runs_.clear();
        for (Pair& pair : together_) pair.drawn = false;
    }
    /// Limits further draws to the samples `left` of the batch, a subset of those before.
    void keep(std::span<const std::uint32_t> left) {
        left_.assign(left.begin(), left.end());
        has_all_ = false;
        runs_.clear();
    }
    [[nodiscard]] Vec2 at(std::uint32_t sample, std::uint32_t pair) {
        if (pair >= together_.size()) {
            return sampler_.at(ids_[sample].pixel, pair, ids_[sample].number);
        }
        return all(pair)[sample];
    }
    /// The numbers of a pair that is drawn for all samples together, [sample]. Valid until `begin`.
    [[nodiscard]] const Vec2* all(std::uint32_t pair) {
        Pair& of = together_[pair];
        if (!of.drawn) draw_all(pair, of);
        return of.points.data();
    }

  private:
    struct Pair {
        std::vector<Vec2> points;  ///< [sample]
        bool drawn = false;
    };

    void draw_all(std::uint32_t pair, Pair& of) {
        of.drawn = true;
        if (of.points.size() < ids_.size()) of.points.resize(ids_.size());
        if (runs_.empty()) list_runs();
        if (has_all_) {
            sampler_.points_of(runs_, pair, std::span(of.points).first(ids_.size()));
            return;
        }
        if (drawn_.size() < left_.size()) drawn_.resize(left_.size());
        sampler_.points_of(runs_, pair, std::span(drawn_).first(left_.size()));
        for (std::size_t i = 0; i < left_.size(); ++i) of.points[left_[i]] = drawn_[i];
    }
    void list_runs() {
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
    }

    const Sampler& sampler_;
    std::span<const SampleId> ids_;
    std::vector<std::uint32_t> left_;  ///< samples of the batch
    bool has_all_ = true;              ///< `left_` are all, in order
    std::vector<Pair> together_;       ///< [pair]
    std::vector<SampleRun> runs_;      ///< of the samples `left_`; empty: not yet listed
    std::vector<Vec2> drawn_;          ///< [left]
};

}  // namespace alhazen
