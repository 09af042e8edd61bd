#pragma once
/// The production accelerator: a wide bounding volume hierarchy, traversed with SIMD. Its leaves
/// are blocks of eight triangles, spheres, cylinders or boxes around any other primitives.
///
/// Source: see the headers of accel/wide_bvh/.
/// Differs: boxes and the triangle filter are float but conservative with respect to tests in
/// double (aggregates/wide_bvh/leaves/triangle_filter.h), so the hits are
/// those of brute force, bit for bit.
/// Conventions: those of `Aggregate`. Primitives without a finite box are tested first, outside
/// the tree.
/// Complexity and threads: built in parallel; const functions may be called from many threads; no
/// allocation per ray, except for the hits that are asked for.

#include <filesystem>
#include <memory>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/refit.h"
#include "alhazen/aggregates/wide_bvh/schedule.h"
#include "alhazen/aggregates/wide_bvh/treeless_packets.h"
#include "alhazen/aggregates/wide_bvh/unbounded_parts.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

class WideBvhAggregate final : public Aggregate {
  public:
    explicit WideBvhAggregate(PrimitiveTable table, const BuildOptions& options = {});
    /// With a stored tree (aggregates/wide_bvh/wide_bvh_file.h) over a table like this finished
    /// one. Throws Error (File) with the reason if the tree does not fit.
    [[nodiscard]] static std::shared_ptr<const WideBvhAggregate> load(
        PrimitiveTable table, const std::filesystem::path& file);
    /// Stores the tree. Throws Error (File) on failure.
    void save(const std::filesystem::path& file) const;

    /// Refits the tree to the same primitives in other places (aggregates/wide_bvh/refit.h). No
    /// query may run meanwhile. Throws Error(Usage), without effect, if the tree must be built
    /// anew. After any other exception, such as std::bad_alloc, the hits are undefined until a
    /// refit succeeds.
    RefitReport refit(PrimitiveTable moved);

    [[nodiscard]] const PrimitiveTable& primitives() const override { return table_; }
    [[nodiscard]] Box3 box() const override { return box_; }
    [[nodiscard]] std::size_t memory_bytes() const override;
    [[nodiscard]] const WideBvhLayout& layout() const { return layout_; }

    [[nodiscard]] bool closest(const Ray& ray, Hit& hit, RayQuery query) const override;
    [[nodiscard]] bool occluded(const Ray& ray, RayQuery query) const override;
    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const override;
    [[nodiscard]] bool shadowed(const Ray& ray, std::vector<Hit>& crossings,
                                RayQuery query) const override;
    /// With Precision::Fast, adds to the error bound of a triangle's point what the test in float
    /// needs to miss the triangle for a ray that leaves it (docs/design/triangles.md, Fast mode).
    void complete(const Ray& ray, double t, PrimitiveId primitive, Surface& surface) const override;
    [[nodiscard]] bool completes_surfaces() const override { return precision_ == Precision::Fast; }
    [[nodiscard]] bool gains_by_batches(Coherence coherence) const override {
        return schedules_.gain_by_batches(coherence);
    }
    void closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                       Coherence coherence = Coherence::Any) const override;
    void occluded_batch(std::span<const Ray> rays, std::span<bool> occluded, RayQuery query,
                        Coherence coherence = Coherence::Any) const override;
    void closest_columns(const RayColumns& rays, const HitColumns& hits, RayQuery query,
                         Coherence coherence = Coherence::Any) const override;
    void occluded_columns(const RayColumns& rays, std::span<bool> occluded, RayQuery query,
                          Coherence coherence = Coherence::Any) const override;

  private:
    WideBvhAggregate(PrimitiveTable table, const std::filesystem::path& file);

    /// Sets the members that depend on the table and the layout.
    void finish_build();
    /// Whether all that a query may see is in the tree, and nothing is counted.
    [[nodiscard]] bool asks_tree_alone(const RayQuery& query) const {
        return only_tree_ && query.stats == nullptr && query.mask == kAllRays;
    }
    /// As `closest` and `occluded`, for every scene and query. Out of line: most rays need neither
    /// a scene of their own nor the room for it.
    [[nodiscard, gnu::noinline]] bool closest_of_any(const Ray& ray, Hit& hit,
                                                     RayQuery query) const;
    [[nodiscard, gnu::noinline]] bool occluded_by_any(const Ray& ray, RayQuery query) const;
    [[nodiscard]] WideBvhScene scene(RayMask mask) const { return {table_, layout_, mask}; }
    [[nodiscard]] WideBvhScene batch_scene(RayMask mask) const {
        WideBvhScene seen = scene(mask);
        seen.waits = schedules_.waits();
        seen.others_alone = schedules_.others_alone();
        return seen;
    }
    /// The same for packets, some of which are not tried after `failures` of earlier ones; of
    /// queries that count, all are.
    [[nodiscard]] WideBvhScene packet_scene(const RayQuery& query, PacketFailures& failures) const {
        WideBvhScene seen = batch_scene(query.mask);
        if (query.stats == nullptr) seen.failures = &failures;
        return seen;
    }
    /// Traces a part of a batch. Precondition: `hits` are empty, if not `unset`.
    void trace_closest(std::span<const Ray> rays, std::span<Hit> hits, bool unset, RayQuery query,
                       Coherence coherence) const;
    /// Whether the packets of the tree take a batch and set all of its results.
    [[nodiscard]] bool takes_whole(Coherence coherence) const {
        return schedules_.of_batch(coherence) == Schedule::Packets && outside_.empty() &&
               !layout_.tree.empty;
    }
    /// Whether the stream traces a batch of `count` rays, and nothing is outside of the tree.
    [[nodiscard]] bool streams_alone(Coherence coherence, std::size_t count) const {
        return schedules_.of_batch(coherence, count) == Schedule::Stream && outside_.empty() &&
               !layout_.tree.empty;
    }
    /// Sorts the hits that a query appended, and removes duplicates.
    void finish_hits(std::vector<Hit>& hits, std::size_t before) const;

    PrimitiveTable table_;
    Box3 box_;
    std::vector<PrimitiveId> unbounded_;
    UnboundedParts outside_;    ///< those of `unbounded_`
    TreelessPackets treeless_;  ///< all primitives of the tree, or none
    WideBvhLayout layout_;
    Precision precision_ = Precision::Robust;
    Schedules schedules_;
    double built_cost_ = 0;  ///< of the tree before any refit
    WideBvhKernelPair kernels_;
    WideBvhScene all_{table_, layout_};  ///< for rays that see everything
    bool only_tree_ = false;             ///< every primitive is in the tree, which is not empty
    mutable PacketFailures closest_failures_{0}, occluded_failures_{0};
};

}  // namespace alhazen
