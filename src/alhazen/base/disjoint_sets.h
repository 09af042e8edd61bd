#pragma once
/// Disjoint sets of integers with union; a set is represented by its least member.
///
/// Source: Tarjan, "Efficiency of a Good But Not Linear Set Union Algorithm", J. ACM 22(2), 1975.
/// Differs: path halving; the least member is the root, without ranks.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace alhazen {

class DisjointSets {
  public:
    /// `count` sets of one number each, from 0.
    explicit DisjointSets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0u);
    }
    /// [number] an equal or smaller member of its set.
    explicit DisjointSets(std::vector<std::uint32_t> parents) : parents_(std::move(parents)) {}

    std::uint32_t find(std::uint32_t v) {
        while (parents_[v] != v) v = parents_[v] = parents_[parents_[v]];
        return v;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parents_;
};

}  // namespace alhazen
