#include "alhazen/explain/spans/csg_spans.h"

#include <algorithm>

namespace alhazen {

namespace {

/// Table 15.2: whether a span of the ray is inside.
bool is_inside(Combine combine, bool left, bool right) {
    if (combine == Combine::Intersection) return left && right;
    if (combine == Combine::Difference) return left && !right;
    return left || right;
}

bool covers(const std::vector<TSpan>& spans, double from, double to) {
    return std::any_of(spans.begin(), spans.end(),
                       [&](const TSpan& s) { return s.from <= from && to <= s.to; });
}

void collect_ends(CsgSpanNode& node, std::vector<double*>& ends) {
    for (TSpan& s : node.spans) {
        ends.push_back(&s.from);
        ends.push_back(&s.to);
    }
    for (CsgSpanNode& operand : node.operands) collect_ends(operand, ends);
}

void drop_empty(CsgSpanNode& node) {
    std::erase_if(node.spans, [](const TSpan& s) { return !(s.from < s.to); });
    for (CsgSpanNode& operand : node.operands) drop_empty(operand);
}

}  // namespace

void close_ranks(CsgSpanNode& root, double tau) {
    std::vector<double*> ends;
    collect_ends(root, ends);
    std::sort(ends.begin(), ends.end(), [](const double* a, const double* b) { return *a < *b; });
    for (std::size_t i = 0, first = 0; i < ends.size(); ++i) {
        if (*ends[i] > *ends[first] + tau) first = i;
        *ends[i] = *ends[first];
    }
    drop_empty(root);
}

void combine(CsgSpanNode& root) {
    for (std::size_t i = 0; i < root.operands.size(); ++i) {
        CsgSpanNode& operand = root.operands[i];
        if (!operand.is_leaf) combine(operand);
        root.spans = i == 0 ? operand.spans : combined(root.combine, root.spans, operand.spans);
    }
}

std::vector<TSpan> combined(Combine combine, const std::vector<TSpan>& left,
                            const std::vector<TSpan>& right) {
    std::vector<double> changes;
    for (const auto* side : {&left, &right}) {
        for (const TSpan& s : *side) {
            changes.push_back(s.from);
            changes.push_back(s.to);
        }
    }
    std::sort(changes.begin(), changes.end());
    changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
    std::vector<TSpan> result;
    for (std::size_t i = 0; i + 1 < changes.size(); ++i) {
        const double from = changes[i], to = changes[i + 1];
        if (!is_inside(combine, covers(left, from, to), covers(right, from, to))) continue;
        if (!result.empty() && result.back().to == from) {
            result.back().to = to;
        } else {
            result.push_back({from, to});
        }
    }
    return result;
}

std::vector<TSpan> leaf_spans(const CsgSolid& solid, std::uint32_t leaf, const Ray& ray) {
    std::vector<CsgCrossing> crossings;
    std::vector<Hit> hits;
    bool inside = solid.cross(leaf, solid.prepare(ray), crossings, hits, nullptr);
    std::vector<TSpan> spans;
    double from = -kInfinity;
    const auto close = [&](double to) {
        if (inside && to > 0.0 && from < to) spans.push_back({std::max(from, 0.0), to});
    };
    for (const CsgCrossing& crossing : crossings) {
        close(crossing.t);
        from = crossing.t;
        inside = !inside;
    }
    close(kInfinity);
    return spans;
}

}  // namespace alhazen
