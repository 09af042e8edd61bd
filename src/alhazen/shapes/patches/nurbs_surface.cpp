#include "alhazen/shapes/patches/nurbs_surface.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/patch_checks.h"

namespace alhazen {

class TrimRegion {};

namespace {

using HomogeneousRow = std::vector<HomogeneousPoint>;

/// Inserts the knot u once into a B-spline curve. Piegl and Tiller, equation 5.15.
/// Preconditions: u is in the domain, its multiplicity is less than the degree.
void insert_knot(std::vector<double>& knots, HomogeneousRow& row, int degree, double u) {
    const auto after = std::upper_bound(knots.begin(), knots.end(), u);
    const auto span = static_cast<int>(after - knots.begin()) - 1;
    const auto before = std::lower_bound(knots.begin(), knots.end(), u);
    const auto multiplicity = static_cast<int>(after - before);
    const HomogeneousRow old = row;
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    row.insert(row.begin() + (span - multiplicity), old[at(span - multiplicity)]);
    for (int i = span - degree + 1; i <= span - multiplicity; ++i) {
        const double share = (u - knots[at(i)]) / (knots[at(i + degree)] - knots[at(i)]);
        row[at(i)] = share * old[at(i)] + (1.0 - share) * old[at(i - 1)];
    }
    knots.insert(knots.begin() + span + 1, u);
}

/// Inserts every knot of the domain until its multiplicity is at least the degree.
void insert_all_knots(std::vector<double>& knots, HomogeneousRow& row, int degree) {
    const auto p = static_cast<std::size_t>(degree);
    std::vector<double> inner(knots.begin() + degree, knots.end() - degree);
    inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
    for (const double u : inner) {
        const auto range = std::equal_range(knots.begin(), knots.end(), u);
        for (auto n = static_cast<std::size_t>(range.second - range.first); n < p; ++n) {
            insert_knot(knots, row, degree, u);
        }
    }
}

/// A span of the domain and the first of its control points.
struct KnotSpan {
    double lo, hi;
    std::size_t first;
};
std::vector<KnotSpan> knot_spans(const std::vector<double>& knots, int degree, double lo,
                                 double hi) {
    const auto p = static_cast<std::size_t>(degree);
    std::vector<KnotSpan> spans;
    for (std::size_t k = p; k + p + 1 < knots.size(); ++k) {
        if (knots[k] >= lo && knots[k] < knots[k + 1] && knots[k + 1] <= hi) {
            spans.push_back({knots[k], knots[k + 1], k - p});
        }
    }
    return spans;
}

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

void check_knots(FieldChecks& checks, const std::string& name, const std::vector<double>& knots,
                 std::uint32_t degree) {
    if (knots.size() < 2 * (std::size_t{degree} + 1)) {
        checks.fail(name + ": degree " + std::to_string(degree) + " needs at least " +
                    std::to_string(2 * (std::size_t{degree} + 1)) + " knots, found " +
                    std::to_string(knots.size()));
        return;
    }
    for (std::size_t k = 0; k < knots.size(); ++k) {
        if (!(std::abs(knots[k]) <= kMaxCoordinate)) {
            checks.fail(name + ": knot " + std::to_string(k) + " must be a finite number");
        } else if (k > 0 && knots[k] < knots[k - 1]) {
            checks.fail(name + ": knot " + std::to_string(k) + " is less than the one before it");
        }
    }
    if (!(knots[degree] < knots[knots.size() - degree - 1])) {
        checks.fail(name + ": the domain is empty");
        return;
    }
    for (std::size_t k = 1; k + degree + 1 < knots.size(); ++k) {
        if (knots[k] == knots[k + degree] && knots[k] > knots[degree] &&
            knots[k] < knots[knots.size() - degree - 1]) {
            checks.fail(name + ": knot " + std::to_string(k) +
                        " repeats more often than the degree, " + std::to_string(degree));
        }
    }
}

}  // namespace

void NurbsSurface::prepare() {
    tree = std::make_shared<PatchTree>(bezier_pieces_of(*this));
}

void NurbsSurface::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    check_patch_degrees(checks, degree_u, degree_v);
    check_control_points(checks, points, weights);
    if (degree_u >= 1 && degree_u <= 7) check_knots(checks, "knots_u", knots_u, degree_u);
    if (degree_v >= 1 && degree_v <= 7) check_knots(checks, "knots_v", knots_v, degree_v);
    // Keeping all of a surface that has holes would be wrong without a word.
    if (!trims.empty()) checks.fail("trimming loops are not supported yet");
    if (!checks.ok()) return;
    const std::size_t nu = knots_u.size() - degree_u - 1, nv = knots_v.size() - degree_v - 1;
    if (points.size() != nu * nv) {
        checks.fail("these knots and degrees need " + std::to_string(nu) + " x " +
                    std::to_string(nv) + " points, found " + std::to_string(points.size()));
    }
}

void NurbsSurface::intersect(const Ray& ray, ShapeHits& hits) const {
    tree->intersect(ray, hits);
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
