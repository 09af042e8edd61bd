#pragma once
/// Hits of rays: only ids and parameters, never pointers. Points and normals are computed once, for
/// the closest hit (see `Surface`).

#include <cstdint>
#include <limits>

#include "alhazen/base/inline_vector.h"
#include "alhazen/math/vec.h"

namespace alhazen {

enum class PrimitiveId : std::uint32_t {};
inline constexpr PrimitiveId kNoPrimitive{0xFFFFFFFFu};

/// One crossing of a ray with one shape, in the shape's own parameters.
struct ShapeHit {
    double t = 0;
    double u = 0, v = 0;     ///< parameters of the crossing, as the shape defines them
    std::uint32_t part = 0;  ///< number of the shape's surface (side, cap, face)
};

/// Maximum depth of nested instances; the scene compiler rejects deeper nesting.
inline constexpr std::size_t kMaxInstanceDepth = 32;

/// The instance primitives around a hit, innermost first.
using InstancePath = InlineVector<PrimitiveId, kMaxInstanceDepth>;

/// A crossing of a ray with a scene. `primitive` is an id in the innermost aggregate of the path.
struct Hit : ShapeHit {
    Hit() { t = std::numeric_limits<double>::infinity(); }

    PrimitiveId primitive = kNoPrimitive;
    InstancePath path;

    [[nodiscard]] bool found() const { return primitive != kNoPrimitive; }
    /// The id in the outermost aggregate, which breaks ties.
    [[nodiscard]] PrimitiveId top() const { return path.empty() ? primitive : path.back(); }
};

}  // namespace alhazen
