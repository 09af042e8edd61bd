#pragma once
/// A grid over the plane of a polygon of many corners: most points are inside or outside by the
/// cell that they lie in, whatever the number of corners. Cells near an edge are divided once more.
///
/// Source: Haines, "Point in Polygon Strategies", Graphics Gems IV, 1994 (the grid method).
/// Differs: a cell keeps no edges. It is inside or outside if no edge comes near it, by more than
/// the errors of the caller's test; the other cells are left to that test.
/// Conventions: the plane's coordinates are the two axes along which the normal is not longest.
/// Complexity: a point takes O(1). 0.3 bytes for each of 16 x 16 cells, or along each axis half of
/// the largest power of two that is not above the number of corners, at most 256: 20 KB; and four
/// bytes for each cell near an edge, mostly about as much.
/// While they are made, 20 bytes for each row of parts of an edge.

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

class PolygonCells {
  public:
    enum class Place : std::uint8_t { Outside, Inside, NearEdge };

    /// Polygons of fewer corners have no cells.
    static constexpr std::size_t kFewestCorners = 16;

    /// Factors of the error bound of `place_in_cells` (polygon.cpp), and the least cosine between
    /// ray and normal, and the least value of its right side, for which it holds: below, products
    /// may have underflowed.
    static constexpr double kAlongRay = 5.0, kAcross = 4.0, kLeastCosine = 1e-200,
                            kLeastRoom = 1e-280;

    /// `vertices` and `loop_ends` as in Polygon; `bounds` contains all vertices. Null if they are
    /// few, or if the bounds have no extent in the plane.
    [[nodiscard]] static std::shared_ptr<const PolygonCells> make(
        std::span<const Vec3> vertices, std::span<const std::uint32_t> loop_ends,
        const Vec3& normal, const Box3& bounds);

    /// Use `make`.
    PolygonCells(std::span<const Vec3> vertices, std::span<const std::uint32_t> loop_ends,
                 const Vec3& normal, const Box3& bounds);

    /// The two coordinates, as indices of a vector's components.
    [[nodiscard]] const std::array<int, 2>& axes() const { return axes_; }
    /// The distance along each of them by which point and edges together may be off in `place_of`.
    [[nodiscard]] const std::array<double, 2>& margin() const { return margin_; }
    /// Largest distance of two points of the bounds: the sum over all three coordinates.
    [[nodiscard]] double reach() const { return reach_; }
    /// Place of the point with these two coordinates, which is in the bounds or within the margin
    /// of them.
    [[nodiscard]] Place place_of(double x, double y) const {
        const std::size_t px = part_along(0, x), py = part_along(1, y);
        const std::size_t cell = py / kParts * side_ + px / kParts;
        const std::uint64_t here = places_[cell / kInWord];
        const auto place = static_cast<Place>(here >> (2 * (cell % kInWord)) & 3);
        if (place != Place::NearEdge) return place;
        const std::uint32_t parts = parts_[near_before(cell)];
        return static_cast<Place>(parts >> (2 * (py % kParts * kParts + px % kParts)) & 3);
    }
    [[nodiscard]] std::size_t memory_bytes() const {
        return sizeof(*this) + places_.size() * sizeof(std::uint64_t) +
               near_before_.size() * sizeof(std::uint16_t) + parts_.size() * sizeof(std::uint32_t);
    }

  private:
    static constexpr std::size_t kInWord = 32;  ///< cells
    static constexpr std::size_t kParts = 4;    ///< of a cell near an edge, along each axis
    /// The upper bit of each place: those of NearEdge.
    static constexpr std::uint64_t kNearBits = 0xAAAA'AAAA'AAAA'AAAA;

    [[nodiscard]] std::size_t part_along(std::size_t k, double at) const {
        const double part = (at - lo_[k]) * per_part_[k];
        // Written so that NaN becomes 0.
        if (!(part > 0.0)) return 0;
        return part < last_ ? static_cast<std::size_t>(part) : kParts * side_ - 1;
    }
    /// The number of cells near an edge before this one.
    [[nodiscard]] std::size_t near_before(std::size_t cell) const {
        const std::size_t word = cell / kInWord;
        const std::uint64_t before = (std::uint64_t{1} << (2 * (cell % kInWord))) - 1;
        return near_before_[word] +
               static_cast<std::size_t>(std::popcount(places_[word] & before & kNearBits));
    }

    std::array<int, 2> axes_;
    std::array<double, 2> lo_, per_part_, margin_;
    double reach_, last_;
    std::size_t side_;                        ///< cells along each axis
    std::vector<std::uint64_t> places_;       ///< [row of cells][cell], two bits each
    std::vector<std::uint16_t> near_before_;  ///< [word of places_]
    /// [cell near an edge][row of parts][part] two bits each: the places of its parts
    std::vector<std::uint32_t> parts_;
};

}  // namespace alhazen
