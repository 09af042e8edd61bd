#pragma once
/// Compares an aggregate with brute force over the same primitives: every ray by single calls and
/// in a batch; rays of coherent sets also in batches with the hint.
///
/// Conventions: rays come in blocks of kBlockRays: tiles, shadow rays that start where the rays of
/// a tile end, and between them rays of all other kinds. A batch contains the rays of a block with
/// one mask; coherent sets are traced set by set, then all sets of the block at once. Results are
/// set to wrong values before each call, so that a result that a batch does not write disagrees.
/// The report does not depend on the number of threads.

#include <cstddef>
#include <string>
#include <vector>

#include "alhazen/primitives/aggregate.h"
#include "alhazen/verification/brute_force.h"
#include "alhazen/verification/verify.h"
#include "alhazen/verification/verify_rays.h"

namespace alhazen {

/// A hit as text, with 17 digits.
[[nodiscard]] std::string describe(const Hit& hit);
/// The count and the first four hits.
[[nodiscard]] std::string describe(const std::vector<Hit>& hits);

class QueryPathComparison {
  public:
    /// The comparison adds to `report`. All arguments must outlive the object.
    QueryPathComparison(const Aggregate& tested, const BruteForce& brute,
                        const VerifyOptions& options, VerifyReport& report);

    /// Traces `options.rays` rays, several blocks at once. `masked`: rays have the mask of one
    /// RayKind, in turn; otherwise they see everything.
    void run(VerifyRays& rays, bool masked);

  private:
    static constexpr std::size_t kBlockRays = 2048;

    /// Coherent rays of one mask in a block.
    struct RaySet {
        std::size_t first, count;
    };
    struct Block {
        // [ray] each
        std::vector<VerifyRays::Sample> samples;
        std::vector<RayMask> masks;
        std::vector<RaySet> sets;
    };
    /// Traces a block; defined beside its functions.
    class BlockComparison;

    [[nodiscard]] Block make_block(VerifyRays& rays, std::size_t count);
    void add_mixed(VerifyRays& rays, Block& block);
    /// Ends a set: the samples added since the last one.
    static void end_set(RayMask mask, Block& block);
    [[nodiscard]] std::vector<Vec3> origins_on(const RaySet& tile, RayMask mask,
                                               const Block& block) const;
    [[nodiscard]] RayMask next_mask(std::uint64_t number) const;
    void add(VerifyReport block);

    const Aggregate& tested_;
    const BruteForce& brute_;
    const VerifyOptions& options_;
    VerifyReport& report_;
    bool masked_ = false;
    std::uint64_t mixed_count_ = 0, set_count_ = 0;
};

}  // namespace alhazen
