#include "alhazen/verification/exact_patches.h"

#include <algorithm>
#include <cmath>

#include "alhazen/verification/exact_patch_cells.h"

namespace alhazen {
namespace {

constexpr double kOnSide = 0x1p-85;
// The properties of a cell hold for the cell extended by this part of its width on each side:
// beyond its cell, a polynomial of degree 7 by 7 is at most (1 + 2 * kMargin)^14 times its largest
// control point.
constexpr double kMargin = 0x1p-10;

/// Value and derivatives of Bernstein polynomials.
template <class R>
void bernstein_basis(int degree, R t, R* value, R* slope) {
    R lower[kMaxPatchOrder] = {1};
    for (int d = 1; d < degree; ++d) {
        for (int k = d; k >= 0; --k) {
            lower[k] = (k < d ? (1 - t) * lower[k] : R(0)) + (k > 0 ? t * lower[k - 1] : R(0));
        }
    }
    for (int k = 0; k <= degree; ++k) {
        const R here = k < degree ? lower[k] : R(0);
        const R before = k > 0 ? lower[k - 1] : R(0);
        value[k] = (1 - t) * here + t * before;
        slope[k] = degree * (before - here);
    }
}

/// A step of Newton's method.
template <class R>
bool newton_step(const LineNet<R>& net, R u, R v, R& du, R& dv) {
    R bu[kMaxPatchOrder], su[kMaxPatchOrder], bv[kMaxPatchOrder], sv[kMaxPatchOrder];
    bernstein_basis(net.n, u, bu, su);
    bernstein_basis(net.m, v, bv, sv);
    R f_x = 0, f_y = 0, x_u = 0, y_u = 0, x_v = 0, y_v = 0;
    for (int i = 0; i <= net.n; ++i) {
        R x = 0, y = 0, row_x_v = 0, row_y_v = 0;
        for (int j = 0; j <= net.m; ++j) {
            const std::size_t k = net.index(i, j);
            x += bv[j] * net.x[k];
            y += bv[j] * net.y[k];
            row_x_v += sv[j] * net.x[k];
            row_y_v += sv[j] * net.y[k];
        }
        f_x += bu[i] * x, f_y += bu[i] * y;
        x_u += su[i] * x, y_u += su[i] * y;
        x_v += bu[i] * row_x_v, y_v += bu[i] * row_y_v;
    }
    const R det = x_u * y_v - x_v * y_u;
    if (det == 0) return false;
    du = (x_v * f_y - f_x * y_v) / det;
    dv = (f_x * y_u - x_u * f_y) / det;
    return true;
}

class PatchSearch {
  public:
    PatchSearch(const BezierNet& net, std::uint32_t patch, const ExactFrame& frame,
                ExactPatchRoots& out)
        : net_(net), patch_(patch), frame_(frame), out_(out) {
        for (int k = 0; k < net.count(); ++k) {
            const HomogeneousPoint& p = net.points[static_cast<std::size_t>(k)];
            const Vec3 size = abs(Vec3{p.x, p.y, p.z});
            reach_ = std::max(reach_, size.x + size.y + size.z +
                                          p.w * std::abs(static_cast<double>(frame.origin.x)) +
                                          p.w * std::abs(static_cast<double>(frame.origin.y)) +
                                          p.w * std::abs(static_cast<double>(frame.origin.z)));
        }
        first_ = out.roots.size();
    }

    void run() {
        rounded_ = rounded_net(net_, frame_);
        search(rounded_, DyadicCell{}, 0x1p-47 * reach_);
    }

  private:
    template <class R>
    void search(const LineNet<R>& net, const DyadicCell& cell, double noise) {
        using Answer = CellProof::Answer;
        const CellProof proof = prove(net, noise);
        if (proof.answer == Answer::None) return;
        if (proof.answer == Answer::OneToOne && root_in(cell)) return;
        constexpr bool kIsExact = !std::is_same_v<R, double>;
        const int deepest = std::max(cell.level_u, cell.level_v);
        if constexpr (kIsExact) {
            if (proof.answer == Answer::Unknown || deepest > 100 || ++cells_ > 20000) {
                ++out_.undecided;
                return;
            }
        } else if (proof.answer == Answer::Unknown || deepest > 24) {
            return search(exact_part(cell), cell, 0x1p-102 * reach_);
        }
        LineNet<R> low, high;
        halve(net, proof.along_u, low, high);
        search(low, cell.half(proof.along_u, false), noise);
        search(high, cell.half(proof.along_u, true), noise);
    }

    const LineNet<Real128>& exact_whole() {
        if (exact_.n == 0) exact_ = exact_net(net_, frame_);
        return exact_;
    }

    LineNet<Real128> exact_part(const DyadicCell& cell) {
        LineNet<Real128> net = exact_whole(), low, high;
        const auto descend = [&](bool along_u, Real128 at, int levels) {
            for (int k = 0; k < levels; ++k) {
                halve(net, along_u, low, high);
                at *= 2;
                net = at >= 1 ? high : low;
                if (at >= 1) at -= 1;
            }
        };
        descend(true, cell.u, cell.level_u);
        descend(false, cell.v, cell.level_v);
        return net;
    }

    /// Newton's method in 113 bits in a cell with at most one root; false if it does not converge
    /// to a point of the extended cell.
    bool root_in(const DyadicCell& cell) {
        const Real128 width_u = cell.width_u(), width_v = cell.width_v();
        const double unit_u = static_cast<double>(width_u), unit_v = static_cast<double>(width_v);
        Real128 u = cell.u + width_u / 2, v = cell.v + width_v / 2;
        const auto size_of = [&](Real128 du, Real128 dv) {
            return std::max(std::abs(static_cast<double>(du)) / unit_u,
                            std::abs(static_cast<double>(dv)) / unit_v);
        };
        if (std::max(cell.level_u, cell.level_v) <= 24) {
            // A better start by double precision; no root is expected far from the cell.
            double a = static_cast<double>(u), b = static_cast<double>(v), da = 0, db = 0;
            for (int step = 0; step < 8; ++step) {
                if (!newton_step(rounded_, a, b, da, db)) return false;
                a += da;
                b += db;
                if (!(size_of(Real128(a) - u, Real128(b) - v) < 0.6)) return false;
                if (size_of(da, db) < 1e-7) break;
            }
            u = a;
            v = b;
        }
        for (int step = 0; step < 40; ++step) {
            Real128 du = 0, dv = 0;
            if (!newton_step(exact_whole(), u, v, du, dv)) return false;
            u += du;
            v += dv;
            const double moved = size_of(du, dv);
            if (!(moved < 4.0)) return false;
            // The next step would be the square of this one.
            if (moved < 0x1p-50) return accept(cell, u, v);
        }
        return false;
    }

    bool accept(const DyadicCell& cell, Real128 u, Real128 v) {
        const auto within = [&](Real128 margin_u, Real128 margin_v) {
            return u >= cell.u - margin_u && u <= cell.u + cell.width_u() + margin_u &&
                   v >= cell.v - margin_v && v <= cell.v + cell.width_v() + margin_v;
        };
        if (!within(kOnSide, kOnSide)) {
            // The only root of the extended cell is outside the cell, which has none.
            return within(kMargin * cell.width_u(), kMargin * cell.width_v());
        }
        const auto same = [](Real128 a, Real128 b) {
            return a - b < 8 * kOnSide && b - a < 8 * kOnSide;
        };
        for (std::size_t k = first_; k < out_.roots.size(); ++k) {
            if (same(out_.roots[k].u, u) && same(out_.roots[k].v, v)) return true;
        }
        out_.roots.push_back(described(u, v));
        return true;
    }

    ExactPatchRoot described(Real128 u, Real128 v) {
        ExactPatchRoot root;
        root.u = u;
        root.v = v;
        root.patch = patch_;
        Real128 bu[kMaxPatchOrder], bv[kMaxPatchOrder], slope[kMaxPatchOrder];
        bernstein_basis(net_.degree_u, u, bu, slope);
        bernstein_basis(net_.degree_v, v, bv, slope);
        Real128 along = 0, weight = 0;
        for (int i = 0; i <= net_.degree_u; ++i) {
            for (int j = 0; j <= net_.degree_v; ++j) {
                const HomogeneousPoint& p = net_.at(i, j);
                along += bu[i] * bv[j] * dot(frame_.direction, frame_.offset(p));
                weight += bu[i] * bv[j] * Real128(p.w);
            }
        }
        root.t = along / (weight * dot(frame_.direction, frame_.direction));
        add_slope(root);
        return root;
    }

    void add_slope(ExactPatchRoot& root) const {
        const Vec3 direction = normalize(Vec3{static_cast<double>(frame_.direction.x),
                                              static_cast<double>(frame_.direction.y),
                                              static_cast<double>(frame_.direction.z)});
        const PatchPoint at =
            derivatives_at(net_, std::clamp(static_cast<double>(root.u), 0.0, 1.0),
                           std::clamp(static_cast<double>(root.v), 0.0, 1.0));
        const Vec3 normal = cross(at.du, at.dv);
        const double facing = std::abs(dot(normal, direction));
        root.slope = length(cross(normal, direction)) / std::max(facing, 1e-300);
        const auto on = [](Real128 x) { return x < kOnSide || 1 - x < kOnSide; };
        root.on_side = on(root.u) || on(root.v);
    }

    const BezierNet& net_;
    std::uint32_t patch_;
    const ExactFrame& frame_;
    ExactPatchRoots& out_;
    LineNet<double> rounded_;
    LineNet<Real128> exact_;
    double reach_ = 0;
    std::size_t first_ = 0;
    int cells_ = 0;
};

}  // namespace

ExactPatchRoots exact_patch_roots(std::span<const BezierNet> nets, const Ray& ray) {
    const ExactFrame frame(ray);
    ExactPatchRoots out;
    for (std::size_t k = 0; k < nets.size(); ++k) {
        PatchSearch(nets[k], static_cast<std::uint32_t>(k), frame, out).run();
    }
    std::sort(out.roots.begin(), out.roots.end(),
              [](const ExactPatchRoot& a, const ExactPatchRoot& b) { return a.t < b.t; });
    return out;
}

}  // namespace alhazen
