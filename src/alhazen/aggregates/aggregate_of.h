#pragma once
/// An aggregate of a primitive table and any accelerator that visits primitives one at a time.
///
/// Conventions: those of `Aggregate`. Primitives without a finite box are tested first, outside
/// the accelerator.
/// Complexity: one virtual call per ray; the traversal is instantiated with the visitor of each
/// query. Threads: const functions may be called from many.

#include <algorithm>
#include <type_traits>
#include <utility>

#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/reentrant_stack.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/bounded_primitives.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

template <Accelerator A>
class AggregateOf final : public Aggregate {
  public:
    explicit AggregateOf(PrimitiveTable table, const typename A::Config& config = {})
        : table_(std::move(table)), accelerator_(build(config)) {}

    [[nodiscard]] Box3 box() const override { return box_; }
    [[nodiscard]] std::size_t memory_bytes() const override {
        return accelerator_.memory_bytes() + unbounded_.capacity() * sizeof(PrimitiveId) +
               bounded_.capacity() * sizeof(std::uint32_t);
    }
    [[nodiscard]] const PrimitiveTable& primitives() const override { return table_; }

    [[nodiscard]] bool closest(const Ray& ray, Hit& hit, RayQuery query) const override {
        hit = Hit{};
        if (!is_valid(ray)) return false;
        if (query.stats != nullptr) {
            any_query(AsksFor::Closest, ray, &hit, nullptr, query.mask, CountingStats{query.stats});
            return hit.found();
        }
        Ray shrinking = ray;
        const RayShear shear(ray.direction);
        each(Always<AsksFor::Closest>(), shrinking, NoStats{}, [&](PrimitiveId id) {
            table_.closest(id, shrinking, shear, hit, NoStats{}, query.mask);
            return false;
        });
        return hit.found();
    }

    [[nodiscard]] bool occluded(const Ray& ray, RayQuery query) const override {
        if (!is_valid(ray)) return false;
        if (query.stats != nullptr) {
            return any_query(AsksFor::AnyHit, ray, nullptr, nullptr, query.mask,
                             CountingStats{query.stats});
        }
        const RayShear shear(ray.direction);
        return each(Always<AsksFor::AnyHit>(), ray, NoStats{}, [&](PrimitiveId id) {
            return table_.occluded(id, ray, shear, NoStats{}, query.mask);
        });
    }

    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const override {
        collect(AsksFor::AllHits, ray, hits, query);
    }

    [[nodiscard]] bool shadowed(const Ray& ray, std::vector<Hit>& crossings,
                                RayQuery query) const override {
        return collect(AsksFor::AnyBlocker, ray, crossings, query);
    }

  private:
    /// Drops the crossings of repeated visits, for accelerators with primitives in several cells.
    class OnlyOnce {
      public:
        explicit OnlyOnce(std::vector<Hit>* hits) : hits_(hits) {}
        /// Drops the crossings of `id`, which are those from `known` on, if it was visited before.
        void keep(PrimitiveId id, std::size_t known) {
            if constexpr (visits_repeatedly<A>()) {
                if (hits_->size() == known) return;
                if (std::find(seen_.begin(), seen_.end(), id) == seen_.end()) {
                    seen_.push(id);
                } else {
                    hits_->resize(known);
                }
            }
        }

      private:
        std::vector<Hit>* hits_;
        ReentrantStack<PrimitiveId> seen_;
    };

    /// Answers all queries with counting, or those that collect crossings without. Each of the two
    /// has one traversal for all kinds of query, to limit compile time. `nearest` or `hits`
    /// receives the result.
    template <class Stats>
    bool any_query(AsksFor asked, Ray ray, [[maybe_unused]] Hit* nearest, std::vector<Hit>* hits,
                   RayMask mask, Stats stats) const {
        const RayShear shear(ray.direction);
        OnlyOnce once(hits);
        return each(asked, ray, stats, [&](PrimitiveId id) {
            if constexpr (Stats::kCounts) {
                if (asked == AsksFor::Closest) {
                    table_.closest(id, ray, shear, *nearest, stats, mask);
                    return false;
                }
                if (asked == AsksFor::AnyHit) return table_.occluded(id, ray, shear, stats, mask);
            }
            const std::size_t known = hits->size();
            if (asked == AsksFor::AllHits) {
                table_.all_hits(id, ray, shear, *hits, stats, mask);
            } else if (table_.shadowed(id, ray, shear, *hits, stats, mask)) {
                return true;
            }
            once.keep(id, known);
            return false;
        });
    }
    bool collect(AsksFor asked, const Ray& ray, std::vector<Hit>& hits, RayQuery query) const {
        if (!is_valid(ray)) return false;
        const std::size_t before = hits.size();
        const bool opaque = with_stats(query.stats, [&](auto stats) {
            return any_query(asked, ray, nullptr, &hits, query.mask, stats);
        });
        if (!opaque) sort_appended(hits, before);
        return opaque;
    }

    /// Rays with no component of at least this are tested against every primitive: the reciprocals
    /// of components and t of hits may be infinite.
    static constexpr double kLeastDirection = 0x1p-960;

    A build(const typename A::Config& config) {
        BoundedPrimitives bounded(table_);
        A accelerator = A::build(bounded, config);
        box_ = bounded.all();
        unbounded_ = bounded.unbounded();
        bounded_count_ = static_cast<std::uint32_t>(bounded.size());
        bounded_ = bounded.take_bounded();
        return accelerator;
    }

    template <AsksFor kAsked>
    using Always = std::integral_constant<AsksFor, kAsked>;

    /// `Asked`: AsksFor, or Always<> for a kind of query known at compile time.
    template <class Asked, class Test>
    struct Visitor {
        [[no_unique_address]] Asked asked;
        const Ray& ray;
        const std::uint32_t* ids;  ///< null: the accelerator's numbers are the table's ids
        Test& test;
        bool stopped = false;
        [[nodiscard]] AsksFor asks_for() const { return asked; }
        [[nodiscard]] double t_max() const { return ray.t_max; }
        bool visit(std::uint32_t i) {
            stopped = test(PrimitiveId{ids != nullptr ? ids[i] : i});
            return stopped;
        }
    };

    /// Calls `test(id)` for every primitive that the ray may intersect, until it returns true. True
    /// if it did.
    template <class Asked, class Stats, class Test>
    bool each(Asked asked, const Ray& ray, Stats stats, Test&& test) const {
        for (const PrimitiveId id : unbounded_) {
            if (test(id)) return true;
        }
        Visitor<Asked, std::remove_reference_t<Test>> visitor{
            asked, ray, bounded_.empty() ? nullptr : bounded_.data(), test};
        if (max_component(abs(ray.direction)) < kLeastDirection) {
            for (std::uint32_t i = 0; i < bounded_count_; ++i) {
                if (visitor.visit(i)) return true;
            }
            return false;
        }
        accelerator_.traverse(ray, visitor, stats);
        return visitor.stopped;
    }

    PrimitiveTable table_;
    // Set by `build`, therefore declared before the accelerator.
    Box3 box_;
    std::vector<PrimitiveId> unbounded_;
    std::vector<std::uint32_t> bounded_;
    std::uint32_t bounded_count_ = 0;
    A accelerator_;
};

}  // namespace alhazen
