#pragma once
/// Photons in cells of a hashed grid, for range searches of one radius.
///
/// Source: Hachisuka and Jensen, "Stochastic Progressive Photon Mapping", SIGGRAPH Asia 2009
/// (hashed cells); Teschner et al., "Optimized Spatial Hashing for Collision Detection of
/// Deformable Objects", VMV 2003.
/// Conventions: cells are two radii wide, so that a search visits eight. Photons are visited in the
/// order of the cells, and within a cell in that of the list.
/// Complexity: build O(n), kBytesOfPhoton for each. Threads: const functions may be called
/// concurrently.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/renderers/photons/photon.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

/// `Record`: has `point()` with finite coordinates.
template <class Record>
class PointGrid {
  public:
    /// Memory during construction.
    static constexpr std::size_t kBytesOfPhoton = 2 * sizeof(Record) + 3 * sizeof(std::uint32_t);

    /// `radius` must be positive; at most 2^31 records.
    PointGrid(std::vector<Record> records, double radius) : radius_(radius) {
        const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(1, records.size()));
        mask_ = buckets - 1;
        first_.assign(buckets + 1, 0);
        for (const Record& r : records) ++first_[bucket_of(cell_of(r.point())) + 1];
        for (std::size_t b = 0; b < buckets; ++b) first_[b + 1] += first_[b];
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        records_.resize(records.size());
        for (const Record& r : records) records_[next[bucket_of(cell_of(r.point()))]++] = r;
    }

    [[nodiscard]] std::size_t size() const { return records_.size(); }
    [[nodiscard]] double radius() const { return radius_; }

    /// Calls `use(record)` for each record within the radius of the point.
    template <class Use>
    void for_near(const Vec3& point, Use&& use) const {
        if (records_.empty()) return;
        // The cell of the lowest corner of the ball, and its neighbours.
        const Cell low = cell_of(point - Vec3{radius_, radius_, radius_});
        for (int k = 0; k < 8; ++k) {
            const Cell cell{low[0] + (k & 1), low[1] + (k >> 1 & 1), low[2] + (k >> 2)};
            for (const Record& record : bucket(cell)) {
                const Vec3 at = record.point();
                if (!(length_squared(at - point) <= radius_ * radius_)) continue;
                // Skips records of other cells in the same bucket.
                if (cell_of(at) == cell) use(record);
            }
        }
    }

  private:
    using Cell = std::array<std::int64_t, 3>;
    [[nodiscard]] Cell cell_of(const Vec3& point) const {
        // Beyond this a cell is smaller than the rounding of the coordinate.
        constexpr double kMost = 0x1p60;
        const double side = 2.0 * radius_;
        const auto of = [&](double x) {
            return static_cast<std::int64_t>(std::clamp(std::floor(x / side), -kMost, kMost));
        };
        return {of(point.x), of(point.y), of(point.z)};
    }
    [[nodiscard]] std::size_t bucket_of(const Cell& cell) const {
        std::uint64_t hash = 0;
        for (const std::int64_t c : cell) hash = mix64(hash ^ static_cast<std::uint64_t>(c));
        return static_cast<std::size_t>(hash) & mask_;
    }
    [[nodiscard]] std::span<const Record> bucket(const Cell& cell) const {
        const std::size_t b = bucket_of(cell);
        return std::span(records_).subspan(first_[b], first_[b + 1] - first_[b]);
    }

    double radius_;
    std::size_t mask_ = 0;  ///< buckets - 1
    std::vector<Record> records_;
    std::vector<std::uint32_t> first_;  ///< [bucket] first in records_; and one more
};

using PhotonGrid = PointGrid<Photon>;

}  // namespace alhazen
