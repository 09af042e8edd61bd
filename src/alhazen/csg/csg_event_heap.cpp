#include "alhazen/csg/csg_event_heap.h"

#include <algorithm>

#include "alhazen/csg/csg_scratch.h"
#include "alhazen/csg/csg_state.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

/// Marks a change of a leaf without a crossing, at an end of its S-bound.
constexpr std::uint32_t kSilent = 1u << 31;
/// Stands for the root in place of a child of the tree of boxes.
constexpr std::uint32_t kRoot = 0;

/// A box that the ray meets and that is not yet opened.
struct Bound {
    double enter, exit;
    std::uint32_t child;
};
/// Order of a heap with the nearest bound on top.
struct LaterBound {
    bool operator()(const Bound& a, const Bound& b) const { return a.enter > b.enter; }
};
/// Silent changes come before crossings at the same t.
struct LaterCrossing {
    bool operator()(const CsgCrossing& a, const CsgCrossing& b) const {
        return a.t > b.t || (a.t == b.t && (a.leaf & kSilent) < (b.leaf & kSilent));
    }
};

/// The current and the next interval of a ray on which one operand alone determines the value of
/// the solid. Other operands change nothing there.
class DecidedParts {
  public:
    /// Points within `margin` of the ends are excluded.
    explicit DecidedParts(double margin) : margin_(margin) {}

    void add(double begin, double end) {
        if (!(end - begin > 4.0 * margin_)) return;
        if (!now_.joins(begin, end) && !next_.joins(begin, end)) {
            if (now_.empty()) {
                now_ = {begin, end};
            } else if (next_.empty() && begin > now_.end) {
                next_ = {begin, end};
            }
        }
        if (!next_.empty() && now_.joins(next_.begin, next_.end)) next_ = {};
    }
    /// Returns false if the whole bound is irrelevant; otherwise moves its start to the first
    /// relevant point.
    bool shorten(Bound& bound) {
        if (bound.enter >= now_.end - margin_ && !next_.empty()) {
            now_ = next_;
            next_ = {};
        }
        const double end = now_.end - margin_;
        if (!(bound.enter > now_.begin + margin_ && bound.enter < end)) return true;
        if (bound.exit < end) return false;
        bound.enter = end;
        return true;
    }

  private:
    struct Part {
        double begin = kInfinity, end = -kInfinity;

        [[nodiscard]] bool empty() const { return !(begin < end); }
        /// Merges with an overlapping interval; returns false if they are disjoint.
        bool joins(double other_begin, double other_end) {
            if (!(other_begin <= end && other_end >= begin)) return false;
            begin = std::min(begin, other_begin);
            end = std::max(end, other_end);
            return true;
        }
    };

    double margin_;
    Part now_, next_;
};

struct EventHeapScratch {
    std::vector<Bound> bounds;        ///< heap
    std::vector<CsgCrossing> events;  ///< heap
    std::vector<CsgCrossing> crossings, cluster;
    std::vector<Hit> hits;
    CsgState state;
};

/// A traversal for one query.
class Walk {
  public:
    Walk(const CsgSolid& solid, const CsgBvh& bvh, const CsgRay& ray, EventHeapScratch& scratch,
         TraversalStats* stats)
        : solid_(solid),
          bvh_(bvh),
          ray_(ray),
          slabs_(bvh.slabs(ray.line, ray.pad)),
          s_(scratch),
          stats_(stats),
          last_t_(ray.t_max + ray.tau),
          decided_(2.0 * ray.tau) {
        s_.bounds.clear();
        s_.events.clear();
        s_.hits.clear();
        s_.state.fit(solid.tree());
        for (const std::uint32_t leaf : bvh.unbounded()) open_leaf(leaf, -kInfinity, kInfinity);
        if (!bvh.empty()) open_node(kRoot);
        begin();
    }
    ~Walk() { s_.state.clear(); }
    Walk(const Walk&) = delete;
    Walk& operator=(const Walk&) = delete;

    [[nodiscard]] bool begins_inside() const { return begins_inside_; }

    /// Advances to the next transition; false if there is none. `found` is valid until the next
    /// call.
    bool next(CsgCrossing& found) {
        CsgState& state = s_.state;
        while (true) {
            if (!open_to_first_event()) return false;
            const double t = s_.events.front().t;
            if (t > ray_.t_max) return false;
            apply_silent(t);
            if (s_.events.empty() || s_.events.front().t != t) continue;
            const std::uint32_t before = place();
            s_.cluster.clear();
            state.forget_changes();
            apply(t);
            if (place() == before) continue;
            // Crossings within tau belong to the same transition.
            const double end = t + ray_.tau;
            open_to(end);
            apply(end);
            const std::uint32_t after = place();
            if (after == before) continue;
            is_wall_ = before != CsgSolid::kNoMedium && after != CsgSolid::kNoMedium;
            if (responsible(found) && found.t <= ray_.t_max) return true;
        }
    }

    /// True if the last transition is a boundary between two media.
    [[nodiscard]] bool is_wall() const { return is_wall_; }
    /// The leaf that fills the current point, or none.
    [[nodiscard]] std::uint32_t filling_leaf() const { return s_.state.filling_leaf(); }
    /// Advances to t, past all transitions.
    void go_to(double t) {
        open_to(t);
        apply(t);
    }

  private:
    /// The state that a transition changes: the medium; inside or outside if there is one medium.
    [[nodiscard]] std::uint32_t place() const {
        if (!s_.state.value()) return CsgSolid::kNoMedium;
        return solid_.has_media() ? solid_.medium(s_.state.filling_leaf()) : CsgSolid::kOpaque;
    }

    void begin() {
        open_to(ray_.t_min);
        apply_silent(ray_.t_min);
        begins_inside_ = s_.state.value();
    }

    void push(const Bound& bound) {
        s_.bounds.push_back(bound);
        std::push_heap(s_.bounds.begin(), s_.bounds.end(), LaterBound{});
    }
    void push(const CsgCrossing& event) {
        s_.events.push_back(event);
        std::push_heap(s_.events.begin(), s_.events.end(), LaterCrossing{});
    }
    CsgCrossing pop_event() {
        std::pop_heap(s_.events.begin(), s_.events.end(), LaterCrossing{});
        const CsgCrossing event = s_.events.back();
        s_.events.pop_back();
        return event;
    }

    void open_node(std::uint32_t node) {
        if (stats_ != nullptr) {
            ++stats_->node_visits;
            stats_->box_tests += CsgBvh::kWidth;
        }
        bvh_.children(node, slabs_, [&](std::uint32_t child, double enter, double exit) {
            if (exit < ray_.t_min || enter > last_t_) return;
            Bound bound{std::max(enter, ray_.t_min), exit, child};
            if (decided_.shorten(bound)) push(bound);
        });
    }

    /// Opens a leaf. Crossings before the bound or the ray only determine its state at the start.
    void open_leaf(std::uint32_t leaf, double enter, double exit) {
        const double begin = std::max(enter, ray_.t_min);
        s_.crossings.clear();
        bool inside = solid_.cross(leaf, ray_, s_.crossings, s_.hits, stats_);
        auto crossing = s_.crossings.begin();
        for (; crossing != s_.crossings.end() && crossing->t < begin; ++crossing) inside = !inside;
        if (inside) push(CsgCrossing{begin, 0, 0, 0, leaf | kSilent});
        const bool decides = decides_alone(leaf);
        double since = begin;
        for (; crossing != s_.crossings.end() && crossing->t <= exit; ++crossing) {
            if (decides && inside) decided_.add(since, crossing->t);
            since = crossing->t;
            inside = !inside;
            if (crossing->t <= last_t_) push(*crossing);
        }
        if (decides && inside) decided_.add(since, exit);
        if (inside && exit <= last_t_) push(CsgCrossing{exit, 0, 0, 0, leaf | kSilent});
    }
    /// True if a point inside the leaf has a fixed value. Boundaries between media are transitions,
    /// even inside a union.
    [[nodiscard]] bool decides_alone(std::uint32_t leaf) const {
        const CsgTree::Leaf& l = solid_.tree().leaves()[leaf];
        return l.decides && (l.complement || !solid_.has_media());
    }

    void open_nearest() {
        std::pop_heap(s_.bounds.begin(), s_.bounds.end(), LaterBound{});
        Bound bound = s_.bounds.back();
        s_.bounds.pop_back();
        const double enter = bound.enter;
        if (!decided_.shorten(bound)) return;
        if (bound.enter > enter) {
            push(bound);
            return;
        }
        if ((bound.child & CsgBvh::kLeafBit) != 0) {
            open_leaf(bound.child & ~CsgBvh::kLeafBit, bound.enter, bound.exit);
        } else {
            open_node(bound.child);
        }
    }
    /// Opens all bounds that begin up to t.
    void open_to(double t) {
        while (!s_.bounds.empty() && s_.bounds.front().enter <= t) open_nearest();
    }
    /// Opens all bounds that begin up to the first event. False if there is no event.
    bool open_to_first_event() {
        while (!s_.bounds.empty() &&
               (s_.events.empty() || s_.bounds.front().enter <= s_.events.front().t)) {
            open_nearest();
        }
        return !s_.events.empty();
    }

    void apply_silent(double t) {
        while (!s_.events.empty() && s_.events.front().t <= t &&
               (s_.events.front().leaf & kSilent) != 0) {
            s_.state.toggle(pop_event().leaf & ~kSilent);
        }
    }
    /// Applies all events up to t.
    void apply(double t) {
        while (!s_.events.empty() && s_.events.front().t <= t) {
            const CsgCrossing event = pop_event();
            s_.state.toggle(event.leaf & ~kSilent);
            if ((event.leaf & kSilent) == 0) s_.cluster.push_back(event);
        }
    }

    /// Finds the crossing of the cluster that is reported for the change of the solid.
    bool responsible(CsgCrossing& found) const {
        bool any = false;
        for (const CsgCrossing& crossing : s_.cluster) {
            if (any && crossing.leaf > found.leaf) continue;
            if (is_wall_ ? !s_.state.changed(crossing.leaf)
                         : !s_.state.changed_all_the_way(crossing.leaf)) {
                continue;
            }
            found = crossing;  // the last one of a leaf
            any = true;
        }
        return any;
    }

    const CsgSolid& solid_;
    const CsgBvh& bvh_;
    const CsgRay& ray_;
    const CsgBvh::RaySlabs slabs_;
    EventHeapScratch& s_;
    TraversalStats* stats_;
    double last_t_;  ///< later events are ignored
    DecidedParts decided_;
    bool begins_inside_ = false;
    bool is_wall_ = false;
};

}  // namespace

bool CsgEventHeap::first(const CsgRay& ray, Hit& hit, TraversalStats* stats) const {
    const CsgScratchLease<EventHeapScratch> lease;
    Walk walk(solid_, bvh_, ray, *lease, stats);
    CsgCrossing found;
    if (!walk.next(found)) return false;
    solid_.fill(found, (*lease).hits, hit);
    return true;
}

bool CsgEventHeap::all(const CsgRay& ray, std::vector<Hit>& hits, TraversalStats* stats) const {
    const CsgScratchLease<EventHeapScratch> lease;
    Walk walk(solid_, bvh_, ray, *lease, stats);
    CsgCrossing found;
    while (walk.next(found)) {
        solid_.fill(found, (*lease).hits, hits.emplace_back());
        if (walk.is_wall()) hits.push_back(Hit(hits.back()));
    }
    return walk.begins_inside();
}

CsgSides CsgEventHeap::sides(const CsgRay& ray, double t) const {
    const CsgScratchLease<EventHeapScratch> lease;
    // All crossings of one transition lie within tau of it.
    CsgRay near = ray;
    near.t_min = t - 2.0 * ray.tau;
    near.t_max = t + 2.0 * ray.tau;
    Walk walk(solid_, bvh_, near, *lease, nullptr);
    CsgSides sides;
    sides.before = walk.filling_leaf();
    walk.go_to(near.t_max);
    sides.after = walk.filling_leaf();
    return sides;
}

}  // namespace alhazen
