#pragma once
/// Visibility of the pieces that a cone meets: coverages combined front to back.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3 (a list of the closest
/// few objects); adding pieces that abut is his remedy against seams.
/// Differs: an object is a surface: faces and triangles that share edges, on one side. Coverages of
/// pieces of one surface are added up to 1; those of different surfaces are treated as independent,
/// so that the remainder of the cone is the product of their remainders. The closest eight surfaces
/// are distinguished; all others share the last entry. If a surface has many pieces, only a few are
/// shaded, evenly distributed over their coverage.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "alhazen/base/inline_vector.h"
#include "alhazen/renderers/cone_tracing/cone_search.h"

namespace alhazen {

/// The surfaces that cover a part of a cone, and their coverages.
class ConeSurfaces {
  public:
    static constexpr std::size_t kMost = 8;

    /// Adds a piece behind all previous ones and returns its visible share. `number` is set to the
    /// index of its surface in the list.
    double add(std::uint32_t surface, bool front, double share, std::size_t& number) {
        number = find(surface, front);
        double others = 1.0;
        for (std::size_t k = 0; k < list_.size(); ++k) {
            if (k != number) others *= 1.0 - list_[k].filled;
        }
        const double own = std::min(share, 1.0 - list_[number].filled);
        list_[number].filled += own;
        return own * others;
    }
    /// The share that no surface covers.
    [[nodiscard]] double left() const {
        double left = 1.0;
        for (const One& one : list_) left *= 1.0 - one.filled;
        return left;
    }

  private:
    struct One {
        std::uint32_t surface;
        bool front;
        double filled;
    };
    std::size_t find(std::uint32_t surface, bool front) {
        for (std::size_t k = 0; k < list_.size(); ++k) {
            if (list_[k].surface == surface && list_[k].front == front) return k;
        }
        if (!list_.full()) list_.push_back({surface, front, 0.0});
        return list_.size() - 1;
    }
    InlineVector<One, kMost> list_;
};

/// A piece and the share of the cone in which it is visible.
struct SeenPiece {
    ConePiece piece;
    double weight = 0;
    std::size_t surface = 0;  ///< index of its surface
};

/// Keeps at most `most` pieces of each surface, evenly distributed by weight, with the sum of the
/// weights unchanged.
inline void thin_out(std::vector<SeenPiece>& seen, std::size_t most) {
    if (seen.size() <= most) return;
    std::array<std::size_t, ConeSurfaces::kMost> count{};
    std::array<double, ConeSurfaces::kMost> total{}, before{};
    for (const SeenPiece& s : seen) {
        ++count[s.surface];
        total[s.surface] += s.weight;
    }
    const double steps = static_cast<double>(most);
    const auto is_left_out = [&](SeenPiece& s) {
        if (count[s.surface] <= most) return false;
        // Number of middles of `most` equal parts that fall into this piece.
        const double step = total[s.surface] / steps;
        double& from = before[s.surface];
        const double first = std::ceil(from / step - 0.5);
        from += s.weight;
        const double end = std::min(std::ceil(from / step - 0.5), steps);
        s.weight = step * std::max(end - first, 0.0);
        return !(s.weight > 0.0);
    };
    seen.erase(std::remove_if(seen.begin(), seen.end(), is_left_out), seen.end());
}

}  // namespace alhazen
