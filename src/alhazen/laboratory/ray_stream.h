#pragma once
/// Records the rays of a picture, so that every accelerator traces the same rays.
///
/// Source: Kirk and Arvo, "Improved Ray Tagging for Voxel-Based Ray Tracing", Graphics Gems II,
/// 1991, and Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987 (rays
/// and tests by kind).
/// Differs: rays are recorded between renderer and accelerator, in the renderer's batches.
/// Conventions: kinds of rays are those of geometry/ray_mask.h. For a large picture a random share
/// of the batches is recorded (fixed seed).

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/geometry/ray_mask.h"
#include "alhazen/primitives/aggregate.h"

namespace alhazen {

/// The kind of query.
enum class RayQuestion : std::uint8_t { Closest, Occluded, Shadowed };

/// A batch of rays, contiguous in the stream.
struct RayBatch {
    std::size_t first = 0;
    std::size_t count = 0;
    RayKind kind = RayKind::Eye;
    RayQuestion question = RayQuestion::Closest;
    Coherence coherence = Coherence::Any;
    double lot = 0;  ///< random, in [0, 1): batches below RayStream::share are kept
};

struct RayStream {
    std::vector<Ray> rays;
    std::vector<RayBatch> batches;
    double share = 1;              ///< share of the batches that is kept
    std::size_t most = 2'000'000;  ///< number of rays above which half of the batches are dropped

    /// Recorded rays by kind.
    [[nodiscard]] std::array<std::uint64_t, kRayKindCount> by_kind() const;
    /// Halves the share.
    void thin_out();
};

/// Forwards every query to another aggregate and records it. One thread at a time. Queries must
/// state the kind of ray (Scene::has_masks).
class RayRecorder final : public Aggregate {
  public:
    /// `asked` and `stream` must outlive the recorder.
    RayRecorder(const Aggregate& asked, RayStream& stream) : asked_(asked), stream_(stream) {}

    [[nodiscard]] const PrimitiveTable& primitives() const override { return asked_.primitives(); }
    [[nodiscard]] Box3 box() const override { return asked_.box(); }
    [[nodiscard]] std::size_t memory_bytes() const override { return asked_.memory_bytes(); }
    [[nodiscard]] bool changes_materials() const override { return asked_.changes_materials(); }
    [[nodiscard]] bool completes_surfaces() const override { return asked_.completes_surfaces(); }
    [[nodiscard]] bool closest(const Ray& ray, Hit& hit, RayQuery query) const override;
    [[nodiscard]] bool occluded(const Ray& ray, RayQuery query) const override;
    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const override;
    [[nodiscard]] bool shadowed(const Ray& ray, std::vector<Hit>& crossings,
                                RayQuery query) const override;
    void complete(const Ray& ray, double t, PrimitiveId primitive, Surface& surface) const override;
    void closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                       Coherence coherence) const override;
    void occluded_batch(std::span<const Ray> rays, std::span<bool> occluded, RayQuery query,
                        Coherence coherence) const override;

  private:
    void record(std::span<const Ray> rays, RayQuestion question, RayMask mask,
                Coherence coherence) const;

    const Aggregate& asked_;
    RayStream& stream_;
    mutable std::uint64_t asked_so_far_ = 0;
};

}  // namespace alhazen
