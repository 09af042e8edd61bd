#pragma once
/// Who is above whom among the nodes of a document, answered at once for any two.
///
/// Source: the intervals of a depth-first walk; R. E. Tarjan, "Depth-first search and linear graph
/// algorithms", SIAM Journal on Computing 1(2), 1972.
/// Differs: no recursion, so that depth costs no stack. Nodes in or below a loop have no root.
/// Complexity and threads: built in O(nodes); queries in O(1), from any thread.

#include <vector>

#include "alhazen/formats/gltf/document/gltf_document.h"

namespace alhazen::gltf {

class NodeTree {
  public:
    explicit NodeTree(const std::vector<Node>& nodes);

    [[nodiscard]] bool has_parent(Index node) const;
    /// In a loop, or below a node that is.
    [[nodiscard]] bool is_in_loop(Index node) const;
    /// The topmost node above, itself for a root; meaningless in a loop.
    [[nodiscard]] Index root_of(Index node) const;
    /// Whether `node` is `ancestor` or below it.
    [[nodiscard]] bool contains(Index ancestor, Index node) const;

  private:
    struct Span {
        std::uint32_t enter = 0, leave = 0;
    };
    std::vector<Index> parents_, roots_;
    std::vector<Span> spans_;
};

}  // namespace alhazen::gltf
