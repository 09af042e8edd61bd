/// Sixteen rays of a batch through the tree together, for any hit, as long as enough of them visit
/// the same nodes: the boxes of the children and the triangles of a leaf against all of them, in
/// lanes. What fewer visit is left to each ray.
///
/// Source: Benthin, Wald, Woop, Ernst and Mark, "Combining Single and Packet-Ray Tracing for
/// Arbitrary Ray Distributions on the Intel MIC Architecture", TVCG 18(9), 2012.
/// Differs: rays of any directions, as any-hit queries have one order of the children for all; what
/// is left goes on in the stream; a triangle is filtered, and what float does not decide is left.
/// Conventions: included once per target (see simd/lanes-inl.h). Sets of rays are bits.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_SHARED_DESCENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_SHARED_DESCENT_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_SHARED_DESCENT_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_SHARED_DESCENT_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "alhazen/accel/wide_bvh/trace/stream-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/ray_rows-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_crossing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The subtrees that are left to each of sixteen rays.
class LeftSubtrees {
  public:
    static constexpr std::size_t kMost = kMostBegun;

    LeftSubtrees() = default;
    LeftSubtrees(const LeftSubtrees&) = delete;
    LeftSubtrees& operator=(const LeftSubtrees&) = delete;

    HWY_INLINE void clear() { first_ = kMost; }
    [[nodiscard]] HWY_INLINE std::size_t count() const { return kMost - first_; }
    HWY_INLINE void add(NodeRef ref, std::uint32_t rays) {
        ref_[--first_] = ref.bits();
        rays_[first_] = rays;
    }
    /// Bits of the rays that have any.
    [[nodiscard]] HWY_INLINE std::uint32_t rays() const {
        std::uint32_t all = 0;
        for (std::size_t i = first_; i < kMost; ++i) all |= rays_[i];
        return all;
    }
    /// Puts those of a ray there, the first added last; their number.
    HWY_INLINE std::size_t copy(std::size_t ray, std::uint32_t* to) const {
        std::size_t count = 0;
        for (std::size_t i = first_; i < kMost; ++i) {
            to[count] = ref_[i];
            count += rays_[i] >> ray & 1;
        }
        return count;
    }

  private:
    std::size_t first_ = kMost;
    std::uint32_t ref_[kMost], rays_[kMost];
};

/// Whether the next sixteen rays of a batch go together. After failures in a row most do not.
class SharedTrials {
  public:
    [[nodiscard]] HWY_INLINE bool due() {
        if (skip_ == 0) return true;
        --skip_;
        return false;
    }
    HWY_INLINE void tried(bool gained) {
        failures_ = gained ? 0 : std::min(failures_ + 1, kMostFailures);
        skip_ = (1u << (3 * failures_)) - 1;
    }

  private:
    static constexpr std::uint32_t kMostFailures = 2;
    std::uint32_t failures_ = 0, skip_ = 0;
};

/// The corners of triangles along the axes of each ray.
class CornersByRay {
  public:
    using F = RayRows::F;

#if HWY_CAP_GE512 && HWY_ARCH_X86
    HWY_INLINE CornersByRay(const RayRows&, const F (&filter)[16]) {
        for (std::size_t k = 0; k < 3; ++k) {
            row_[k] = _mm512_slli_epi32(_mm512_castps_si512(filter[8 + k].part[0].raw), 3);
        }
    }
    /// Corner i of triangle t, along axes kx, ky, kz.
    [[nodiscard]] HWY_INLINE AxisRows<F> get(const TriangleBlock& block, std::size_t i,
                                             std::size_t t) const {
        const __m512 xy = _mm512_loadu_ps(block.vertex[i][0]);
        const __m512 z = _mm512_castps256_ps512(_mm256_load_ps(block.vertex[i][2]));
        const __m512i lane = _mm512_set1_epi32(static_cast<int>(t));
        const auto along = [&](std::size_t k) HWY_ATTR {
            F row;
            row.part[0] = hn::Vec<hn::CappedTag<float, 16>>{
                _mm512_permutex2var_ps(xy, _mm512_add_epi32(row_[k], lane), z)};
            return row;
        };
        return {along(0), along(1), along(2)};
    }

  private:
    __m512i row_[3];
#else
    HWY_INLINE CornersByRay(const RayRows& rays, const F (&)[16]) : rays_(rays) {}
    [[nodiscard]] HWY_INLINE AxisRows<F> get(const TriangleBlock& block, std::size_t i,
                                             std::size_t t) const {
        const F x(block.vertex[i][0][t]), y(block.vertex[i][1][t]), z(block.vertex[i][2][t]);
        const auto pick = [&](const F& a, const F& b, const F& c) HWY_ATTR {
            return select_lanes(rays_.along_x, a, select_lanes(rays_.along_y, b, c));
        };
        return {pick(y, z, x), pick(z, x, y), pick(x, y, z)};
    }

  private:
    const RayRows& rays_;
#endif
};

/// The filter of triangles for sixteen rays of any directions, in lanes. `Scene`: as WideBvhScene.
template <class Scene>
class SharedFilter {
  public:
    using F = RayRows::F;

  protected:
    HWY_INLINE SharedFilter(const Scene& scene, const RayRows& rays) : scene_(scene), rays_(rays) {}

    /// Whether a leaf holds triangles, few enough for so many rays.
    [[nodiscard]] HWY_INLINE bool suits(NodeRef leaf, std::uint32_t rays) const {
        const auto count = static_cast<std::uint32_t>(std::popcount(rays));
        return static_cast<LeafType>(leaf.kind()) == LeafType::Triangles &&
               2 * count >= kLeastForTwo * used_lanes(scene_.layout->triangles[leaf.offset()]) + 4;
    }
    /// Calls found(place, candidates, sure, lo, hi) for the triangles of a leaf that rays may hit,
    /// until it returns true; it may remove rays.
    template <class Found>
    HWY_INLINE void filter_leaf(NodeRef leaf, std::uint32_t& rays, Found&& found) {
        if (!made_) {
            rays_.filter_rows(scene_.layout->frame.slack, filter_);
            made_ = true;
        }
        const CornersByRay corners(rays_, filter_);
        for (std::uint32_t n = leaf.offset(); n < leaf.offset() + leaf.count(); ++n) {
            const TriangleBlock& block = scene_.layout->triangles[n];
            for (std::uint32_t t = 0; t < kBlockWidth && block.ids[t].used(); ++t) {
                if (!scene_.sees(block.ids[t].id())) continue;
                std::uint32_t sure;
                F lo, hi;
                const std::uint32_t candidates = filter(corners, block, t, rays, sure, lo, hi);
                if (candidates == 0) continue;
                const auto place = static_cast<std::uint32_t>(n * kBlockWidth + t);
                if (found(place, candidates, sure, lo, hi)) return;
            }
        }
    }

    const Scene& scene_;
    const RayRows& rays_;

  private:
    /// Least number of rays for each two triangles of a block, each of which is filtered for all.
    static constexpr std::uint32_t kLeastForTwo = kParts<float, RayRows::kRays>;

    /// As filter_lanes.
    HWY_INLINE std::uint32_t filter(const CornersByRay& corners, const TriangleBlock& block,
                                    std::size_t t, std::uint32_t rays, std::uint32_t& sure, F& lo,
                                    F& hi) const {
        const AxisRows<F> origin{filter_[0], filter_[1], filter_[2]};
        ShearedCorners<F> sheared;
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            sheared.set(i, corners.get(block, i, t) - origin, filter_[4], filter_[5]);
        }
        TriangleCrossing<F> crossing(sheared);
        if ((rays & ~bits_of(crossing.missed_by_far(filter_[3], filter_[7]))) == 0) return 0;
        crossing.bound(filter_[6], filter_[14]);
        lo = crossing.lo;
        hi = crossing.hi;
        const std::uint32_t candidates = rays & ~bits_of(crossing.missed(rays_.s_min, rays_.s_max));
        sure = candidates & bits_of(crossing.sure(filter_[12], filter_[13]));
        return candidates;
    }

    bool made_ = false;  ///< whether `filter_` is
    F filter_[16];       ///< see RayRows::filter_rows
};

/// See the head of the file.
template <class Scene>
class SharedDescent : SharedFilter<Scene> {
    using Base = SharedFilter<Scene>;
    using Base::rays_, Base::scene_, Base::suits, Base::filter_leaf;
    using typename Base::F;

  public:
    HWY_INLINE SharedDescent(const Scene& scene, const PrefetchTable& prefetch_table,
                             const RayRows& rays, LeftSubtrees& left)
        : Base(scene, rays), prefetch_table_(prefetch_table), left_(left) {}

    /// Bits of the rays, of `rays`, that certainly hit anything. What the others have yet to visit
    /// is left.
    HWY_INLINE std::uint32_t run(NodeRef root, std::uint32_t rays) {
        wanting_ = rays;
        left_.clear();
        NodeRef stack[LeftSubtrees::kMost];
        std::uint32_t rays_of[LeftSubtrees::kMost];
        std::size_t height = 0;
        NodeRef ref = root;
        while (true) {
            if (ref.is_leaf()) {
                visit_leaf(ref, rays);
            } else if (std::popcount(rays) < kLeastInNode ||
                       height + left_.count() + WideNode::kWidth > LeftSubtrees::kMost) {
                left_.add(ref, rays);
            } else {
                const WideNode& node = scene_.layout->tree.nodes[ref.index()];
                const std::size_t first = visit_first_leaves(node, rays);
                for (std::size_t i = node.child_count(); i-- > first;) {
                    const std::uint32_t met = rays & meet(node, i);
                    stack[height] = node.child[i];
                    rays_of[height] = met;
                    height += met != 0;
                    // Fewer rays wait for it in the stream.
                    if (std::popcount(met) >= kLeastInNode) {
                        prefetch_table_.prefetch(node.child[i].bits());
                    }
                }
            }
            do {
                if (height == 0) return hit_;
                --height;
                rays = rays_of[height] & wanting_;
            } while (rays == 0);
            ref = stack[height];
        }
    }

  private:
    /// Least number of rays that visit a node together (docs/log/wide_bvh.md).
    static constexpr int kLeastInNode = 12;

    [[nodiscard]] HWY_INLINE std::uint32_t meet(const WideNode& node, std::size_t slot) const {
        F entry;
        return bits_of(rays_.meet(node.planes, slot, entry));
    }
    /// Visits the leaves among the first children, which come first because most rays hit them, so
    /// that the other boxes are tested for the rest only; the number of children that are done.
    HWY_INLINE std::size_t visit_first_leaves(const WideNode& node, std::uint32_t& rays) {
        for (std::size_t i = 0; i < WideNode::kWidth; ++i) {
            if (!node.child[i].is_leaf()) return i;
            const std::uint32_t met = rays & meet(node, i);
            if (met == 0) continue;
            visit_leaf(node.child[i], met);
            rays &= wanting_;
            if (rays == 0) return WideNode::kWidth;
        }
        return WideNode::kWidth;
    }
    HWY_INLINE void visit_leaf(NodeRef ref, std::uint32_t rays) {
        if (!suits(ref, rays)) return left_.add(ref, rays);
        std::uint32_t unsure = 0;
        filter_leaf(ref, rays,
                    [&](std::uint32_t, std::uint32_t candidates, std::uint32_t sure, const F&,
                        const F&) HWY_ATTR {
                        unsure |= candidates;
                        hit_ |= sure;
                        wanting_ &= ~sure;
                        rays &= ~sure;
                        return rays == 0;
                    });
        if ((unsure & wanting_) != 0) left_.add(ref, unsure & wanting_);
    }

    const PrefetchTable& prefetch_table_;
    LeftSubtrees& left_;
    std::uint32_t wanting_ = 0, hit_ = 0;
};

/// The nearest triangles that sixteen rays are sure to hit in leaves that they visit together
/// before any other: leaves below the root, for closest hits. They limit the rays.
template <class Scene>
class SharedNearest : SharedFilter<Scene> {
    using Base = SharedFilter<Scene>;
    using Base::suits, Base::filter_leaf;
    using typename Base::F;

  public:
    HWY_INLINE SharedNearest(const Scene& scene, RayRows& rays)
        : Base(scene, rays),
          limited_(rays),
          lo_(std::numeric_limits<float>::infinity()),
          place_(0.0f) {}

    /// Bits of those of the rays that need not visit the leaf any more.
    HWY_INLINE std::uint32_t visit(NodeRef leaf, std::uint32_t rays) {
        if (!suits(leaf, rays)) return 0;
        std::uint32_t doubt = 0;
        filter_leaf(leaf, rays,
                    [&](std::uint32_t place, std::uint32_t candidates, std::uint32_t sure,
                        const F& lo, const F& hi) HWY_ATTR {
                        if (sure != 0) {
                            const auto is_sure = lanes_of_bits<float, RayRows::kRays>(sure);
                            const auto nearer = is_sure & (hi < lo_);
                            lo_ = select_lanes(nearer, lo, lo_);
                            place_ = select_lanes(nearer, F(std::bit_cast<float>(place)), place_);
                            limited_.s_max = select_lanes(is_sure, min_lanes(hi, limited_.s_max),
                                                          limited_.s_max);
                            const std::uint32_t bits = bits_of(nearer);
                            found_ |= bits;
                            candidates &= ~bits;
                        }
                        doubt |= candidates;
                        return false;
                    });
        return rays & ~doubt;
    }
    /// Bits of the rays that have one.
    [[nodiscard]] HWY_INLINE std::uint32_t found() const { return found_; }
    HWY_INLINE void store(float (&lo)[RayRows::kRays], float (&place)[RayRows::kRays]) const {
        store_lanes(lo_, lo);
        store_lanes(place_, place);
    }

  private:
    RayRows& limited_;
    F lo_, place_;  ///< where it is met at first; its number, block by block
    std::uint32_t found_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
