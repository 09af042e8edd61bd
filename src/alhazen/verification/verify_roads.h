#pragma once
/// Compares an aggregate with brute force over the same primitives: every ray by single calls and
/// in a batch, rays of coherent sets in batches with the hint too.
///
/// Conventions: rays come in blocks of kBlockRays: tiles, shadow rays that start where the rays of
/// a tile end, and between them rays of all other kinds. A batch has the rays of a block with one
/// mask; coherent sets are shot set by set, then all sets of the block at once. Results hold wrong
/// values before each call: a batch that leaves one unwritten disagrees.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alhazen/primitives/aggregate.h"
#include "alhazen/verification/verify.h"
#include "alhazen/verification/verify_rays.h"

namespace alhazen {

/// A hit as text, with 17 digits.
[[nodiscard]] std::string describe(const Hit& hit);
/// The count and the first four hits.
[[nodiscard]] std::string describe(const std::vector<Hit>& hits);

class RoadComparison {
  public:
    /// Adds to `report`. All arguments must outlive the object.
    RoadComparison(const Aggregate& tested, const Aggregate& brute, const VerifyOptions& options,
                   VerifyReport& report);

    /// Shoots `options.rays` rays. `masked`: each sees what rays of one RayKind see, in turn; else
    /// rays see everything.
    void run(VerifyRays& rays, bool masked);

  private:
    /// Coherent rays of one mask in a block.
    struct RaySet {
        std::size_t first, count;
    };
    static constexpr std::size_t kBlockRays = 2048;

    // ---- Make a block of at most `count` rays.
    void make_block(VerifyRays& rays, std::size_t count);
    void add_mixed(VerifyRays& rays);
    /// The samples added since the last set.
    void end_set(RayMask mask);
    void find_origins(const RaySet& tile, RayMask mask);
    [[nodiscard]] RayMask next_mask(std::uint64_t number) const;

    // ---- Compare.
    void shoot_singles(std::uint64_t done);
    void compare_single(std::size_t i);
    void shoot_stream();
    void shoot_coherent();
    /// Takes the rays of `chosen_` through the batch calls, those of each mask together.
    void shoot_by_mask(Road road);
    void shoot_batch(Road road, std::span<const std::size_t> chosen, RayMask mask);
    void disagree(std::size_t i, Road road, const char* query, std::string found,
                  std::string expected);
    [[nodiscard]] RoadCounts& counts(Road road) {
        return report_.roads[static_cast<std::size_t>(road)];
    }

    const Aggregate& tested_;
    const Aggregate& brute_;
    const VerifyOptions& options_;
    VerifyReport& report_;
    bool masked_ = false;
    std::uint64_t mixed_count_ = 0, set_count_ = 0;

    // Of the block, [ray] each.
    std::vector<VerifyRays::Sample> samples_;
    std::vector<RayMask> masks_;
    std::vector<Hit> expected_;  ///< the nearest, by brute force

    std::vector<RaySet> sets_;
    std::vector<Vec3> origins_;
    std::vector<Hit> tested_hits_, brute_hits_;
    // Of a batch.
    std::vector<std::size_t> chosen_, of_mask_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::unique_ptr<bool[]> occluded_;
};

}  // namespace alhazen
