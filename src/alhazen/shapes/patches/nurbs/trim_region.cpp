#include "alhazen/shapes/patches/nurbs/trim_region.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "alhazen/base/number_text.h"
#include "alhazen/math/orientation.h"
#include "alhazen/shapes/patches/nurbs/bspline_pieces.h"

namespace alhazen {

namespace {

/// Flatness of the stored arcs relative to the loops' size; few halvings then remain per query.
constexpr double kArcFlatness = 1e-3;

/// True if the half-line from p towards greater u crosses an arc an odd number of times.
template <class Arc>
bool crosses_half_line(const Arc& arc, const Vec2& p, int depth) {
    if (p.y < arc.lo.y || p.y > arc.hi.y || p.x > arc.hi.x) return false;
    const bool ends_differ = (arc.begin.y > p.y) != (arc.end.y > p.y);
    if (p.x < arc.lo.x) return ends_differ;
    if (arc.straight() || depth == 0) {
        if (!ends_differ) return false;
        const bool upward = arc.end.y > arc.begin.y;
        const int side = orientation(arc.begin, arc.end, p);
        return upward ? side > 0 : side < 0;
    }
    const auto [first, second] = halved(arc);
    return crosses_half_line(first, p, depth - 1) != crosses_half_line(second, p, depth - 1);
}

}  // namespace

TrimRegion::TrimRegion(std::span<const TrimLoop> loops) {
    Vec2 lo{kInfinity, kInfinity}, hi{-kInfinity, -kInfinity};
    for (const TrimLoop& loop : loops) {
        for (const TrimCurve& curve : loop) {
            for (const Vec2& p : curve.points) {
                lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
                hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
            }
        }
    }
    arcs_ = trim_arcs(loops, kArcFlatness * std::max(hi.x - lo.x, hi.y - lo.y));
    v_lo_ = lo.y;
    v_hi_ = hi.y;
    const std::size_t strips = std::clamp<std::size_t>(2 * arcs_.size(), 1, 4096);
    strip_starts_.assign(strips + 1, 0);
    for (int pass = 0; pass < 2; ++pass) {
        std::vector<std::uint32_t> next = strip_starts_;
        for (std::uint32_t k = 0; k < arcs_.size(); ++k) {
            const StripRange range = strips_of(arcs_[k].lo.y, arcs_[k].hi.y);
            for (std::size_t strip = range.first; strip <= range.last; ++strip) {
                if (pass == 0) {
                    ++strip_starts_[strip + 1];
                } else {
                    strip_arcs_[next[strip]++] = k;
                }
            }
        }
        if (pass == 1) break;
        for (std::size_t s = 0; s < strips; ++s) strip_starts_[s + 1] += strip_starts_[s];
        strip_arcs_.resize(strip_starts_.back());
    }
}

TrimRegion::StripRange TrimRegion::strips_of(double v_lo, double v_hi) const {
    // Arcs are listed in every strip between the v of their ends, by a function monotone in v.
    const auto strips = static_cast<double>(strip_starts_.size() - 1);
    const auto strip_of = [&](double v) {
        const double at = v_hi_ > v_lo_ ? (v - v_lo_) / (v_hi_ - v_lo_) * strips : 0.0;
        return static_cast<std::size_t>(std::clamp(at, 0.0, strips - 1.0));
    };
    return {strip_of(v_lo), strip_of(v_hi)};
}

std::span<const std::uint32_t> TrimRegion::arcs_over(std::size_t strip) const {
    return std::span(strip_arcs_)
        .subspan(strip_starts_[strip], strip_starts_[strip + 1] - strip_starts_[strip]);
}

bool TrimRegion::contains(const Vec2& p) const {
    constexpr int kMaxDepth = 60;
    bool inside = false;
    for (const std::uint32_t arc : arcs_over(strips_of(p.y, p.y).first)) {
        if (crosses_half_line(arcs_[arc], p, kMaxDepth)) inside = !inside;
    }
    return inside;
}

TrimRegion::Cover TrimRegion::cover(const Vec2& lo, const Vec2& hi) const {
    const StripRange range = strips_of(lo.y, hi.y);
    for (std::size_t strip = range.first; strip <= range.last; ++strip) {
        for (const std::uint32_t k : arcs_over(strip)) {
            const TrimArc& arc = arcs_[k];
            if (arc.lo.x <= hi.x && lo.x <= arc.hi.x && arc.lo.y <= hi.y && lo.y <= arc.hi.y) {
                return Cover::Some;
            }
        }
    }
    return contains(0.5 * (lo + hi)) ? Cover::All : Cover::None;
}

std::size_t TrimRegion::bytes() const {
    std::size_t sum = sizeof *this + arcs_.capacity() * sizeof(TrimArc);
    for (const TrimArc& arc : arcs_) sum += arc.points.capacity() * sizeof(HomogeneousPoint);
    return sum + (strip_starts_.capacity() + strip_arcs_.capacity()) * sizeof(std::uint32_t);
}

namespace {

std::string place_of(const Vec2& p) {
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
}

/// Reports the faults of one loop.
class TrimFindings {
  public:
    explicit TrimFindings(FieldChecks& checks) : checks_(checks) {}
    void fail(const std::string& what) {
        checks_.fail(what);
        good_ = false;
    }
    void note(bool good) { good_ = good_ && good; }
    [[nodiscard]] FieldChecks& checks() { return checks_; }
    [[nodiscard]] bool good() const { return good_; }

  private:
    FieldChecks& checks_;
    bool good_ = true;
};

void check_trim_counts(TrimFindings& findings, const std::string& name, const TrimCurve& curve) {
    const std::size_t count = curve.points.size(), degree = curve.degree;
    if (degree < 1 || degree > kMaxTrimDegree) {
        findings.fail(name + ": the degree must be from 1 to " + std::to_string(kMaxTrimDegree) +
                      ", not " + std::to_string(degree));
        return;
    }
    if (!curve.weights.empty() && curve.weights.size() != count) {
        findings.fail(name + ": expected one weight for each of the " + std::to_string(count) +
                      " points, found " + std::to_string(curve.weights.size()));
    }
    if (curve.knots.empty()) {
        if (degree == 1 ? count < 2 : count != degree + 1) {
            findings.fail(name + ": a curve of degree " + std::to_string(degree) +
                          " without knots has " + (degree == 1 ? "at least " : "") +
                          std::to_string(degree + 1) + " points, not " + std::to_string(count));
        }
    } else if (curve.knots.size() != count + degree + 1) {
        findings.fail(name + ": " + std::to_string(count) + " points of degree " +
                      std::to_string(degree) + " have " + std::to_string(count + degree + 1) +
                      " knots, not " + std::to_string(curve.knots.size()));
    } else {
        findings.note(check_knots(findings.checks(), name, curve.knots, curve.degree));
    }
}

void check_trim_values(TrimFindings& findings, const std::string& name, const TrimCurve& curve) {
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
        const Vec2& p = curve.points[k];
        if (!(std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate)) {
            findings.fail(name + ": point " + std::to_string(k) + " must be two finite numbers");
        }
    }
    for (std::size_t k = 0; k < curve.weights.size(); ++k) {
        if (!(curve.weights[k] >= 1e-6 && curve.weights[k] <= 1e6)) {
            findings.fail(name + ": weight " + std::to_string(k) +
                          " must be from 1e-6 to 1e6, not " + shortest(curve.weights[k]));
        }
    }
}

/// Checks that each curve begins where the one before it ends.
void check_trim_joints(TrimFindings& findings, const std::string& name, const TrimLoop& loop,
                       const Vec2& size) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::size_t next = (k + 1) % loop.size();
        const Vec2 end = end_of(loop[k]), begin = begin_of(loop[next]);
        if (!(std::abs(end.x - begin.x) <= kMaxTrimGap * size.x &&
              std::abs(end.y - begin.y) <= kMaxTrimGap * size.y)) {
            findings.fail(name + " is open: curve " + std::to_string(k) + " ends at " +
                          place_of(end) + ", curve " + std::to_string(next) + " begins at " +
                          place_of(begin));
        }
    }
}

}  // namespace

void check_trim_loops(FieldChecks& checks, std::span<const TrimLoop> loops, const Vec2& size) {
    bool good = true;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const std::string name = "trims: loop " + std::to_string(l);
        TrimFindings found(checks);
        if (loops[l].empty()) found.fail(name + " has no curves");
        for (std::size_t k = 0; k < loops[l].size(); ++k) {
            const std::string curve = name + ", curve " + std::to_string(k);
            check_trim_counts(found, curve, loops[l][k]);
            check_trim_values(found, curve, loops[l][k]);
        }
        if (found.good()) check_trim_joints(found, name, loops[l], size);
        good = good && found.good();
    }
    if (!good || loops.empty()) return;
    const double extent = std::max(size.x, size.y);
    for (const TrimCrossing& crossing : trim_crossings(trim_arcs(loops, 1e-3 * extent), extent)) {
        const std::string first = std::to_string(crossing.first);
        checks.fail("trims: loop " + first + " crosses " +
                    (crossing.first == crossing.second
                         ? "itself"
                         : "loop " + std::to_string(crossing.second)) +
                    " near " + place_of(crossing.point));
    }
}

}  // namespace alhazen
