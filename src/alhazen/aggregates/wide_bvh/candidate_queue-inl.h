/// The candidate queue of one ray: triangles that pass the filter wait for exact resolution until
/// the ray is done; by then, a sure hit usually hides them. `add` returns false if the queue is
/// full; `take_all` passes the candidates that begin before the end of the ray to exact resolution.
/// Shapes wait alike, and what a filter found waits for the next turn of its ray.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_CANDIDATE_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_CANDIDATE_QUEUE_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_CANDIDATE_QUEUE_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_CANDIDATE_QUEUE_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <utility>

#include "alhazen/aggregates/wide_bvh/leaves/rays_at_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The candidates of one ray.
class RayCandidates {
  public:
    HWY_INLINE bool add(const TriangleBlock& block, std::size_t lane, float begin) {
        if (HWY_UNLIKELY(count_ == kMaxCount)) return false;
        candidates_[count_++] = {&block, static_cast<std::uint32_t>(lane), begin};
        return true;
    }
    /// Calls `resolve(block, lane, last)`, which may lower `s_max`.
    template <class Resolve>
    HWY_INLINE void take_all(const float& s_max, Resolve&& resolve) {
        for (std::uint32_t i = 0; i < count_; ++i) {
            // Written so that NaN is resolved.
            if (candidates_[i].lo > s_max) continue;
            resolve(*candidates_[i].block, candidates_[i].lane, i + 1 == count_);
        }
        count_ = 0;
    }

  private:
    static constexpr std::uint32_t kMaxCount = 8;
    std::uint32_t count_ = 0;
    struct {
        const TriangleBlock* block;
        std::uint32_t lane;
        float lo;
    } candidates_[kMaxCount];
};

/// A block of shapes, whatever its type.
class AnyBlock {
  public:
    AnyBlock() = default;
    HWY_INLINE explicit AnyBlock(const SphereBlock& block)
        : block_(&block), type_(LeafType::Spheres) {}
    HWY_INLINE explicit AnyBlock(const FrustumBlock& block)
        : block_(&block), type_(LeafType::Frustums) {}
    HWY_INLINE explicit AnyBlock(const BoxBlock& block) : block_(&block), type_(LeafType::Others) {}

    /// f(block)
    template <class F>
    HWY_INLINE bool with(F&& f) const {
        if (type_ == LeafType::Spheres) return f(*static_cast<const SphereBlock*>(block_));
        if (type_ == LeafType::Frustums) return f(*static_cast<const FrustumBlock*>(block_));
        return f(*static_cast<const BoxBlock*>(block_));
    }

  private:
    const void* block_;
    LeafType type_;
};

/// What the filter of a block found, until the next turn of its ray.
struct FilteredLater {
    union {
        FilteredShapes found;
        FilteredTriangles triangles;
    };

    // Not defaulted: what was found is not set.
    HWY_INLINE FilteredLater() {}

    template <class Block>
    HWY_INLINE void set(const Block& block, std::uint32_t rest) {
        block_ = AnyBlock(block);
        triangle_block_ = nullptr;
        rest_ = rest;
    }
    /// `triangles` has been set.
    HWY_INLINE void set(const TriangleBlock& block) {
        triangle_block_ = &block;
        rest_ = triangles.candidates;
    }
    /// Whether anything passed the filter.
    [[nodiscard]] HWY_INLINE bool waits() const { return rest_ != 0; }
    /// Calls `visit(block, found, rest)` or `visit_triangles(block, triangles)` if anything passed
    /// the filter, and forgets it.
    template <class Visit, class VisitTriangles>
    HWY_INLINE bool settle(Visit&& visit, VisitTriangles&& visit_triangles) {
        if (rest_ == 0) return false;
        const std::uint32_t rest = std::exchange(rest_, 0);
        if (triangle_block_ != nullptr) return visit_triangles(*triangle_block_, triangles);
        return block_.with([&](const auto& block) HWY_ATTR { return visit(block, found, rest); });
    }

  private:
    AnyBlock block_;
    const TriangleBlock* triangle_block_;  ///< null: shapes
    std::uint32_t rest_ = 0;               ///< bits of the lanes that passed
};

/// Shapes that wait for their test in double: what one ray, or rays of a packet, may hit, though
/// the filter is not sure.
template <std::size_t kMostShapes>
class WaitingShapes {
  public:
    struct Shape {
        AnyBlock block;
        std::uint32_t lane;
        std::uint32_t rays;  ///< bits of the rays of a packet; 1 for a single ray
        float lo;
    };

    /// False if there is no room.
    template <class Block>
    HWY_INLINE bool add(const Block& block, std::size_t lane, std::uint32_t rays, float lo) {
        if (HWY_UNLIKELY(count_ == kMostShapes)) return false;
        shapes_[count_++] = {AnyBlock(block), static_cast<std::uint32_t>(lane), rays, lo};
        return true;
    }
    /// Calls `test(block, lane, rays, lo)` for each until it returns true, and removes all.
    template <class Test>
    HWY_INLINE bool take_all(Test&& test) {
        const std::uint32_t count = std::exchange(count_, 0);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Shape& s = shapes_[i];
            if (s.block.with([&](const auto& block)
                                 HWY_ATTR { return test(block, s.lane, s.rays, s.lo); })) {
                return true;
            }
        }
        return false;
    }

  private:
    std::uint32_t count_ = 0;
    Shape shapes_[kMostShapes];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
