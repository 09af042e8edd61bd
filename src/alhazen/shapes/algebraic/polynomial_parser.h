#pragma once
/// The grammar of polynomial expressions, read by recursive descent.
///
/// Conventions: internal to this folder.
///   sum := product { ("+" | "-") product }       product := factor { ("*" | "/") factor }
///   factor := "-" factor | "+" factor | atom ["^" WHOLE NUMBER]
///   atom := NUMBER | "x" | "y" | "z" | "(" sum ")" | "sqrt" "(" sum ")"

#include <string_view>

#include "alhazen/shapes/algebraic/polynomial_expression.h"

namespace alhazen {

/// The nodes of an expression; throws Error (Scene).
[[nodiscard]] std::vector<PolynomialExpression::Node> parse_polynomial(std::string_view text);

}  // namespace alhazen
