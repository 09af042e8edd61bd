/// The records of rays that are prepared sixteen at a time (ray_rows-inl.h), and where they enter
/// the root's children.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_RECORDS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_RECORDS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_RECORDS_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/accel/wide_bvh/trace/given_rays-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/ray_rows-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// A ray prepared for nodes and for triangles.
struct RayRecord {
    SlabRay slabs;
    TriangleFilterRay filter;
};

/// A ray of a batch with its record.
struct PreparedRay {
    const Ray& ray;
    const RayRecord& record;
};

/// Sixteen records.
class RayRecords {
  public:
    static constexpr std::size_t kRays = RayRows::kRays;
    /// False where sixteen numbers are more than two registers.
    static constexpr bool kSupported = kParts<float, kRays> <= 2;

    RayRecords() = default;
    RayRecords(const RayRecords&) = delete;
    RayRecords& operator=(const RayRecords&) = delete;

    HWY_INLINE void store(const RayRows& rays, const FrameSlack& slack);
    /// Bits of those of `wanted` that meet a child of the root. Sets where they enter it if
    /// kHasEntries. `first`: bits of children that are met first; visit(slot, rays) may limit the
    /// rays there, and returns those that are done with it.
    template <std::size_t W, class Visit>
    [[nodiscard]] HWY_INLINE std::uint32_t enter(const RayRows& rays, const WideNodeOf<W>& root,
                                                 std::uint32_t wanted, std::uint32_t first,
                                                 Visit&& visit);

    [[nodiscard]] HWY_INLINE const RayRecord& operator[](std::size_t i) const { return ray_[i]; }
    /// Whether it is known where rays enter the children of the root.
    template <std::size_t W>
    static constexpr bool kHasEntries = kSupported&& W == kLaneCount;
    /// Where ray i enters the children of the root, infinity where it does not, if `enter` found
    /// one.
    [[nodiscard]] HWY_INLINE const float (&entries(std::size_t i) const)[kLaneCount] {
        return entry_[i];
    }

  private:
    using F = RayRows::F;

    /// Stores row k as number k of each ray. `Part`: SlabRay or TriangleFilterRay, sixteen numbers.
    template <class Part>
    HWY_INLINE void store(const F (&rows)[16], Part RayRecord::*part);
    RayRecord ray_[kRays];
    alignas(32) float entry_[kRays][kLaneCount];
};

template <class Part>
HWY_INLINE void RayRecords::store(const F (&rows)[16], Part RayRecord::*part) {
    static_assert(sizeof(Part) == 16 * sizeof(float));
    HWY_UNROLL(2)
    for (std::size_t half = 0; half < 2; ++half) {
        store_columns(rows + 8 * half, [&](std::size_t ray) HWY_ATTR {
            return reinterpret_cast<float*>(&(ray_[ray].*part)) + 8 * half;
        });
    }
}

HWY_INLINE void RayRecords::store(const RayRows& rays, const FrameSlack& slack) {
    F rows[16];
    rays.slab_rows(rows);
    store(rows, &RayRecord::slabs);
    rays.filter_rows(slack, rows);
    store(rows, &RayRecord::filter);
}

template <std::size_t W, class Visit>
HWY_INLINE std::uint32_t RayRecords::enter(const RayRows& rays, const WideNodeOf<W>& root,
                                           std::uint32_t wanted, std::uint32_t first,
                                           Visit&& visit) {
    const F never(std::numeric_limits<float>::infinity());
    F entries[W];
    if constexpr (kHasEntries<W>) {
        for (F& entry : entries) entry = never;
    }
    std::uint32_t bits = 0;
    if constexpr (kHasEntries<W>) {
        for (std::uint32_t rest = first; rest != 0; rest &= rest - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(rest));
            F entry;
            std::uint32_t here = wanted & bits_of(rays.meet(root.planes, i, entry));
            if (here == 0) continue;
            here &= ~visit(i, here);
            entries[i] = select_lanes(lanes_of_bits<float, kRays>(here), entry, never);
            bits |= here;
        }
    }
    LaneMask<float, kRays> met = lanes_of_bits<float, kRays>(bits);
    for (std::size_t i = 0; i < root.child_count(); ++i) {
        if ((first >> i & 1) != 0) continue;
        F entry;
        const auto here = rays.meet(root.planes, i, entry);
        if constexpr (kHasEntries<W>) entries[i] = select_lanes(here, entry, never);
        met = met | here;
    }
    bits = wanted & bits_of(met);
    if constexpr (kHasEntries<W>) {
        if (bits != 0) {
            store_columns(entries, [&](std::size_t i) HWY_ATTR { return entry_[i]; });
        }
    }
    return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
