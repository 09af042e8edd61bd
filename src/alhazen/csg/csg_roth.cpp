#include "alhazen/csg/csg_roth.h"

#include <algorithm>

#include "alhazen/csg/csg_scratch.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

/// True if the line passes within `pad` of the box.
bool passes(const Ray& line, const Box3& box, double pad) {
    if (box.empty()) return false;
    double enter = line.t_min, exit = line.t_max;
    for (int k = 0; k < 3; ++k) {
        const double lo = box.lo[k] - pad - line.origin[k];
        const double hi = box.hi[k] + pad - line.origin[k];
        const double d = line.direction[k];
        if (d == 0.0) {
            if (lo > 0.0 || hi < 0.0) return false;
            continue;
        }
        const double t0 = (d > 0.0 ? lo : hi) / d;
        const double t1 = (d > 0.0 ? hi : lo) / d;
        enter = t0 > enter ? t0 : enter;
        exit = t1 < exit ? t1 : exit;
    }
    return enter <= exit;
}

/// The changes of an operand's value: a range of the common list.
struct SpanList {
    std::size_t begin = 0, end = 0;
    bool inside = false;  ///< at the start of the ray

    [[nodiscard]] bool empty() const { return begin == end && !inside; }
};

struct RothScratch {
    std::vector<double> changes;    ///< of all operands, one list after another
    std::vector<SpanList> nodes;    ///< [node]
    std::vector<SpanList> leaves;   ///< [leaf]
    std::vector<SpanList> crossed;  ///< [leaf] range of `crossings`
    std::vector<CsgCrossing> crossings;
    std::vector<Hit> hits;
};

/// Table 15.2: the value of an operator for the values of its two sides.
bool classify(Combine combine, bool left, bool right) {
    if (combine == Combine::Union) return left || right;
    return combine == Combine::Intersection ? left && right : left && !right;
}

/// The evaluation of one query.
class Merge {
  public:
    Merge(const CsgSolid& solid, std::span<const Box3> boxes, std::span<const Box3> leaf_boxes,
          const CsgRay& ray, RothScratch& scratch, TraversalStats* stats)
        : solid_(solid),
          boxes_(boxes),
          leaf_boxes_(leaf_boxes),
          ray_(ray),
          s_(scratch),
          stats_(stats) {
        s_.changes.clear();
        s_.crossings.clear();
        s_.hits.clear();
        s_.nodes.assign(solid.expression().nodes.size(), {});
        s_.leaves.assign(solid.leaf_count(), {});
        s_.crossed.assign(solid.leaf_count(), {});
        root_ = node(0);
        next_ = root_.begin;
    }

    [[nodiscard]] bool begins_inside() const { return root_.inside; }

    /// Advances to the next transition; false if there is none.
    bool next(CsgCrossing& found) {
        while (next_ < root_.end) {
            const double t = s_.changes[next_];
            if (t > ray_.t_max) return false;
            const double end = t + ray_.tau;
            std::size_t count = 0;
            for (; next_ < root_.end && s_.changes[next_] <= end; ++next_) ++count;
            if (count % 2 == 0) continue;
            bool any = false;
            responsible(CsgOperand::node(0), {t, end}, found, any);
            if (any && found.t <= ray_.t_max) return true;
        }
        return false;
    }

  private:
    bool passes_box(const Box3& box) const {
        if (stats_ != nullptr) ++stats_->box_tests;
        return passes(ray_.line, box, ray_.pad);
    }

    SpanList operand(CsgOperand o) { return o.is_leaf() ? leaf(o.index()) : node(o.index()); }

    SpanList leaf(std::uint32_t index) {
        SpanList list;
        list.begin = list.end = s_.changes.size();
        if (!passes_box(leaf_boxes_[index])) return s_.leaves[index] = list;
        SpanList crossed{s_.crossings.size(), 0};
        list.inside = solid_.cross(index, ray_, s_.crossings, s_.hits, stats_);
        crossed.end = s_.crossings.size();
        s_.crossed[index] = crossed;
        for (std::size_t i = crossed.begin; i < crossed.end; ++i) {
            const double t = s_.crossings[i].t;
            if (t < ray_.t_min) {
                list.inside = !list.inside;
            } else {
                s_.changes.push_back(t);
            }
        }
        list.end = s_.changes.size();
        return s_.leaves[index] = list;
    }

    /// Recursion is safe: validation bounds the nesting.
    SpanList node(std::uint32_t index) {
        const CsgExpression::Node& n = solid_.expression().nodes[index];
        SpanList left;
        left.begin = left.end = s_.changes.size();
        if (n.operands.empty() || !passes_box(boxes_[index])) return s_.nodes[index] = left;
        left = operand(n.operands.front());
        for (std::size_t i = 1; i < n.operands.size(); ++i) {
            if (left.empty() && n.combine != Combine::Union) break;
            const SpanList right = operand(n.operands[i]);
            left = merged(n.combine, left, right);
        }
        return s_.nodes[index] = left;
    }

    SpanList merged(Combine combine, const SpanList& left, const SpanList& right) {
        SpanList both;
        both.begin = s_.changes.size();
        bool in_left = left.inside, in_right = right.inside;
        bool value = both.inside = classify(combine, in_left, in_right);
        std::size_t i = left.begin, j = right.begin;
        while (i < left.end || j < right.end) {
            const double t = j == right.end || (i < left.end && s_.changes[i] <= s_.changes[j])
                                 ? s_.changes[i]
                                 : s_.changes[j];
            for (; i < left.end && s_.changes[i] == t; ++i) in_left = !in_left;
            for (; j < right.end && s_.changes[j] == t; ++j) in_right = !in_right;
            const bool next = classify(combine, in_left, in_right);
            if (next != value) s_.changes.push_back(t);
            value = next;
        }
        both.end = s_.changes.size();
        return both;
    }

    [[nodiscard]] bool changes_within(const SpanList& list, const Interval& window) const {
        const auto begin = s_.changes.begin() + static_cast<std::ptrdiff_t>(list.begin);
        const auto end = s_.changes.begin() + static_cast<std::ptrdiff_t>(list.end);
        const auto first = std::lower_bound(begin, end, window.lo);
        return (std::upper_bound(first, end, window.hi) - first) % 2 != 0;
    }

    /// Finds the reported crossing: descends to the leaves that changed with all nodes above them.
    void responsible(CsgOperand o, const Interval& window, CsgCrossing& found, bool& any) const {
        if (!o.is_leaf()) {
            if (!changes_within(s_.nodes[o.index()], window)) return;
            for (const CsgOperand child : solid_.expression().nodes[o.index()].operands) {
                responsible(child, window, found, any);
            }
            return;
        }
        if (any && o.index() > found.leaf) return;
        if (!changes_within(s_.leaves[o.index()], window)) return;
        const SpanList& crossed = s_.crossed[o.index()];
        for (std::size_t i = crossed.begin; i < crossed.end; ++i) {
            const CsgCrossing& crossing = s_.crossings[i];
            if (crossing.t < window.lo || crossing.t > window.hi) continue;
            found = crossing;  // the last one
            any = true;
        }
    }

    const CsgSolid& solid_;
    std::span<const Box3> boxes_, leaf_boxes_;
    const CsgRay& ray_;
    RothScratch& s_;
    TraversalStats* stats_;
    SpanList root_;
    std::size_t next_ = 0;
};

}  // namespace

CsgRoth::CsgRoth(const CsgSolid& solid)
    : solid_(solid), sweep_(solid, std::vector<Box3>(solid.leaf_count(), kAllSpace)) {
    const CsgExpression& expression = solid.expression();
    for (std::uint32_t i = 0; i < solid.leaf_count(); ++i) leaf_boxes_.push_back(solid.leaf_box(i));
    boxes_.resize(expression.nodes.size());
    const auto box_of = [&](CsgOperand o) {
        return o.is_leaf() ? leaf_boxes_[o.index()] : boxes_[o.index()];
    };
    for (std::size_t i = expression.nodes.size(); i-- > 0;) {
        const CsgExpression::Node& node = expression.nodes[i];
        if (node.operands.empty()) continue;
        boxes_[i] = box_of(node.operands.front());
        if (node.combine == Combine::Difference) continue;
        for (const CsgOperand o : node.operands) {
            if (node.combine == Combine::Union) {
                boxes_[i].include(box_of(o));
            } else {
                boxes_[i] = intersection(boxes_[i], box_of(o));
            }
        }
    }
}

bool CsgRoth::first(const CsgRay& ray, Hit& hit, TraversalStats* stats) const {
    if (solid_.has_media()) return sweep_.first(ray, hit, stats);
    const CsgScratchLease<RothScratch> lease;
    Merge merge(solid_, boxes_, leaf_boxes_, ray, *lease, stats);
    CsgCrossing found;
    if (!merge.next(found)) return false;
    solid_.fill(found, (*lease).hits, hit);
    return true;
}

bool CsgRoth::all(const CsgRay& ray, std::vector<Hit>& hits, TraversalStats* stats) const {
    if (solid_.has_media()) return sweep_.all(ray, hits, stats);
    const CsgScratchLease<RothScratch> lease;
    Merge merge(solid_, boxes_, leaf_boxes_, ray, *lease, stats);
    CsgCrossing found;
    while (merge.next(found)) solid_.fill(found, (*lease).hits, hits.emplace_back());
    return merge.begins_inside();
}

}  // namespace alhazen
