#pragma once
/// Samplers that place samples in the cells of grids.
///
/// Source: Cook, "Stochastic Sampling in Computer Graphics", ACM TOG 5(1), 1986 (jittering);
/// Shirley, "Discrepancy as a Quality Measure for Sample Distributions", Eurographics 1991
/// (n-rooks); Chiu, Shirley and Wang, "Multi-Jittered Sampling", Graphics Gems IV, 1994.
/// Differs: cells of `regular` and `jittered` have equal areas for every count: the height of a row
/// is proportional to its number of cells. `multi_jittered` chooses as many cells as there are
/// samples at random from the smallest grid that holds them.

#include <algorithm>

#include "alhazen/sampling/samplers/set_sampler.h"

namespace alhazen {

/// Rows of cells of equal area, as square as the count allows.
class EqualCells {
  public:
    explicit EqualCells(std::uint32_t count);
    /// The point of cell `i` whose coordinates within the cell are `in`, each in [0, 1].
    [[nodiscard]] Vec2 at(std::uint32_t i, const Vec2& in) const;

  private:
    std::uint32_t count_, rows_, short_row_, long_rows_;
};

/// Samples at the centres of the cells.
class RegularSampler final : public SetSampler {
  public:
    RegularSampler(std::uint64_t seed, std::uint32_t count)
        : SetSampler(seed, count), cells_(count) {}

  private:
    [[nodiscard]] Vec2 point(std::uint64_t /*key*/, std::uint32_t i) const override {
        return cells_.at(i, {0.5, 0.5});
    }
    EqualCells cells_;
};

/// Samples at a random point of each cell.
class JitteredSetSampler final : public SetSampler {
  public:
    JitteredSetSampler(std::uint64_t seed, std::uint32_t count)
        : SetSampler(seed, count), cells_(count) {}

  private:
    [[nodiscard]] Vec2 point(std::uint64_t key, std::uint32_t i) const override {
        return cells_.at(i, uniform_pair(key, i));
    }
    EqualCells cells_;
};

/// One sample in each column and in each row of count x count cells.
class RooksSampler final : public SetSampler {
  public:
    using SetSampler::SetSampler;

  private:
    [[nodiscard]] Vec2 point(std::uint64_t key, std::uint32_t i) const override;
};

/// One sample in each cell, and also one in each fine column and each fine row.
class MultiJitteredSampler final : public SetSampler {
  public:
    MultiJitteredSampler(std::uint64_t seed, std::uint32_t count);

  private:
    [[nodiscard]] Vec2 point(std::uint64_t key, std::uint32_t i) const override;
    std::uint32_t rows_, columns_;
};

}  // namespace alhazen
