#pragma once
/// The flat shapes that the last rays of a batch were certainly occluded by, as a block of their
/// own: the filter of this one block is tried before the tree.
///
/// Source: Haines and Greenberg, "The Light Buffer: A Shadow-Testing Accelerator", IEEE CG&A 6(9),
/// 1986 (the last occluder is tested first); Corbato, "A Paging Experiment with the Multics
/// System", 1968 (those in use have a second chance). Differs: the last eight, and only those of
/// which the filter is sure (leaves/shape_filters.h). Conventions: belongs to one batch, so that
/// counts of work do not depend on earlier ones.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"

namespace alhazen {

class RecentOccluders {
  public:
    RecentOccluders();

    [[nodiscard]] const BoxBlock& block() const { return block_; }
    [[nodiscard]] bool empty() const { return !block_.ids[0].used(); }
    /// Whether the next rays are to be tested. Where few rays are occluded by the
    /// block, most are not.
    [[nodiscard]] bool worth_trying(std::uint32_t rays) {
        if (empty()) return false;
        if (credit_ > 0) return true;
        skipped_ += rays;
        if (skipped_ < kSkipped) return false;
        skipped_ = 0;
        return true;
    }
    void tried(std::uint32_t rays, std::uint32_t occluded) {
        const int change = kGain * static_cast<int>(occluded) - static_cast<int>(rays - occluded);
        credit_ = std::clamp(credit_ + change, 0, kMost);
    }
    /// The shape of a lane occluded a ray again.
    void keep(std::size_t lane) { kept_ |= 1u << lane; }
    /// Takes the place of the one that was added first, except those that have been kept since.
    void add(const BoxBlock& block, std::size_t lane);

    /// Rays that are tested together.
    static constexpr std::size_t kTogether = 8;

  private:
    /// A test in vain takes about a fifth of the time that another one saves.
    static constexpr int kGain = 4, kMost = 32;
    static constexpr std::uint32_t kSkipped = 32;

    BoxBlock block_;
    std::size_t next_ = 0;
    std::uint32_t kept_ = 0;  ///< bits of lanes
    int credit_ = kMost / 2;
    std::uint32_t skipped_ = 0;
};

}  // namespace alhazen
