#include "alhazen/formats/obj/obj_surfaces.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <tuple>

#include "alhazen/formats/patches/cubic_basis.h"
#include "alhazen/formats/patches/patch_welder.h"
#include "alhazen/shapes/patches/nurbs/trim_curve_part.h"

namespace alhazen {

namespace {

constexpr int kMaxSurfaceErrors = 50;
constexpr std::int64_t kMaxTrimDegree = 32;

/// The control net of a surface, u-major, and its break points or knots.
struct ObjNet {
    std::size_t rows = 0, columns = 0;  ///< points along u and v
    std::vector<HomogeneousPoint> points;
    std::vector<double> knots_u, knots_v;
    [[nodiscard]] HomogeneousPoint& at(std::size_t i, std::size_t j) {
        return points[i * columns + j];
    }
};

/// Knots that hold each inner break point `degree` times, the first and last once more.
std::vector<double> bezier_knots(const std::vector<double>& breaks, std::size_t degree) {
    std::vector<double> knots;
    for (std::size_t k = 0; k < breaks.size(); ++k) {
        const bool outer = k == 0 || k + 1 == breaks.size();
        knots.insert(knots.end(), degree + (outer ? 1 : 0), breaks[k]);
    }
    return knots;
}

class SurfaceMaker {
  public:
    SurfaceMaker(const ObjStatements& in, const std::string& file, Diagnostics& diagnostics)
        : in_(in), form_(in.free_form), file_(file), diagnostics_(diagnostics) {}

    std::vector<ObjSurface> make() {
        for (const ObjElement& surface : form_.surfaces) {
            if (errors_ >= kMaxSurfaceErrors) break;
            where_ = {file_, surface.line, surface.column};
            make_surface(surface);
        }
        for (Meshed& mesh : meshes_) surfaces_[mesh.surface].shape = mesh.welder.take();
        return std::move(surfaces_);
    }

  private:
    struct Meshed {
        PatchWelder welder;
        std::size_t surface;
    };
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::size_t, std::size_t>;

    void make_surface(const ObjElement& e) {
        for (const std::int64_t degree : {e.degree_u, e.degree_v}) {
            if (degree >= 1 && degree <= kMaxPatchDegree) continue;
            return error("degrees of surfaces are from 1 to " + std::to_string(kMaxPatchDegree) +
                         ", not " + std::to_string(degree));
        }
        if (e.basis == ObjBasis::Cardinal && (e.degree_u != 3 || e.degree_v != 3)) {
            return error("cardinal surfaces are of degree 3");
        }
        if (!(e.range[0] < e.range[1]) || !(e.range[2] < e.range[3])) {
            return error("the bounds of the parameters of a surface must rise");
        }
        auto du = std::size_t(e.degree_u), dv = std::size_t(e.degree_v);
        ObjNet net;
        if (!read_net(e, du, dv, net)) return;
        if (e.basis == ObjBasis::Cardinal) net = bezier_net_of(net);
        std::vector<TrimLoop> trims;
        if (!make_trims(e, trims)) return;
        const bool bezier = e.basis != ObjBasis::BSpline;
        const double u0 = bezier ? net.knots_u.front() : net.knots_u[du];
        const double u1 = bezier ? net.knots_u.back() : net.knots_u[net.rows];
        const double v0 = bezier ? net.knots_v.front() : net.knots_v[dv];
        const double v1 = bezier ? net.knots_v.back() : net.knots_v[net.columns];
        if (e.range[0] < u0 || e.range[1] > u1 || e.range[2] < v0 || e.range[3] > v1) {
            return error("the bounds of the parameters of a surface must be within its knots");
        }
        const bool whole = e.range == std::array{u0, u1, v0, v1};
        if (bezier && whole && trims.empty()) return add_patches(e, net);
        if (!has_outer(e) && (!whole || !trims.empty())) trims.insert(trims.begin(), outline(e));
        add_nurbs(e, net, std::move(trims));
    }

    // --- Control nets.

    [[nodiscard]] std::vector<double> knots_of(const ObjSlice& slice) const {
        return {form_.knots.begin() + slice.begin, form_.knots.begin() + slice.end};
    }

    /// The number of points that knots or break points require; 0 if there are too few.
    static std::size_t points_of(ObjBasis basis, std::size_t degree, std::size_t knots) {
        switch (basis) {
            case ObjBasis::BSpline:
                return knots > 2 * degree + 1 ? knots - degree - 1 : 0;
            case ObjBasis::Cardinal:
                return knots > 1 ? knots + 2 : 0;
            default:
                return knots > 1 ? (knots - 1) * degree + 1 : 0;
        }
    }

    bool read_net(const ObjElement& e, std::size_t du, std::size_t dv, ObjNet& net) {
        net.knots_u = knots_of(e.knots_u);
        net.knots_v = knots_of(e.knots_v);
        // A single Bezier patch needs no parm.
        if (net.knots_u.empty() && e.basis != ObjBasis::BSpline) {
            net.knots_u = {e.range[0], e.range[1]};
        }
        if (net.knots_v.empty() && e.basis != ObjBasis::BSpline) {
            net.knots_v = {e.range[2], e.range[3]};
        }
        net.rows = points_of(e.basis, du, net.knots_u.size());
        net.columns = points_of(e.basis, dv, net.knots_v.size());
        if (net.rows == 0 || net.columns == 0) {
            error("the surface has too few parameters (parm u and parm v) for its degrees");
            return false;
        }
        if (std::uint64_t{net.rows} * net.columns != e.points.size()) {
            error("the surface has " + std::to_string(e.points.size()) +
                  " points; its degrees and parameters require " + std::to_string(net.rows) +
                  " by " + std::to_string(net.columns));
            return false;
        }
        net.points.resize(e.points.size());
        for (std::size_t k = 0; k < net.points.size(); ++k) {
            const auto i = std::size_t(form_.points[e.points.begin + k]);
            // u varies fastest in the file.
            if (!read_point(e, i, net.at(k % net.rows, k / net.rows))) return false;
        }
        return true;
    }

    bool read_point(const ObjElement& e, std::size_t i, HomogeneousPoint& point) {
        if (i >= in_.positions.size()) {
            error("the surface names the point " + std::to_string(i + 1) + ", and there are " +
                  std::to_string(in_.positions.size()));
            return false;
        }
        const double w = e.rational && i < in_.weights.size() ? in_.weights[i] : 1.0;
        if (!(w > 0.0)) {
            error("the weight of the point " + std::to_string(i + 1) + " is not positive");
            return false;
        }
        const Vec3& p = in_.positions[i];
        // Keeps the weight apart: x, y, z and weight.
        point = {p.x, p.y, p.z, w};
        return true;
    }

    /// Converts segments of four points each to Bezier patches of degree 3.
    static ObjNet bezier_net_of(const ObjNet& cardinal) {
        const CubicBasis basis = *CubicBasis::named("cardinal");
        ObjNet out;
        out.rows = 3 * (cardinal.rows - 3) + 1;
        out.columns = 3 * (cardinal.columns - 3) + 1;
        out.knots_u = cardinal.knots_u;
        out.knots_v = cardinal.knots_v;
        out.points.resize(out.rows * out.columns);
        std::array<HomogeneousPoint, 16> p;
        for (std::size_t i = 0; i + 3 < cardinal.rows; ++i) {
            for (std::size_t j = 0; j + 3 < cardinal.columns; ++j) {
                for (std::size_t k = 0; k < 16; ++k) {
                    const HomogeneousPoint& q =
                        cardinal.points[(i + k / 4) * cardinal.columns + j + k % 4];
                    p[k] = homogeneous({q.x, q.y, q.z}, q.w);
                }
                const BezierNet net = bezier_of(basis, basis, p);
                for (std::size_t k = 0; k < 16; ++k) {
                    const Vec3 at = projected(net.points[k]);
                    out.at(3 * i + k / 4, 3 * j + k % 4) = {at.x, at.y, at.z, net.points[k].w};
                }
            }
        }
        return out;
    }

    // --- Shapes.

    void add_patches(const ObjElement& e, ObjNet& net) {
        const auto du = std::size_t(e.degree_u), dv = std::size_t(e.degree_v);
        const auto [entry, fresh] =
            mesh_numbers_.try_emplace(Key{e.name, e.material, du, dv}, meshes_.size());
        if (fresh) {
            meshes_.push_back(
                {PatchWelder(std::uint32_t(du), std::uint32_t(dv)), surfaces_.size()});
            surfaces_.push_back({e.name, e.material, {}, where_});
        }
        PatchWelder& welder = meshes_[entry->second].welder;
        std::vector<Vec3> points((du + 1) * (dv + 1));
        std::vector<double> weights(points.size());
        for (std::size_t i = 0; i + du < net.rows; i += du) {
            for (std::size_t j = 0; j + dv < net.columns; j += dv) {
                for (std::size_t k = 0; k < points.size(); ++k) {
                    const HomogeneousPoint& p = net.at(i + k / (dv + 1), j + k % (dv + 1));
                    points[k] = {p.x, p.y, p.z};
                    weights[k] = p.w;
                }
                welder.add(points, weights);
            }
        }
    }

    void add_nurbs(const ObjElement& e, const ObjNet& net, std::vector<TrimLoop> trims) {
        NurbsSurface s;
        s.degree_u = std::uint32_t(e.degree_u);
        s.degree_v = std::uint32_t(e.degree_v);
        const bool bezier = e.basis != ObjBasis::BSpline;
        s.knots_u = bezier ? bezier_knots(net.knots_u, s.degree_u) : net.knots_u;
        s.knots_v = bezier ? bezier_knots(net.knots_v, s.degree_v) : net.knots_v;
        bool rational = false;
        for (const HomogeneousPoint& p : net.points) {
            s.points.push_back({p.x, p.y, p.z});
            s.weights.push_back(p.w);
            rational = rational || p.w != 1.0;
        }
        if (!rational) s.weights.clear();
        s.trims = std::move(trims);
        surfaces_.push_back({e.name, e.material, AnyShape{std::move(s)}, where_});
    }

    // --- Trimming loops.

    [[nodiscard]] bool has_outer(const ObjElement& e) const {
        for (std::uint32_t t = e.trims.begin; t < e.trims.end; ++t) {
            if (!form_.trims[t].hole) return true;
        }
        return false;
    }
    static TrimLoop outline(const ObjElement& e) {
        const auto& [u0, u1, v0, v1] = e.range;
        return {TrimCurve{.points = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}, {u0, v0}}}};
    }

    bool make_trims(const ObjElement& e, std::vector<TrimLoop>& loops) {
        for (std::uint32_t t = e.trims.begin; t < e.trims.end; ++t) {
            const ObjTrim& trim = form_.trims[t];
            if (trim.first) loops.emplace_back();
            if (std::size_t(trim.curve) >= form_.curves.size()) {
                error("a loop names the curve " + std::to_string(trim.curve + 1) +
                      ", and there are " + std::to_string(form_.curves.size()));
                return false;
            }
            TrimCurve curve;
            if (!make_curve(form_.curves[std::size_t(trim.curve)], curve)) return false;
            const double lo = curve.knots[curve.degree], hi = curve.knots[curve.points.size()];
            if (std::fmin(trim.from, trim.to) < lo || std::fmax(trim.from, trim.to) > hi ||
                trim.from == trim.to) {
                error("a loop names a part of the curve " + std::to_string(trim.curve + 1) +
                      " beyond its parameters");
                return false;
            }
            loops.back().push_back(trim_curve_part(std::move(curve), trim.from, trim.to));
        }
        return true;
    }

    /// Makes a trimming curve with all its knots.
    bool make_curve(const ObjElement& e, TrimCurve& curve) {
        const std::string name = "the curve of line " + std::to_string(e.line) + " ";
        if (e.basis == ObjBasis::Skipped || e.basis == ObjBasis::Cardinal) {
            error(name + "is of a type that is not read");
            return false;
        }
        if (e.degree_u < 1 || e.degree_u > kMaxTrimDegree) {
            error(name + "has a degree that is not from 1 to " + std::to_string(kMaxTrimDegree));
            return false;
        }
        const auto degree = std::size_t(e.degree_u);
        curve.degree = std::uint32_t(degree);
        curve.knots = knots_of(e.knots_u);
        if (curve.knots.empty() && e.basis == ObjBasis::Bezier) curve.knots = {0, 1};
        if (points_of(e.basis, degree, curve.knots.size()) != e.points.size() ||
            e.points.size() == 0) {
            error(name + "has " + std::to_string(e.points.size()) +
                  " points, which do not fit its degree and parameters");
            return false;
        }
        if (e.basis == ObjBasis::Bezier) curve.knots = bezier_knots(curve.knots, degree);
        return read_curve_points(e, name, curve);
    }
    bool read_curve_points(const ObjElement& e, const std::string& name, TrimCurve& curve) {
        bool rational = false;
        for (std::uint32_t k = e.points.begin; k < e.points.end; ++k) {
            const auto i = std::size_t(form_.points[k]);
            if (i >= form_.parameters.size()) {
                error(name + "names the point (vp) " + std::to_string(i + 1) + ", and there are " +
                      std::to_string(form_.parameters.size()));
                return false;
            }
            const Vec3& p = form_.parameters[i];
            const double w = e.rational ? p.z : 1.0;
            if (!(w > 0.0)) {
                error(name + "has a weight that is not positive");
                return false;
            }
            rational = rational || w != 1.0;
            curve.points.push_back({p.x, p.y});
            curve.weights.push_back(w);
        }
        if (!rational) curve.weights.clear();
        return true;
    }

    void error(const std::string& message) {
        ++errors_;
        diagnostics_.error(where_, message);
    }

    const ObjStatements& in_;
    const ObjFreeForm& form_;
    const std::string& file_;
    Diagnostics& diagnostics_;
    FileLocation where_;
    std::deque<Meshed> meshes_;
    std::map<Key, std::size_t> mesh_numbers_;
    std::vector<ObjSurface> surfaces_;
    int errors_ = 0;
};

}  // namespace

std::vector<ObjSurface> make_obj_surfaces(const ObjStatements& statements, const std::string& file,
                                          Diagnostics& diagnostics) {
    return SurfaceMaker(statements, file, diagnostics).make();
}

}  // namespace alhazen
