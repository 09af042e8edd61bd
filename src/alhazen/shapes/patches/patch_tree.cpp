#include "alhazen/shapes/patches/patch_tree.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/patch_index.h"

namespace alhazen {

namespace {

ShapeHit hit_of(const BezierPiece& piece, const PatchRoot& root) {
    const double u = std::clamp(root.u, 0.0, 1.0), v = std::clamp(root.v, 0.0, 1.0);
    return {root.t, piece.lo.x + u * (piece.hi.x - piece.lo.x),
            piece.lo.y + v * (piece.hi.y - piece.lo.y), piece.part};
}

/// Bound of the rounding errors of `derivatives_at`: each of the steps of de Casteljau's algorithm
/// is a convex combination with three roundings, the weights take part, and one division.
Vec3 evaluation_error(const BezierNet& net) {
    Vec3 most;
    double least_weight = kInfinity, most_weight = 0.0;
    for (int k = 0; k < net.count(); ++k) {
        const HomogeneousPoint& p = net.points[static_cast<std::size_t>(k)];
        const Vec3 size = abs(Vec3{p.x, p.y, p.z});
        most = {std::max(most.x, size.x), std::max(most.y, size.y), std::max(most.z, size.z)};
        least_weight = std::min(least_weight, p.w);
        most_weight = std::max(most_weight, p.w);
    }
    const double steps = gamma_bound(4 * (net.degree_u + net.degree_v) + 2);
    return (steps * (1.0 + most_weight / least_weight) / least_weight) * most;
}

/// The order of crossings, also of those with equal t.
bool is_before(const ShapeHit& a, const ShapeHit& b) {
    if (a.t != b.t) return a.t < b.t;
    if (a.part != b.part) return a.part < b.part;
    return a.u != b.u ? a.u < b.u : a.v < b.v;
}

}  // namespace

PatchTree::PatchTree(std::vector<BezierPiece> pieces) : pieces_(std::move(pieces)) {
    for (const BezierPiece& piece : pieces_) box_.include(control_box(piece.net));
    box_ = padded(box_, 1e-13);
    index_ = std::make_shared<PatchIndex>(pieces_, box_);
}

Interval PatchTree::extent(const Vec3& axis) const {
    Interval range{kInfinity, -kInfinity};
    for (const BezierPiece& piece : pieces_) {
        for (int k = 0; k < piece.net.count(); ++k) {
            const double x = dot(axis, projected(piece.net.points[static_cast<std::size_t>(k)]));
            range = {std::min(range.lo, x), std::max(range.hi, x)};
        }
    }
    const double reach =
        1e-13 * dot(abs(axis), Vec3{std::max(std::abs(box_.lo.x), std::abs(box_.hi.x)),
                                    std::max(std::abs(box_.lo.y), std::abs(box_.hi.y)),
                                    std::max(std::abs(box_.lo.z), std::abs(box_.hi.z))});
    return {range.lo - reach, range.hi + reach};
}

void PatchTree::intersect(const Ray& ray, ShapeHits& hits) const {
    const std::size_t first = hits.size();
    index_->search(pieces_, index_->line_of(ray), ray.t_min, ray.t_max,
                   [&](std::uint32_t piece, const PatchRoot& root) {
                       hits.grow(report_crossing(ray, hit_of(pieces_[piece], root), hits.room(1)));
                       return ray.t_max;
                   });
    std::sort(hits.begin() + first, hits.end(), is_before);
}

bool PatchTree::first_hit(const Ray& ray, ShapeHit& hit) const {
    bool found = false;
    index_->search(pieces_, index_->line_of(ray), ray.t_min, ray.t_max,
                   [&](std::uint32_t piece, const PatchRoot& root) {
                       ShapeHit next;
                       if (report_crossing(ray, hit_of(pieces_[piece], root), &next) != 0 &&
                           (!found || is_before(next, hit))) {
                           hit = next;
                           found = true;
                       }
                       return found ? hit.t : ray.t_max;
                   });
    return found;
}

const BezierPiece& PatchTree::piece_of(std::uint32_t part) const {
    if (part < pieces_.size() && pieces_[part].part == part) return pieces_[part];
    return *std::partition_point(pieces_.begin(), pieces_.end(),
                                 [&](const BezierPiece& p) { return p.part < part; });
}

ShapeSurface PatchTree::surface(const Ray&, const ShapeHit& hit) const {
    const BezierPiece& piece = piece_of(hit.part);
    const auto within = [](double x, double lo, double hi) {
        return std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
    };
    const double u = within(hit.u, piece.lo.x, piece.hi.x);
    const double v = within(hit.v, piece.lo.y, piece.hi.y);
    const PatchPoint p = derivatives_at(piece.net, u, v);
    ShapeSurface surface;
    surface.point = p.point;
    surface.normal = surface.shading_normal = patch_normal(piece.net, u, v);
    surface.uv = {hit.u, hit.v};
    surface.dpdu = p.du / (piece.hi.x - piece.lo.x);
    surface.dpdv = p.dv / (piece.hi.y - piece.lo.y);
    surface.error = evaluation_error(piece.net);
    return surface;
}

std::size_t PatchTree::bytes() const {
    return sizeof *this + pieces_.capacity() * sizeof(BezierPiece) + index_->bytes();
}

}  // namespace alhazen
