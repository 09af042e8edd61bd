#include "alhazen/solids/triangles/cell_sheets.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// Cosine of the largest angle of normals in a sheet without an edge.
constexpr double kSmoothCosine = 0.8;

/// The point nearest to the tangent planes at the crossings, weakly drawn to their mean, clamped to
/// a box.
Vec3 feature_point(std::span<const SurfaceCrossing> crossings, bool alone, const Vec3& lo,
                   const Vec3& hi) {
    constexpr double kDraw = 0.02;
    const double share = 1.0 / static_cast<double>(crossings.size());
    Vec3 point;
    for (const SurfaceCrossing& c : crossings) point = point + share * c.point;
    const Vec3 mean = point;
    Mat3 sum{{kDraw, 0, 0}, {0, kDraw, 0}, {0, 0, kDraw}};
    for (const SurfaceCrossing& c : crossings) {
        sum.x_axis = sum.x_axis + share * c.normal.x * c.normal;
        sum.y_axis = sum.y_axis + share * c.normal.y * c.normal;
        sum.z_axis = sum.z_axis + share * c.normal.z * c.normal;
    }
    const Mat3 solve = inverse(sum);
    for (int round = 0; round < 4; ++round) {
        Vec3 offset;
        for (const SurfaceCrossing& c : crossings) {
            offset = offset + share * dot(c.normal, c.point - point) * c.normal;
        }
        point = point + solve * offset;
    }
    if (!alone) {
        // Along the line from their mean: at a corner of the box sheets would meet.
        double most = 1;
        for (int k = 0; k < 3; ++k) {
            const double step = point[k] - mean[k];
            if (point[k] < lo[k]) most = std::min(most, (lo[k] - mean[k]) / step);
            if (point[k] > hi[k]) most = std::min(most, (hi[k] - mean[k]) / step);
        }
        point = mean + most * (point - mean);
    }
    for (int k = 0; k < 3; ++k) point[k] = std::clamp(point[k], lo[k], hi[k]);
    return point;
}

}  // namespace

std::size_t CellSheets::find(std::uint32_t cell, std::span<const std::uint32_t> uses) {
    joins_.clear();
    sheets_.resize(uses.size());
    for (std::uint32_t use = 0; use < uses.size(); ++use) {
        sheets_[use] = use;
        const SurfaceEdge& edge = edges_[uses[use]];
        const std::array<std::size_t, 4> ring = edge.ring();
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t a = edge.at.cells[ring[k]], b = edge.at.cells[ring[(k + 1) % 4]];
            if (a == b || (a != cell && b != cell)) continue;
            joins_.push_back({a == cell ? b : a, use});
        }
    }
    std::sort(joins_.begin(), joins_.end(), [](const Join& a, const Join& b) {
        return a.neighbour != b.neighbour ? a.neighbour < b.neighbour : a.use < b.use;
    });
    for (std::size_t k = 0, end = 0; k < joins_.size(); k = end) {
        while (end < joins_.size() && joins_[end].neighbour == joins_[k].neighbour) ++end;
        join(cell, uses, std::span(joins_).subspan(k, end - k));
    }
    // A sheet's root is its first use.
    std::uint32_t count = 0;
    for (std::uint32_t use = 0; use < uses.size(); ++use) {
        sheets_[use] = sheets_[use] == use ? count++ : sheets_[sheets_[use]];
    }
    return count;
}

void CellSheets::join(std::uint32_t cell, std::span<const std::uint32_t> uses,
                      std::span<Join> at_face) {
    const std::size_t count = at_face.size();
    std::size_t first = 0;
    if (count > 2) {
        for (Join& join : at_face) {
            join.around = along_border(cell, join.neighbour, edges_[uses[join.use]].at);
        }
        std::sort(at_face.begin(), at_face.end(),
                  [](const Join& a, const Join& b) { return a.around < b.around; });
        double flat[2] = {0, 0};
        for (std::size_t k = 0; k < count; ++k) {
            flat[k % 2] += flatness(edges_[uses[at_face[k].use]].met,
                                    edges_[uses[at_face[(k + 1) % count].use]].met);
        }
        first = flat[1] > flat[0] ? 1 : 0;
    }
    for (std::size_t k = first; k < first + count; k += 2) {
        unite(at_face[k % count].use, at_face[(k + 1) % count].use);
    }
}

std::uint64_t CellSheets::along_border(std::uint32_t cell, std::uint32_t neighbour,
                                       const CellTree::Edge& edge) const {
    const CellTree::Cell &a = tree_[cell], &b = tree_[neighbour];
    std::size_t axis = 0;
    while (a.at[axis] + a.size != b.at[axis] && b.at[axis] + b.size != a.at[axis]) ++axis;
    const CellTree::Cell& smaller = a.size < b.size ? a : b;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    // Twice the coordinates within the face.
    const std::uint64_t side = 2 * std::uint64_t{smaller.size};
    const auto middle = [&](std::size_t k) {
        return 2 * std::uint64_t{edge.from[k] - smaller.at[k]} + (edge.axis == k ? edge.length : 0);
    };
    const std::uint64_t x = middle(u), y = middle(v);
    if (edge.axis == u) return y == 0 ? x : 3 * side - x;
    return x == 0 ? 4 * side - y : side + y;
}

double CellSheets::flatness(const SurfaceCrossing& a, const SurfaceCrossing& b) {
    const Vec3 along = unit_or(b.point - a.point, {});
    return dot(a.normal, b.normal) - std::abs(dot(a.normal, along)) -
           std::abs(dot(b.normal, along));
}

std::uint32_t CellSheets::root(std::uint32_t use) const {
    while (sheets_[use] != use) use = sheets_[use];
    return use;
}

void CellSheets::unite(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    sheets_[std::max(a, b)] = std::min(a, b);
}

SurfaceVertex make_vertex(std::span<const SurfaceCrossing> crossings, bool alone, const Vec3& lo,
                          const Vec3& hi) {
    SurfaceVertex made;
    made.point = feature_point(crossings, alone, lo, hi);
    Vec3 sum;
    for (const SurfaceCrossing& c : crossings) sum = sum + c.normal;
    made.normal = unit_or(sum, crossings[0].normal);
    made.material = crossings[0].material;
    made.smooth = std::all_of(crossings.begin(), crossings.end(), [&](const SurfaceCrossing& c) {
        return dot(c.normal, made.normal) > kSmoothCosine;
    });
    return made;
}

}  // namespace alhazen
