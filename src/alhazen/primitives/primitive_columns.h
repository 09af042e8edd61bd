#pragma once
/// Access to the column of an analytic kind known at run time.

#include <tuple>
#include <type_traits>
#include <utility>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// The shape type of a column, given the type of a reference to it.
template <class Column>
struct ShapeOfColumn {
    using Type = typename decltype(std::remove_cvref_t<Column>::shapes)::value_type;
};

/// Calls `f(column)` with the column of `table.columns` that holds `kind`, which is below
/// kTriangleKind.
template <std::size_t I = 0, class Columns, class F>
decltype(auto) with_column(Columns& columns, std::uint32_t kind, F&& f) {
    if constexpr (I + 1 < AnalyticShapes::kCount) {
        if (kind != I) return with_column<I + 1>(columns, kind, std::forward<F>(f));
    }
    return f(std::get<I>(columns));
}

}  // namespace alhazen
