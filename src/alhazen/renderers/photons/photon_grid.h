#pragma once
/// Photons in cells of a hashed grid, which finds all within one radius.
///
/// Source: Hachisuka and Jensen, "Stochastic Progressive Photon Mapping", SIGGRAPH Asia 2009
/// (hashed cells); Teschner et al., "Optimized Spatial Hashing for Collision Detection of
/// Deformable Objects", VMV 2003.
/// Conventions: cells are two radii wide, so that a search looks into eight. Photons are told in
/// the order of the cells, and in a cell in that of the list.
/// Complexity: build O(n), kBytesOfPhoton for each. Threads: const functions may be called from
/// many.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/renderers/photons/photon.h"

namespace alhazen {

class PhotonGrid {
  public:
    /// While it is built.
    static constexpr std::size_t kBytesOfPhoton = 2 * sizeof(Photon) + 3 * sizeof(std::uint32_t);

    /// `radius` above 0; at most 2^31 photons, of finite positions.
    PhotonGrid(std::vector<Photon> photons, double radius);

    [[nodiscard]] std::size_t size() const { return photons_.size(); }
    [[nodiscard]] double radius() const { return radius_; }

    /// Calls `use(photon)` for each photon within the radius of the point.
    template <class Use>
    void for_near(const Vec3& point, Use&& use) const {
        if (photons_.empty()) return;
        // The cell of the lowest corner of the ball, and those beside it.
        const Cell low = cell_of(point - Vec3{radius_, radius_, radius_});
        for (int k = 0; k < 8; ++k) {
            const Cell cell{low[0] + (k & 1), low[1] + (k >> 1 & 1), low[2] + (k >> 2)};
            for (const Photon& photon : bucket(cell)) {
                const Vec3 at = photon.point();
                if (!(length_squared(at - point) <= radius_ * radius_)) continue;
                // Other cells may share the bucket.
                if (cell_of(at) == cell) use(photon);
            }
        }
    }

  private:
    using Cell = std::array<std::int64_t, 3>;
    [[nodiscard]] Cell cell_of(const Vec3& point) const;
    [[nodiscard]] std::size_t bucket_of(const Cell& cell) const;
    [[nodiscard]] std::span<const Photon> bucket(const Cell& cell) const {
        const std::size_t b = bucket_of(cell);
        return std::span(photons_).subspan(first_[b], first_[b + 1] - first_[b]);
    }

    double radius_;
    std::size_t mask_ = 0;  ///< buckets - 1
    std::vector<Photon> photons_;
    std::vector<std::uint32_t> first_;  ///< [bucket] of photons_; and all
};

}  // namespace alhazen
