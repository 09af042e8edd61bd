#pragma once
/// An octree of cubical cells, and the edges at which four of its leaves meet.
///
/// Source: Ju, Losasso, Schaefer and Warren, "Dual Contouring of Hermite Data", SIGGRAPH 2002 (the
/// recursion over cells, faces and edges; it needs no balance between the sizes of neighbours).
/// Differs: after a division only the edges of new leaves are visited.
/// Conventions: coordinates are whole numbers, from 0 to the size of the root. The cells around an
/// edge along `axis` are [u + 2 v], 0 or 1 by side along (axis + 1) % 3 and (axis + 2) % 3. An edge
/// is that of its smallest leaf, so a larger leaf may be two of the four. Edges on the border of
/// the root are none. Complexity: O(1) for each division, O(new leaves and their ancestors) for a
/// visit.

#include <array>
#include <cstdint>
#include <vector>

namespace alhazen {

class CellTree {
  public:
    using Node = std::array<std::uint32_t, 3>;
    struct Cell {
        Node at;
        std::uint32_t size;
        std::uint32_t parent;
        std::uint32_t first_child = 0;  ///< 0: a leaf
        bool has_new = true;            ///< it or a cell in it has not been visited
    };
    struct Edge {
        std::array<std::uint32_t, 4> cells;
        Node from;
        std::uint32_t length;
        std::uint32_t axis;
    };

    /// Precondition: `size` is a power of 2.
    explicit CellTree(std::uint32_t size) { cells_.push_back({{0, 0, 0}, size, 0}); }

    /// Numbers do not change; that of the root is 0.
    [[nodiscard]] const Cell& operator[](std::uint32_t cell) const { return cells_[cell]; }
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(cells_.size()); }
    [[nodiscard]] bool is_leaf(std::uint32_t cell) const { return cells_[cell].first_child == 0; }

    /// Divides a leaf into eight. Precondition: its size exceeds 1.
    void split(std::uint32_t cell) {
        const Cell own = cells_[cell];
        const std::uint32_t half = own.size / 2;
        cells_[cell].first_child = count();
        for (std::uint32_t k = 0; k < 8; ++k) {
            Node at = own.at;
            for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += half * (k >> axis & 1);
            cells_.push_back({at, half, cell});
        }
        for (std::uint32_t up = cell; !cells_[up].has_new; up = cells_[up].parent) {
            cells_[up].has_new = true;
        }
    }

    /// Calls `visit(edge)` for each edge of a leaf that no call has visited.
    template <class Visit>
    void visit_new_edges(const Visit& visit) {
        in_cell(0, visit);
        forget_new(0);
    }

  private:
    /// The child at sides along `axis` and the two after it; the cell itself if it is a leaf.
    [[nodiscard]] std::uint32_t child(std::uint32_t cell, std::uint32_t axis, std::uint32_t along,
                                      std::uint32_t u, std::uint32_t v) const {
        if (is_leaf(cell)) return cell;
        return cells_[cell].first_child + (along << axis) + (u << (axis + 1) % 3) +
               (v << (axis + 2) % 3);
    }

    template <class Visit>
    void in_cell(std::uint32_t cell, const Visit& visit) {
        if (is_leaf(cell) || !cells_[cell].has_new) return;
        for (std::uint32_t k = 0; k < 8; ++k) in_cell(cells_[cell].first_child + k, visit);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            for (std::uint32_t side = 0; side < 4; ++side) {
                const std::uint32_t u = side & 1, v = side >> 1;
                in_face(child(cell, axis, 0, u, v), child(cell, axis, 1, u, v), axis, visit);
            }
            for (std::uint32_t half = 0; half < 2; ++half) {
                std::array<std::uint32_t, 4> around{};
                for (std::uint32_t side = 0; side < 4; ++side) {
                    around[side] = child(cell, axis, half, side & 1, side >> 1);
                }
                at_edge(around, axis, visit);
            }
        }
    }
    /// Between two cells, `low` before `high` along the axis.
    template <class Visit>
    void in_face(std::uint32_t low, std::uint32_t high, std::uint32_t axis, const Visit& visit) {
        if (is_leaf(low) && is_leaf(high)) return;
        if (!cells_[low].has_new && !cells_[high].has_new) return;
        for (std::uint32_t side = 0; side < 4; ++side) {
            const std::uint32_t u = side & 1, v = side >> 1;
            in_face(child(low, axis, 1, u, v), child(high, axis, 0, u, v), axis, visit);
        }
        for (std::uint32_t half = 0; half < 2; ++half) {
            std::array<std::uint32_t, 4> one{}, two{};
            for (std::uint32_t side = 0; side < 4; ++side) {
                const std::uint32_t a = side & 1, b = side >> 1;
                // Around an edge along axis + 1 the sides are along axis + 2 and axis.
                one[side] = child(b == 0 ? low : high, axis, 1 - b, half, a);
                // Around an edge along axis + 2 they are along axis and axis + 1.
                two[side] = child(a == 0 ? low : high, axis, 1 - a, b, half);
            }
            at_edge(one, (axis + 1) % 3, visit);
            at_edge(two, (axis + 2) % 3, visit);
        }
    }
    template <class Visit>
    void at_edge(const std::array<std::uint32_t, 4>& around, std::uint32_t axis,
                 const Visit& visit) {
        bool any_new = false, all_leaves = true;
        std::uint32_t smallest = 0;
        for (std::uint32_t side = 0; side < 4; ++side) {
            const Cell& cell = cells_[around[side]];
            any_new |= cell.has_new;
            all_leaves &= cell.first_child == 0;
            if (cell.size < cells_[around[smallest]].size) smallest = side;
        }
        if (!any_new) return;
        if (all_leaves) {
            const Cell& cell = cells_[around[smallest]];
            Node from = cell.at;
            if ((smallest & 1) == 0) from[(axis + 1) % 3] += cell.size;
            if ((smallest >> 1) == 0) from[(axis + 2) % 3] += cell.size;
            visit(Edge{around, from, cell.size, axis});
            return;
        }
        for (std::uint32_t half = 0; half < 2; ++half) {
            std::array<std::uint32_t, 4> next{};
            for (std::uint32_t side = 0; side < 4; ++side) {
                next[side] = child(around[side], axis, half, 1 - (side & 1), 1 - (side >> 1));
            }
            at_edge(next, axis, visit);
        }
    }
    void forget_new(std::uint32_t cell) {
        if (!cells_[cell].has_new) return;
        cells_[cell].has_new = false;
        if (is_leaf(cell)) return;
        for (std::uint32_t k = 0; k < 8; ++k) forget_new(cells_[cell].first_child + k);
    }

    std::vector<Cell> cells_;
};

}  // namespace alhazen
