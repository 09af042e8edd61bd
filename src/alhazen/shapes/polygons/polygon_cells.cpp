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
    // [row of parts] where edges cross the line through its middle: the first part whose middle is
    // beyond, as a list.
    struct Crossing {
        std::uint32_t part, next;
    };
    constexpr std::uint32_t kEnd = ~0u;
    std::vector<Crossing> crossings;
    struct Span {
        std::uint32_t row, from, to;
    };
    std::vector<Span> near_edges;
    std::vector<std::uint32_t> last_crossing(parts, kEnd);
    for (const CellEdge& edge : edges) {
        parts_near(edge, parts, [&](std::size_t row, std::size_t from, std::size_t to) {
            near_edges.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(from),
                                  static_cast<std::uint32_t>(to)});
            for (std::size_t k = from / kParts; k <= to / kParts; ++k) {
                set_place(row / kParts * side_ + k, Place::NearEdge);
            }
            const double middle = static_cast<double>(row) + 0.5;
            if (edge.y0 <= middle && middle < edge.y1) {
                const double part = std::floor(edge.x_at(middle) + 0.5);
                if (part < static_cast<double>(parts)) {
                    crossings.push_back(
                        {static_cast<std::uint32_t>(std::max(part, 0.0)), last_crossing[row]});
                    last_crossing[row] = static_cast<std::uint32_t>(crossings.size() - 1);
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
    // Calls f(cell, bits) for the cells of a part of a row; the lower bits of its places there.
    const auto for_cells = [&](std::size_t row, std::size_t from, std::size_t to, auto&& f) {
        for (std::size_t k = from / kParts; k <= to / kParts; ++k) {
            const std::size_t lo = std::max(from, k * kParts) - k * kParts;
            const std::size_t hi = std::min(to - k * kParts, kParts - 1);
            const std::uint32_t bits = 0x55u >> (2 * (kParts - 1 - (hi - lo))) << (2 * lo);
            f(row / kParts * side_ + k, bits << (2 * kParts * (row % kParts)));
        }
    };
    for (const Span& span : near_edges) {
        for_cells(span.row, span.from, span.to, [&](std::size_t cell, std::uint32_t bits) {
            parts_[near_before(cell)] |= bits << 1;
        });
    }
    // Inside, from crossing to crossing: parts of cells near an edge, and the other cells by the
    // first row of their parts.
    std::vector<std::size_t> here;
    for (std::size_t row = 0; row < parts; ++row) {
        here.clear();
        for (std::uint32_t i = last_crossing[row]; i != kEnd; i = crossings[i].next) {
            here.push_back(crossings[i].part);
        }
        std::sort(here.begin(), here.end());
        if (here.size() % 2 != 0) here.push_back(parts);
        for (std::size_t n = 0; n < here.size(); n += 2) {
            if (here[n] == here[n + 1]) continue;
            for_cells(row, here[n], here[n + 1] - 1, [&](std::size_t cell, std::uint32_t bits) {
                if ((places_[cell / kInWord] >> (2 * (cell % kInWord)) & 2) == 0) {
                    if (row % kParts == 0) set_place(cell, Place::Inside);
                    return;
                }
                std::uint32_t& places = parts_[near_before(cell)];
                places |= bits & ~(places >> 1);
            });
        }
    }
}

}  // namespace alhazen
