#pragma once
/// A solid in positive form: n-ary unions and intersections over leaves, some of them complemented,
/// with the S-bound of every leaf.
///
/// Source: Cameron, "Efficient Bounds in Constructive Solid Geometry", IEEE CG&A 11(3), 1991
/// (S-bounds); Goldfeather, Monar, Turk and Fuchs, "Near Real-Time CSG Rendering Using Tree
/// Normalization and Geometric Pruning", IEEE CG&A 9(3), 1989 (positive form).
/// Differs: equal nested operators are merged; a complement does not bound its parent, but is
/// itself bounded by its primitive; where the boxes do not bound an intersection, its half spaces
/// may (convex_corners.h).
/// Conventions: points outside the S-bound of a leaf may be evaluated as outside the leaf's
/// primitive without changing the value of the root.
/// Complexity and threads: O(n) per sweep, at most four sweeps, and O(half spaces^2) for at most
/// 1000 of an intersection without a bounded box. Immutable after construction.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "alhazen/csg/csg_expression.h"
#include "alhazen/geometry/box.h"
#include "alhazen/geometry/polygon/convex_corners.h"

namespace alhazen {

class CsgTree {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    /// A node is true if the number of its true operands exceeds the number outside all leaves'
    /// primitives by at least `need`.
    struct Node {
        std::uint32_t parent = kNone;
        std::int32_t need = 0;
    };
    struct Leaf {
        std::uint32_t parent = kNone;
        bool complement = false;
        /// Inside its primitive the value of the root is fixed regardless of the other leaves: an
        /// operand of a union, or a subtracted one, at the root.
        bool decides = false;
        /// Its primitive contains the solid: an operand of an intersection at the root.
        bool holds = false;
    };

    CsgTree() = default;
    /// `boxes` contain the primitives of the leaves; infinite for unbounded ones. `planes`: those
    /// of leaves that are half spaces, with unit normals out of them.
    CsgTree(const CsgExpression& expression, std::span<const Box3> boxes,
            std::span<const std::optional<OrientedPlane>> planes);

    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<Leaf>& leaves() const { return leaves_; }
    /// S-bounds; empty for a leaf without effect on the solid.
    [[nodiscard]] const std::vector<Box3>& bounds() const { return bounds_; }
    /// A box that contains the solid.
    [[nodiscard]] const Box3& box() const { return box_; }
    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    struct Draft;
    void flatten(const CsgExpression& expression, Draft& draft);
    void set_needs(const Draft& draft);
    void tighten(const Draft& draft, std::span<const Box3> boxes,
                 std::span<const std::optional<OrientedPlane>> planes);

    std::vector<Node> nodes_;  ///< parents before their children; [0] is the root
    std::vector<Leaf> leaves_;
    std::vector<Box3> bounds_;
    Box3 box_;
};

}  // namespace alhazen
