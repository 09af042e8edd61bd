#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/nurbs/bspline_pieces.h"
#include "alhazen/shapes/patches/nurbs/trim_region.h"
#include "alhazen/shapes/patches/patch_checks.h"

namespace alhazen {

namespace {

std::vector<BezierPiece> bezier_pieces_of(const NurbsSurface& s) {
    const auto pu = static_cast<int>(s.degree_u), pv = static_cast<int>(s.degree_v);
    const std::size_t nu = s.knots_u.size() - s.degree_u - 1;
    const std::size_t nv = s.knots_v.size() - s.degree_v - 1;
    std::vector<double> knots_u = s.knots_u, knots_v = s.knots_v;
    std::vector<HomogeneousRow> rows(nu);  // [i][j], all knots of v inserted
    for (std::size_t i = 0; i < nu; ++i) {
        for (std::size_t j = 0; j < nv; ++j) {
            const std::size_t k = i * nv + j;
            rows[i].push_back(homogeneous(s.points[k], s.weights.empty() ? 1.0 : s.weights[k]));
        }
        knots_v = s.knots_v;
        insert_all_knots(knots_v, rows[i], pv);
    }
    std::vector<HomogeneousRow> columns(rows[0].size());  // [j][i], all knots inserted
    for (std::size_t j = 0; j < columns.size(); ++j) {
        for (std::size_t i = 0; i < nu; ++i) columns[j].push_back(rows[i][j]);
        knots_u = s.knots_u;
        insert_all_knots(knots_u, columns[j], pu);
    }
    std::vector<BezierPiece> pieces;
    for (const KnotSpan& u : knot_spans(knots_u, pu, s.knots_u[s.degree_u], s.knots_u[nu])) {
        for (const KnotSpan& v : knot_spans(knots_v, pv, s.knots_v[s.degree_v], s.knots_v[nv])) {
            BezierPiece piece;
            piece.net.degree_u = pu;
            piece.net.degree_v = pv;
            for (int i = 0; i <= pu; ++i) {
                for (int j = 0; j <= pv; ++j) {
                    piece.net.at(i, j) = columns[v.first + static_cast<std::size_t>(j)]
                                                [u.first + static_cast<std::size_t>(i)];
                }
            }
            piece.part = static_cast<std::uint32_t>(pieces.size());
            piece.lo = {u.lo, v.lo};
            piece.hi = {u.hi, v.hi};
            pieces.push_back(piece);
        }
    }
    return pieces;
}

}  // namespace

void NurbsSurface::prepare() {
    std::vector<BezierPiece> pieces = bezier_pieces_of(*this);
    region = nullptr;
    if (!trims.empty()) {
        region = std::make_shared<TrimRegion>(trims);
        const BezierPiece first = pieces[0];
        std::erase_if(pieces, [&](const BezierPiece& piece) {
            return region->cover(piece.lo, piece.hi) == TrimRegion::Cover::None;
        });
        if (pieces.empty()) pieces.push_back(first);  // a surface needs a box
    }
    tree = std::make_shared<PatchTree>(std::move(pieces));
}

void NurbsSurface::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    check_patch_degrees(checks, degree_u, degree_v);
    check_control_points(checks, points, weights);
    if (degree_u >= 1 && degree_u <= 7) check_knots(checks, "knots_u", knots_u, degree_u);
    if (degree_v >= 1 && degree_v <= 7) check_knots(checks, "knots_v", knots_v, degree_v);
    if (!checks.ok()) return;
    const Vec2 size{knots_u[knots_u.size() - degree_u - 1] - knots_u[degree_u],
                    knots_v[knots_v.size() - degree_v - 1] - knots_v[degree_v]};
    check_trim_loops(checks, trims, size);
    const std::size_t nu = knots_u.size() - degree_u - 1, nv = knots_v.size() - degree_v - 1;
    if (points.size() != nu * nv) {
        checks.fail("these knots and degrees need " + std::to_string(nu) + " x " +
                    std::to_string(nv) + " points, found " + std::to_string(points.size()));
    }
}

bool NurbsSurface::keeps(const ShapeHit& hit) const {
    if (region == nullptr) return true;
    // A loop along the border of the domain keeps the border.
    const auto within = [](double x, const std::vector<double>& knots, std::uint32_t degree) {
        const double lo = knots[degree], hi = knots[knots.size() - degree - 1];
        const double margin = 0x1p-40 * (hi - lo);
        return std::clamp(x, lo + margin, hi - margin);
    };
    return region->contains({within(hit.u, knots_u, degree_u), within(hit.v, knots_v, degree_v)});
}

bool NurbsSurface::keeps_uv(const Vec2& uv) const {
    const auto parameter = [](double x, const std::vector<double>& knots, std::uint32_t degree) {
        const double lo = knots[degree], hi = knots[knots.size() - degree - 1];
        return lo + x * (hi - lo);
    };
    ShapeHit hit;
    hit.u = parameter(uv.x, knots_u, degree_u);
    hit.v = parameter(uv.y, knots_v, degree_v);
    return keeps(hit);
}

void NurbsSurface::intersect(const Ray& ray, ShapeHits& hits) const {
    const std::size_t first = hits.size();
    tree->intersect(ray, hits);
    if (region == nullptr) return;
    std::size_t kept = first;
    for (std::size_t k = first; k < hits.size(); ++k) {
        if (keeps(hits[k])) hits[kept++] = hits[k];
    }
    hits.shrink(kept);
}

bool first_hit(const NurbsSurface& shape, const Ray& ray, ShapeHit& hit) {
    if (!shape.tree->first_hit(ray, hit)) return false;
    if (shape.keeps(hit)) return true;
    ShapeHits hits;
    shape.intersect(ray, hits);
    if (hits.empty()) return false;
    hit = hits.front();
    return true;
}

ShapeSurface NurbsSurface::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = tree->surface(ray, hit);
    const Vec2 lo{knots_u[degree_u], knots_v[degree_v]};
    const Vec2 size{knots_u[knots_u.size() - degree_u - 1] - lo.x,
                    knots_v[knots_v.size() - degree_v - 1] - lo.y};
    surface.uv = {(hit.u - lo.x) / size.x, (hit.v - lo.y) / size.y};
    surface.dpdu = size.x * surface.dpdu;
    surface.dpdv = size.y * surface.dpdv;
    return surface;
}

}  // namespace alhazen
