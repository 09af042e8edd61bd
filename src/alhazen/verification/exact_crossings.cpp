#include "alhazen/verification/exact_crossings.h"

namespace alhazen {

namespace {

/// Calls f(shape, placement or null) for one shape of the table.
template <class F>
void with_shape(const PrimitiveTable& table, PrimitiveId id, F&& f) {
    const std::uint32_t kind = table.kind(id);
    const std::uint32_t index = table.index(id);
    std::uint32_t k = 0;
    const auto visit = [&](const auto& column) {
        if (k++ != kind) return;
        const std::uint32_t placement = column.placements[index];
        f(column.shapes[index], placement == kNoPlacement ? nullptr : &table.placements[placement]);
    };
    std::apply([&](const auto&... column) { (visit(column), ...); }, table.columns);
}

/// The value of a CSG expression for given values of its leaves.
class Expression {
  public:
    Expression(const CsgExpression& expression, const std::vector<bool>& leaves)
        : expression_(expression), leaves_(leaves) {}

    /// Validation bounds the nesting: recursion is safe here.
    [[nodiscard]] bool node(std::uint32_t index) const {
        const CsgExpression::Node& n = expression_.nodes[index];
        const auto& operands = n.operands;
        switch (n.combine) {
            case Combine::Intersection:
                return std::all_of(operands.begin(), operands.end(),
                                   [&](const CsgOperand& o) { return value(o); });
            case Combine::Difference:
                return value(operands.front()) &&
                       std::none_of(operands.begin() + 1, operands.end(),
                                    [&](const CsgOperand& o) { return value(o); });
            case Combine::Group:
            case Combine::Union:
                break;
        }
        return std::any_of(operands.begin(), operands.end(),
                           [&](const CsgOperand& o) { return value(o); });
    }

  private:
    [[nodiscard]] bool value(const CsgOperand& operand) const {
        return operand.is_leaf() ? leaves_[operand.index()] : node(operand.index());
    }

    const CsgExpression& expression_;
    const std::vector<bool>& leaves_;
};

}  // namespace

bool has_exact_crossings(const PrimitiveTable& table, PrimitiveId id) {
    bool has = false;
    with_shape(table, id, [&]<class S>(const S& shape, const Placement*) {
        has = HasExactCrossings<S> && shape.closed();
    });
    return has;
}

ExactCrossings exact_crossings(const PrimitiveTable& table, PrimitiveId id, const ExactLine& line) {
    ExactCrossings found;
    with_shape(table, id, [&]<class S>(const S& shape, const Placement* placement) {
        if constexpr (HasExactCrossings<S>) {
            found = exact_crossings(shape, placement == nullptr
                                               ? line
                                               : transformed(placement->inner_from_outer, line));
        }
    });
    return found;
}

bool has_exact_crossings(const CsgSolid& solid) {
    const auto& leaves = solid.expression().leaves;
    return std::all_of(leaves.begin(), leaves.end(),
                       [&](PrimitiveId id) { return has_exact_crossings(solid.table(), id); });
}

ExactCrossings exact_crossings(const CsgSolid& solid, const ExactLine& line, Real128 least) {
    const auto& leaves = solid.expression().leaves;
    struct Change {
        Real128 t;
        std::uint32_t leaf;
    };
    std::vector<Change> changes;
    std::vector<bool> inside(leaves.size());
    for (std::uint32_t i = 0; i < leaves.size(); ++i) {
        const ExactCrossings own = exact_crossings(solid.table(), leaves[i], line);
        inside[i] = own.begins_inside;
        for (const Real128 t : own.t) changes.push_back({t, i});
    }
    std::sort(changes.begin(), changes.end(),
              [](const Change& a, const Change& b) { return a.t < b.t; });
    const Expression expression(solid.expression(), inside);
    ExactCrossings found;
    bool now = found.begins_inside = expression.node(0);
    for (std::size_t i = 0; i < changes.size(); ++i) {
        inside[changes[i].leaf] = !inside[changes[i].leaf];
        // Consecutive crossings closer than `least` are merged.
        if (i + 1 < changes.size() && !(changes[i + 1].t - changes[i].t > least)) continue;
        if (expression.node(0) == now) continue;
        now = !now;
        found.t.push_back(changes[i].t);
    }
    return found;
}

void drop_thin(ExactCrossings& crossings, Real128 least) {
    std::vector<Real128> kept;
    for (const Real128 t : crossings.t) {
        if (!kept.empty() && !(t - kept.back() > least)) {
            kept.pop_back();
        } else {
            kept.push_back(t);
        }
    }
    crossings.t = std::move(kept);
}

}  // namespace alhazen
