#include "alhazen/shapes/polygons/polygon_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace alhazen {

namespace {

constexpr std::size_t kLeastSide = 16, kMostSide = 256;
/// The margin in parts of cells. Edges mark the parts within twice of it, for rounding errors here.
constexpr double kMargin = 1.0 / 64;
constexpr double kLeastExtent = 1e-300, kMostExtent = 1e300;

std::array<int, 2> axes_across(const Vec3& normal) {
    const int longest = dominant_axis(normal);
    return {longest == 0 ? 1 : 0, longest == 2 ? 1 : 2};
}

/// An edge in units of parts, y0 <= y1.
struct CellEdge {
    double x0, y0, x1, y1;

    [[nodiscard]] double x_at(double y) const {
        if (y <= y0) return x0;
        if (y >= y1) return x1;
        return x0 + (y - y0) / (y1 - y0) * (x1 - x0);
    }
};

/// Calls `mark(row, first, last)` for the parts that come near an edge, of `side` along each axis.
template <class Mark>
void parts_near(const CellEdge& edge, std::size_t side, Mark&& mark) {
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
    const std::size_t parts = kParts * side_;
    last_ = static_cast<double>(parts - 1);
    for (std::size_t k = 0; k < 2; ++k) {
        lo_[k] = bounds.lo[axes_[k]];
        per_part_[k] = static_cast<double>(parts) / size[axes_[k]];
        margin_[k] = kMargin / per_part_[k];
    }

    std::vector<CellEdge> edges;
    edges.reserve(vertices.size());
    std::size_t first = 0;
    for (const std::size_t end : loop_ends) {
        const auto along = [&](const Vec3& v, std::size_t k) {
            return (v[axes_[k]] - lo_[k]) * per_part_[k];
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

    places_.assign((side_ * side_ + kInWord - 1) / kInWord, 0);
    const auto set_place = [&](std::size_t cell, Place place) {
        places_[cell / kInWord] |= static_cast<std::uint64_t>(place) << (2 * (cell % kInWord));
    };
    // Where edges cross the line through the middles of a row of parts: the first part whose middle
    // is beyond.
    std::vector<std::vector<std::uint32_t>> crossings(parts);
    for (const CellEdge& edge : edges) {
        parts_near(edge, parts, [&](std::size_t row, std::size_t from, std::size_t to) {
            for (std::size_t k = from / kParts; k <= to / kParts; ++k) {
                set_place(row / kParts * side_ + k, Place::NearEdge);
            }
            const double middle = static_cast<double>(row) + 0.5;
            if (edge.y0 <= middle && middle < edge.y1) {
                const double part = std::floor(edge.x_at(middle) + 0.5);
                if (part < static_cast<double>(parts)) {
                    crossings[row].push_back(static_cast<std::uint32_t>(std::max(part, 0.0)));
                }
            }
        });
    }
    std::size_t near = 0;
    for (const std::uint64_t word : places_) {
        near_before_.push_back(static_cast<std::uint16_t>(near));
        near += static_cast<std::size_t>(std::popcount(word & kNearBits));
    }
    parts_.assign(near, 0);
    for (const CellEdge& edge : edges) {
        parts_near(edge, parts, [&](std::size_t row, std::size_t from, std::size_t to) {
            for (std::size_t i = from; i <= to; ++i) {
                parts_[near_before(row / kParts * side_ + i / kParts)] |=
                    static_cast<std::uint32_t>(Place::NearEdge)
                    << (2 * (row % kParts * kParts + i % kParts));
            }
        });
    }
    // Inside, from crossing to crossing: parts of cells near an edge, and the other cells by the
    // first row of their parts.
    for (std::size_t row = 0; row < parts; ++row) {
        std::vector<std::uint32_t>& here = crossings[row];
        std::sort(here.begin(), here.end());
        for (std::size_t n = 0; n < here.size(); n += 2) {
            const std::size_t end = n + 1 < here.size() ? here[n + 1] : parts;
            for (std::size_t i = here[n]; i < end;) {
                const std::size_t cell = row / kParts * side_ + i / kParts;
                if ((places_[cell / kInWord] >> (2 * (cell % kInWord)) & 2) == 0) {
                    if (row % kParts == 0) set_place(cell, Place::Inside);
                    i = (i / kParts + 1) * kParts;
                    continue;
                }
                std::uint32_t& places = parts_[near_before(cell)];
                const std::size_t at = 2 * (row % kParts * kParts + i % kParts);
                if ((places >> at & 2) == 0) places |= std::uint32_t{1} << at;
                ++i;
            }
        }
    }
}

}  // namespace alhazen
