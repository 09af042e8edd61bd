#include "alhazen/shapes/polygons/polygon_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace alhazen {

namespace {

constexpr std::size_t kLeastSide = 16, kMostSide = 256;
/// The margin in cells. Edges mark the cells within twice of it, for rounding errors here.
constexpr double kMargin = 1.0 / 64;
constexpr double kLeastExtent = 1e-300, kMostExtent = 1e300;

std::array<int, 2> axes_across(const Vec3& normal) {
    const int longest = dominant_axis(normal);
    return {longest == 0 ? 1 : 0, longest == 2 ? 1 : 2};
}

/// An edge in units of cells, y0 <= y1.
struct CellEdge {
    double x0, y0, x1, y1;

    [[nodiscard]] double x_at(double y) const {
        if (y <= y0) return x0;
        if (y >= y1) return x1;
        return x0 + (y - y0) / (y1 - y0) * (x1 - x0);
    }
};

/// Calls `mark(row, first, last)` for the cells that come near an edge.
template <class Mark>
void cells_near(const CellEdge& edge, std::size_t side, Mark&& mark) {
    const auto cell = [&](double at) {
        return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(side - 1)));
    };
    constexpr double kNear = 2.0 * kMargin;
    const std::size_t last_row = cell(edge.y1 + kNear);
    for (std::size_t row = cell(edge.y0 - kNear); row <= last_row; ++row) {
        const auto y = static_cast<double>(row);
        const double a = edge.x_at(y - kNear), b = edge.x_at(y + 1.0 + kNear);
        mark(row, cell(std::min(a, b) - kNear), cell(std::max(a, b) + kNear));
    }
}

}  // namespace

std::shared_ptr<const PolygonCells> PolygonCells::make(std::span<const Vec3> vertices,
                                                       std::span<const std::uint32_t> loop_ends,
                                                       const Vec3& normal, const Box3& bounds) {
    if (vertices.size() < kFewestCorners) return nullptr;
    const Vec3 size = bounds.size();
    for (const int axis : axes_across(normal)) {
        if (!(size[axis] >= kLeastExtent && size[axis] <= kMostExtent)) return nullptr;
    }
    if (!std::ranges::all_of(vertices, [](const Vec3& v) { return is_finite(v); })) return nullptr;
    return std::make_shared<const PolygonCells>(vertices, loop_ends, normal, bounds);
}

PolygonCells::PolygonCells(std::span<const Vec3> vertices, std::span<const std::uint32_t> loop_ends,
                           const Vec3& normal, const Box3& bounds)
    : axes_(axes_across(normal)),
      side_(std::clamp(std::bit_floor(vertices.size()) / 2, kLeastSide, kMostSide)) {
    const Vec3 size = bounds.size();
    reach_ = size.x + size.y + size.z;
    last_ = static_cast<double>(side_ - 1);
    for (std::size_t k = 0; k < 2; ++k) {
        lo_[k] = bounds.lo[axes_[k]];
        per_cell_[k] = static_cast<double>(side_) / size[axes_[k]];
        margin_[k] = kMargin / per_cell_[k];
    }

    std::vector<CellEdge> edges;
    edges.reserve(vertices.size());
    std::size_t first = 0;
    for (const std::size_t end : loop_ends) {
        const auto along = [&](const Vec3& v, std::size_t k) {
            return (v[axes_[k]] - lo_[k]) * per_cell_[k];
        };
        for (std::size_t i = first; i < end; ++i) {
            const Vec3& a = vertices[i];
            const Vec3& b = vertices[i + 1 < end ? i + 1 : first];
            CellEdge edge{along(a, 0), along(a, 1), along(b, 0), along(b, 1)};
            if (edge.y0 > edge.y1) edge = {edge.x1, edge.y1, edge.x0, edge.y0};
            edges.push_back(edge);
        }
        first = end;
    }

    std::vector<Place> places(side_ * side_, Place::Outside);
    // [cell] whether an odd number of edges crosses the line through the middles of the row between
    // the middle of the cell before and its own.
    std::vector<std::uint8_t> flips(side_ * side_, 0);
    for (const CellEdge& edge : edges) {
        cells_near(edge, side_, [&](std::size_t row, std::size_t from, std::size_t to) {
            std::fill_n(places.begin() + static_cast<std::ptrdiff_t>(row * side_ + from),
                        to - from + 1, Place::NearEdge);
            const double middle = static_cast<double>(row) + 0.5;
            if (edge.y0 <= middle && middle < edge.y1) {
                const double cell = std::floor(edge.x_at(middle) + 0.5);
                if (cell < static_cast<double>(side_)) {
                    flips[row * side_ + static_cast<std::size_t>(std::max(cell, 0.0))] ^= 1;
                }
            }
        });
    }
    places_.assign((side_ * side_ + 31) / 32, 0);
    bool inside = false;
    for (std::size_t cell = 0; cell < places.size(); ++cell) {
        if (cell % side_ == 0) inside = false;
        inside ^= flips[cell] != 0;
        Place place = places[cell];
        if (place == Place::Outside && inside) place = Place::Inside;
        places_[cell / 32] |= static_cast<std::uint64_t>(place) << (2 * (cell % 32));
    }
}

}  // namespace alhazen
