#include "alhazen/session/technical/solid_curve_parts.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// Largest distance of chords from their curves, relative to the size of the leaf.
constexpr double kChord = 1e-4;

}  // namespace

void SolidCurveParts::add_within(SolidCurve line, const Box3& box) {
    double lo = -1e300, hi = 1e300;
    const double more = 1e-6 * length(box.size());
    for (int k = 0; k < 3; ++k) {
        const double d = line.form.u[k], o = line.form.origin[k];
        if (std::abs(d) < 1e-12) {
            if (o < box.lo[k] - more || o > box.hi[k] + more) return;
            continue;
        }
        const double t0 = (box.lo[k] - more - o) / d, t1 = (box.hi[k] + more - o) / d;
        lo = std::max(lo, std::min(t0, t1));
        hi = std::min(hi, std::max(t0, t1));
    }
    if (!(lo < hi) || lo < -1e299 || hi > 1e299) return;
    line.form.origin = line.form.origin + lo * line.form.u;
    line.form.u = (hi - lo) * line.form.u;
    add(line);
}

SolidCurveParts::Here SolidCurveParts::here(const SolidCurve& curve, double t) const {
    const double step = 1e-5 * (curve.to - curve.from);
    const std::optional<Vec3> p = curve.at(t), a = curve.at(t - step), b = curve.at(t + step);
    if (!p || (!a && !b)) return {};
    const SolidWheel wheel = solid_.wheel(*p, (b ? *b : *p) - (a ? *a : *p), *curve.face);
    if (!(curve.outline ? wheel.surface : wheel.edge)) return {};
    const auto faces = [&](const Vec3& n) { return dot(n, eye_.at - eye_.weight * *p) > 0.0; };
    const bool ends = curve.outline || faces(wheel.out) != faces(wheel.other_out);
    return {ends ? 2 : 1, wheel.out, wheel.other_out};
}

void SolidCurveParts::add(const SolidCurve& given) {
    SolidCurve curve = given;
    const double step = (curve.to - curve.from) / kSamples;
    std::vector<int> states;
    for (int k = 0; k < kSamples; ++k) {
        states.push_back(here(curve, curve.from + (k + 0.5) * step).state);
    }
    const auto border = [&](double lo, double hi, int state) {
        for (int n = 0; n < 40; ++n) {
            const double middle = 0.5 * (lo + hi);
            (here(curve, middle).state == state ? lo : hi) = middle;
        }
        return lo;
    };
    // Parts of a closed curve begin at a change.
    int first = 0;
    double begin = curve.from;
    const bool closed = curve.to - curve.from > 6.0 && (curve.round || !curve.has_form);
    if (closed) {
        while (first < kSamples && states[static_cast<std::size_t>(first)] ==
                                       states[static_cast<std::size_t>((first + 1) % kSamples)]) {
            ++first;
        }
        if (first < kSamples) {
            const double lo = curve.from + (first + 0.5) * step;
            begin = border(lo, lo + step, states[static_cast<std::size_t>(first)]);
            ++first;
        } else {
            first = 0;
        }
    }
    int state = states[static_cast<std::size_t>(first % kSamples)];
    for (int k = 1; k < kSamples; ++k) {
        const int next = states[static_cast<std::size_t>((first + k) % kSamples)];
        if (next == state) continue;
        const double lo = curve.from + (first + k - 0.5) * step;
        const double end = border(lo, lo + step, state);
        emit(curve, state, begin, end);
        begin = end;
        state = next;
    }
    double end = curve.to;
    if (closed && begin > curve.from) {
        // The last part ends where the first begins.
        const double lo = curve.from + (first + kSamples - 0.5) * step;
        end = border(lo - step, lo + step, state);
    }
    emit(curve, state, begin, end);
}

void SolidCurveParts::emit(const SolidCurve& curve, int state, double from, double to) {
    if (state == 0 || !(from < to)) return;
    const double middle = 0.5 * (from + to);
    if (is_known(curve, from, middle, to)) return;
    FeatureCurve result;
    result.style = state == 2 ? LineStyle::Silhouette : LineStyle::Crease;
    if (curve.has_form) {
        result.round = curve.round;
        result.points = curve.form;
        result.from = from;
        result.to = to;
        set_normals(curve, result);
        curves_.push_back(result);
        return;
    }
    const double span = (to - from) * 1e-9;
    const std::optional<Vec3> a = curve.at(from + span), m = curve.at(middle),
                              b = curve.at(to - span);
    if (!a || !m || !b) return;
    divide(curve, result, {from + span, *a}, {middle, *m}, 12);
    divide(curve, result, {middle, *m}, {to - span, *b}, 12);
}

void SolidCurveParts::divide(const SolidCurve& curve, FeatureCurve& result, const Point& a,
                             const Point& b, int depth) {
    const double t = 0.5 * (a.t + b.t);
    const std::optional<Vec3> m = curve.at(t);
    if (!m) return;
    const double size = length(solid_.leaf(*curve.face).box.size());
    const double off = length(*m - 0.5 * (a.p + b.p));
    if ((off > kChord * size || b.t - a.t > 0.1) && depth > 0) {
        divide(curve, result, a, {t, *m}, depth - 1);
        divide(curve, result, {t, *m}, b, depth - 1);
        return;
    }
    if (off > 0.05 * size) return;  // a jump between branches
    const Here at = here(curve, t);
    if (at.state == 0) return;
    result.points = {a.p, b.p - a.p, {}};
    result.out = {at.out, {}, {}};
    result.other_out = {at.other_out, {}, {}};
    result.off = off;
    curves_.push_back(result);
}

void SolidCurveParts::set_normals(const SolidCurve& curve, FeatureCurve& result) const {
    const double span = result.to - result.from, middle = 0.5 * (result.from + result.to);
    const Here m = here(curve, middle);
    result.out = {m.out, {}, {}};
    result.other_out = {m.other_out, {}, {}};
    if (!curve.round || span < 0.3) return;
    const double step = std::min(span / 3.0, 2.0);
    const Here a = here(curve, middle - step), b = here(curve, middle + step);
    if (a.state == 0 || b.state == 0) return;
    const double c = std::cos(step), s = std::sin(step);
    const auto fit = [&](const Vec3& before, const Vec3& at, const Vec3& after) {
        // With the angle from the middle: at = o + u, before and after = o + c u -+ s v.
        const Vec3 u = (at - 0.5 * (before + after)) / (1.0 - c), o = at - u;
        const Vec3 v = 0.5 * (after - before) / s;
        return CurveForm{o, std::cos(middle) * u - std::sin(middle) * v,
                         std::sin(middle) * u + std::cos(middle) * v};
    };
    result.out = fit(a.out, m.out, b.out);
    result.other_out = fit(a.other_out, m.other_out, b.other_out);
}

bool SolidCurveParts::is_known(const SolidCurve& curve, double from, double middle, double to) {
    const double near = 1e-5 * length(solid_.leaf(*curve.face).box.size());
    const std::optional<Vec3> a = curve.at(from), m = curve.at(middle), b = curve.at(to);
    if (!a || !m || !b) return false;
    const auto same = [&](const Vec3& p, const Vec3& q) {
        return max_component(abs(p - q)) < near;
    };
    for (const std::array<Vec3, 3>& k : known_) {
        const bool ends = (same(k[0], *a) && same(k[2], *b)) || (same(k[0], *b) && same(k[2], *a));
        if (ends && same(k[1], *m)) return true;
    }
    known_.push_back({*a, *m, *b});
    return false;
}

}  // namespace alhazen
