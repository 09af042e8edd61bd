#include "alhazen/shapes/patches/patch_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/shapes/core/first_hits.h"
#include "alhazen/shapes/core/mixed_rounding.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/patch_apart.h"
#include "alhazen/shapes/patches/patch_index.h"

namespace alhazen {

namespace {

ShapeHit hit_of(const PatchPieces& pieces, std::uint32_t piece, const PatchRoot& root) {
    const double u = std::clamp(root.u, 0.0, 1.0), v = std::clamp(root.v, 0.0, 1.0);
    const Vec2 &lo = pieces.lo(piece), &hi = pieces.hi(piece);
    return {root.t, lo.x + u * (hi.x - lo.x), lo.y + v * (hi.y - lo.y), pieces.part(piece)};
}

/// Bound of the rounding errors of a point of `derivatives_at`. Each level of de Casteljau's
/// algorithm is a convex combination with three roundings, for the numerator and the weight; the
/// weighted mean of the points' magnitudes is at most the largest one.
Vec3 evaluation_error(BezierView net) {
    Vec3 most;
    for (int k = 0; k < net.count(); ++k) {
        const Vec3 size = abs(projected(net.points[k]));
        most = {std::max(most.x, size.x), std::max(most.y, size.y), std::max(most.z, size.z)};
    }
    return (2.0 * gamma_bound(3 * (net.degree_u + net.degree_v) + 1)) * most;
}

/// Bound of the distance by which a crossing at a border may lie outside its patch: see
/// docs/design/patches.md.
double border_reach(const PatchPieces& pieces, const Box3& box) {
    double reach = 0.0, least = kInfinity, most = 0.0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const BezierView net = pieces.net(i);
        for (int k = 0; k < net.count(); ++k) {
            const HomogeneousPoint& p = net.points[k];
            reach = std::max(reach, length(Vec3{p.x, p.y, p.z}));
            least = std::min(least, p.w);
            most = std::max(most, p.w);
        }
    }
    if (box.empty()) return 0.0;
    return 0x1p-42 / least * (reach + most * (length(box.center()) + 2.0 * length(box.size())));
}

/// The order of crossings, also of those with equal t.
bool is_before(const ShapeHit& a, const ShapeHit& b) {
    if (a.t != b.t) return a.t < b.t;
    if (a.part != b.part) return a.part < b.part;
    return a.u != b.u ? a.u < b.u : a.v < b.v;
}

/// Keeps a crossing in the ray's range if it is the first so far; false if it is out of range.
bool keep_first(const Ray& ray, const ShapeHit& crossing, bool found, ShapeHit& hit) {
    if (!ray.covers(crossing.t) || !std::isfinite(crossing.t)) return false;
    if (found && !is_before(crossing, hit)) return true;
    // Copied by field, to avoid a store-forwarding stall.
    hit.t = crossing.t;
    hit.u = crossing.u;
    hit.v = crossing.v;
    hit.part = crossing.part;
    return true;
}

}  // namespace

PatchTree::PatchTree(PatchPieces pieces) : pieces_(std::move(pieces)) {
    pieces_.shrink_to_fit();
    for (std::size_t k = 0; k < pieces_.size(); ++k) box_.include(control_box(pieces_.net(k)));
    reach_ = border_reach(pieces_, box_);
    if (!box_.empty())
        box_ = {box_.lo - Vec3{reach_, reach_, reach_}, box_.hi + Vec3{reach_, reach_, reach_}};
    index_ = std::make_shared<PatchIndex>(pieces_, box_);
}

Interval PatchTree::extent(const Vec3& axis) const {
    Interval range{kInfinity, -kInfinity};
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const BezierView net = pieces_.net(i);
        for (int k = 0; k < net.count(); ++k) {
            const double x = dot(axis, projected(net.points[k]));
            range = {std::min(range.lo, x), std::max(range.hi, x)};
        }
    }
    const Vec3 size = abs(axis);
    const double reach = reach_ * (size.x + size.y + size.z);
    return {range.lo - reach, range.hi + reach};
}

void PatchTree::intersect(const Ray& ray, ShapeHits& hits) const {
    const std::size_t first = hits.size();
    index_->search(pieces_, index_->line_of(ray), ray.t_min, ray.t_max,
                   [&](std::uint32_t piece, const PatchRoot& root) {
                       hits.grow(report_crossing(ray, hit_of(pieces_, piece, root), hits.room(1)));
                       return ray.t_max;
                   });
    std::sort(hits.begin() + first, hits.end(), is_before);
}

bool PatchTree::first_hit(const Ray& ray, ShapeHit& hit) const {
    bool found = false;
    index_->search(pieces_, index_->line_of(ray), ray.t_min, ray.t_max,
                   [&](std::uint32_t piece, const PatchRoot& root) {
                       found |= keep_first(ray, hit_of(pieces_, piece, root), found, hit);
                       return found ? hit.t : ray.t_max;
                   });
    return found;
}

std::uint32_t PatchTree::first_hits(std::span<const Ray* const> rays, ShapeHit* hits) const {
    std::uint32_t met = 0;
    const auto offer = [&](std::size_t i, std::uint32_t piece, const PatchRoot& root) {
        const std::uint32_t bit = 1u << i;
        const ShapeHit next = hit_of(pieces_, piece, root);
        if (keep_first(*rays[i], next, (met & bit) != 0, hits[i])) met |= bit;
        return (met & bit) != 0 ? hits[i].t : rays[i]->t_max;
    };
    std::array<const Ray*, kMostPatchRays> apart;
    std::array<std::size_t, kMostPatchRays> numbers;
    std::size_t count = 0;
    for (std::size_t first = 0; first < rays.size(); first += kRayLanes) {
        const auto group = rays.subspan(first, std::min(kRayLanes, rays.size() - first));
        const auto offer_of_group = [&](std::size_t i, std::uint32_t piece, const PatchRoot& root) {
            return offer(first + i, piece, root);
        };
        if (index_->search_together(pieces_, group, offer_of_group)) continue;
        for (std::size_t i = 0; i < group.size(); ++i) {
            apart[count] = group[i];
            numbers[count++] = first + i;
        }
    }
    if (count >= kPatchPairs) {
        const auto offer_apart = [&](std::size_t i, std::uint32_t piece, const PatchRoot& root) {
            return offer(numbers[i], piece, root);
        };
        PatchLinesApart(*index_, pieces_, std::span(apart).first(count), offer_apart).search();
        return met;
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (first_hit(*apart[i], hits[numbers[i]])) met |= 1u << numbers[i];
    }
    return met;
}

ShapeSurface PatchTree::surface(const Ray&, const ShapeHit& hit) const {
    const std::size_t piece = pieces_.find(hit.part);
    const BezierView net = pieces_.net(piece);
    const Vec2 &lo = pieces_.lo(piece), &hi = pieces_.hi(piece);
    const auto within = [](double x, double from, double to) {
        return std::clamp((x - from) / (to - from), 0.0, 1.0);
    };
    const double u = within(hit.u, lo.x, hi.x);
    const double v = within(hit.v, lo.y, hi.y);
    const PatchPoint p = derivatives_at(net, u, v);
    ShapeSurface surface;
    surface.point = p.point;
    surface.normal = surface.shading_normal = patch_normal(net, u, v);
    surface.uv = {hit.u, hit.v};
    surface.dpdu = p.du / (hi.x - lo.x);
    surface.dpdv = p.dv / (hi.y - lo.y);
    surface.error =
        evaluation_error(net) +
        patch_test_rounding(std::max(max_component(abs(box_.lo)), max_component(abs(box_.hi))));
    return surface;
}

std::size_t PatchTree::bytes() const {
    return sizeof *this + pieces_.bytes() + index_->bytes();
}

}  // namespace alhazen
