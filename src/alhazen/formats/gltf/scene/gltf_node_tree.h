#pragma once
/// Ancestor queries on the nodes of a document.
///
/// Source: intervals of a depth-first traversal; R. E. Tarjan, "Depth-first search and linear graph
/// algorithms", SIAM Journal on Computing 1(2), 1972.
/// Differs: iterative, so that deep trees do not overflow the stack. Nodes in or below a cycle have
/// no root.
/// Complexity and threads: O(nodes) to build; queries O(1), thread-safe.

#include <vector>

#include "alhazen/formats/gltf/document/gltf_document.h"

namespace alhazen::gltf {

class NodeTree {
  public:
    explicit NodeTree(const std::vector<Node>& nodes);

    [[nodiscard]] bool has_parent(Index node) const;
    /// True for a node in a cycle or below one.
    [[nodiscard]] bool is_in_loop(Index node) const;
    /// The topmost ancestor, which is the node itself for a root; undefined in a cycle.
    [[nodiscard]] Index root_of(Index node) const;
    /// True if `node` is `ancestor` or a descendant of it.
    [[nodiscard]] bool contains(Index ancestor, Index node) const;

  private:
    struct Span {
        std::uint32_t enter = 0, leave = 0;
    };
    std::vector<Index> parents_, roots_;
    std::vector<Span> spans_;
};

}  // namespace alhazen::gltf
