#pragma once
/// Which parts of a scene may have a face at the place of another part's face, by their boxes: most
/// searches for coincident faces need not be made.
///
/// Conventions: a part is told from others by HitParts. Boxes hold a part while the shutter is open
/// and are enlarged by kSlack times the coordinates that went into them, far more than the rounding
/// of hits. Parts of which nothing is known may touch anything: opaque and unbounded ones, those of
/// objects of more than kMostInObject pieces, those near more than kMostNear pieces of others, or
/// among so many boxes that a search for them is given up.
/// Complexity and threads: O(n log n) for n parts; const functions may be called from many threads.

#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/surface.h"

namespace alhazen {

class NearbyParts {
  public:
    static constexpr double kSlack = 0x1p-26;
    static constexpr std::size_t kMostNear = 8;
    static constexpr std::size_t kMostInObject = 16;
    static constexpr std::size_t kMostUnbounded = 4;

    /// `moves`: something in the aggregate moves.
    NearbyParts(const Aggregate& root, std::span<const Material> materials, bool moves);

    /// False if bounded parts, but that of the surface, have no hit within `reach` of its point.
    [[nodiscard]] bool may_touch(const Surface& surface, double reach) const {
        if (known_.empty()) return true;
        const auto found = known_.find(key({surface.part, surface.instance}));
        // Also for NaN.
        if (found == known_.end() || !(reach <= found->second.most_reach)) return true;
        const Known& known = found->second;
        for (std::uint32_t i = known.first; i < known.end; ++i) {
            if (boxes_[i].contains(surface.point)) return true;
        }
        return false;
    }
    /// A primitive of the root that is unbounded, or holds unbounded ones.
    struct Unbounded {
        PrimitiveId id{};
        bool is_plane = false;
        Vec3 place, unit_normal;  ///< of a plane

        /// False if it has no hit within `reach` of the point.
        [[nodiscard]] bool may_touch(const Vec3& point, double reach) const {
            if (!is_plane) return true;
            const double slack = kSlack * max_component(abs(point) + abs(place));
            // Also for NaN.
            return !(std::abs(dot(point - place, unit_normal)) > reach + slack);
        }
    };
    /// Ascending.
    [[nodiscard]] std::span<const Unbounded> unbounded() const { return unbounded_; }

  private:
    struct Known {
        double most_reach = 0;
        std::uint32_t first = 0, end = 0;  ///< of `boxes_`
    };
    [[nodiscard]] static std::uint64_t key(const HitParts& parts) {
        return std::uint64_t{parts.instance} << 32 | parts.part;
    }

    std::unordered_map<std::uint64_t, Known> known_;  ///< [key]
    std::vector<Box3> boxes_;  ///< of other parts, enlarged by the slack of both
    std::vector<Unbounded> unbounded_;
};

}  // namespace alhazen
