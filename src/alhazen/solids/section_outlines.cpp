#include "alhazen/solids/section_outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

/// Largest number of times that a cell is split into four, and the grid units per side of a cell.
constexpr int kMaxSplits = 8;
constexpr std::int64_t kUnits = std::int64_t{1} << kMaxSplits;
/// Limit of splits of a chord; the tolerance is reached far earlier or never.
constexpr int kMaxChordSplits = 24;

struct Segment {
    Vec2 from, to;
};

struct PointHash {
    std::size_t operator()(const Vec2& p) const {
        return std::hash<double>()(p.x) * 31 + std::hash<double>()(p.y);
    }
};

/// A crossing of an edge of a cell; `enters` refers to a counter-clockwise walk around the cell.
struct EdgeCrossing {
    Vec2 point;
    bool enters;
};

class ContourFollower {
  public:
    ContourFollower(const Measurable& solid, const PlaneFrame& frame, const OutlineOptions& options)
        : solid_(solid), frame_(frame), tolerance_(0.5 * options.tolerance) {
        const auto range = [&](const Vec3& axis) {
            const Interval extent = solid.extent(axis);
            const double shift = dot(axis, frame.origin);
            return Interval{extent.lo - shift, extent.hi - shift};
        };
        const Interval x = range(frame.right), y = range(frame.up);
        if (!std::isfinite(x.width() + y.width())) {
            throw Error(ErrorKind::Usage, "the solid is not bounded: its outline may have no end");
        }
        const double cell = std::max(x.width(), y.width()) / options.cells;
        unit_ = cell / static_cast<double>(kUnits);
        // Irrational offsets, so that grid lines are unlikely to run along an edge of the outline.
        x0_ = x.lo - 0.6180339887 * cell;
        y0_ = y.lo - 0.7320508076 * cell;
        if (!(cell > 0.0)) return;
        columns_ = static_cast<std::int64_t>(std::ceil((x.hi - x0_) / cell)) + 1;
        rows_ = static_cast<std::int64_t>(std::ceil((y.hi - y0_) / cell)) + 1;
    }

    SectionOutlines run() {
        for (std::int64_t j = 0; j < rows_; ++j) {
            for (std::int64_t i = 0; i < columns_; ++i) cell(i * kUnits, j * kUnits, kUnits);
        }
        link();
        return std::move(out_);
    }

  private:
    [[nodiscard]] double x_of(std::int64_t unit) const {
        return x0_ + unit_ * static_cast<double>(unit);
    }
    [[nodiscard]] double y_of(std::int64_t unit) const {
        return y0_ + unit_ * static_cast<double>(unit);
    }

    /// The spans of a line in the plane.
    const std::vector<Interval>& spans(const Vec2& through, const Vec2& direction) {
        interruption_point();
        const Vec3 origin = frame_.origin + through.x * frame_.right + through.y * frame_.up;
        solid_.cross({origin, direction.x * frame_.right + direction.y * frame_.up}, false, found_);
        return found_.spans;
    }
    const std::vector<Interval>& row(std::int64_t unit) {
        const auto [entry, fresh] = row_spans_.try_emplace(unit);
        if (fresh) entry->second = spans({0, y_of(unit)}, {1, 0});
        return entry->second;
    }
    const std::vector<Interval>& column(std::int64_t unit) {
        const auto [entry, fresh] = column_spans_.try_emplace(unit);
        if (fresh) entry->second = spans({x_of(unit), 0}, {0, 1});
        return entry->second;
    }

    /// Adds crossings of an edge [lo, hi) of a cell; `forward`: towards growing coordinates.
    void edge(const std::vector<Interval>& spans, double lo, double hi, bool is_row, double at,
              bool forward) {
        auto span = std::lower_bound(spans.begin(), spans.end(), lo,
                                     [](const Interval& s, double t) { return s.hi < t; });
        const auto add = [&](double t, bool begins) {
            if (!(lo <= t && t < hi)) return;
            around_.push_back({is_row ? Vec2{t, at} : Vec2{at, t}, begins == forward});
        };
        for (; span != spans.end() && span->lo < hi; ++span) {
            add(span->lo, true);
            add(span->hi, false);
        }
    }

    void cell(std::int64_t x, std::int64_t y, std::int64_t size) {
        const double x0 = x_of(x), x1 = x_of(x + size);
        const double y0 = y_of(y), y1 = y_of(y + size);
        std::array<std::size_t, 4> ends{};
        around_.clear();
        edge(row(y), x0, x1, true, y0, true);
        ends[0] = around_.size();
        edge(column(x + size), y0, y1, false, x1, true);
        ends[1] = around_.size();
        edge(row(y + size), x0, x1, true, y1, false);
        ends[2] = around_.size();
        edge(column(x), y0, y1, false, x0, false);
        if (around_.empty()) return;
        const bool one_edge = ends[0] == 2 || ends[1] - ends[0] == 2 || ends[2] - ends[1] == 2 ||
                              around_.size() - ends[2] == 2;
        const bool simple = around_.size() == 2 && around_[0].enters != around_[1].enters;
        if (simple && (!one_edge || size == 1)) {
            add_segment(around_[0], around_[1]);
        } else if (size > 1) {
            const std::int64_t half = size / 2;
            for (const std::int64_t dy : {std::int64_t{0}, half}) {
                for (const std::int64_t dx : {std::int64_t{0}, half}) cell(x + dx, y + dy, half);
            }
        } else {
            pair_up();
        }
    }

    /// Pairs the ends of curves that the grid cannot separate: any pairing is valid.
    void pair_up() {
        ++out_.unresolved;
        std::vector<EdgeCrossing> enters, leaves;
        for (const EdgeCrossing& c : around_) (c.enters ? enters : leaves).push_back(c);
        for (std::size_t i = 0; i < std::min(enters.size(), leaves.size()); ++i) {
            add_segment(enters[i], leaves[i]);
        }
    }

    /// Adds a segment directed so that the solid, which lies between entry and exit, is on its
    /// left.
    void add_segment(const EdgeCrossing& a, const EdgeCrossing& b) {
        const Segment s = a.enters ? Segment{b.point, a.point} : Segment{a.point, b.point};
        segments_.push_back(s);
    }

    void link() {
        std::unordered_multimap<Vec2, std::size_t, PointHash> begins;
        for (std::size_t i = 0; i < segments_.size(); ++i) begins.emplace(segments_[i].from, i);
        std::vector<bool> used(segments_.size());
        for (std::size_t first = 0; first < segments_.size(); ++first) {
            if (used[first]) continue;
            Polyline loop;
            std::size_t i = first;
            for (;;) {
                used[i] = true;
                trace_chord(segments_[i], loop);
                const auto [begin, end] = begins.equal_range(segments_[i].to);
                const auto next = std::find_if(
                    begin, end, [&](const auto& entry) { return !used[entry.second]; });
                if (next == end) break;
                i = next->second;
            }
            const bool closes = segments_[i].to == segments_[first].from;
            if (!closes) {
                ++out_.unresolved;
                loop.push_back(segments_[i].to);
            }
            simplify(loop);
            if (loop.size() >= 3) out_.loops.push_back(std::move(loop));
        }
    }

    /// Appends the start of the segment and points of the curve up to its end.
    void trace_chord(const Segment& segment, Polyline& loop) {
        struct Piece {
            Vec2 from, to;
            int depth;
        };
        std::vector<Piece> waiting{{segment.from, segment.to, 0}};
        while (!waiting.empty()) {
            const Piece piece = waiting.back();
            waiting.pop_back();
            const Vec2 chord = piece.to - piece.from;
            const double size = std::hypot(chord.x, chord.y);
            bool near = size <= tolerance_ || piece.depth == kMaxChordSplits;
            if (!near) {
                near = true;
                Vec2 middle;
                for (const double part : {0.5, 0.25, 0.75}) {
                    const Vec2 at = piece.from + part * chord;
                    const double off = offset_of_curve(at, chord, size);
                    if (!(std::abs(off) <= size)) {
                        // A curve this far from the chord is a different one.
                        if (part == 0.5) ++out_.unresolved;
                        break;
                    }
                    const Vec2 left{-chord.y / size, chord.x / size};
                    if (part == 0.5) middle = at + off * left;
                    near = near && std::abs(off) <= tolerance_;
                    if (!near && part == 0.5) break;
                }
                if (!near && middle != Vec2{}) {
                    waiting.push_back({middle, piece.to, piece.depth + 1});
                    waiting.push_back({piece.from, middle, piece.depth + 1});
                    continue;
                }
            }
            loop.push_back(piece.from);
        }
    }

    /// Distance to the left of a chord point at which the solid begins; infinite if there is none.
    double offset_of_curve(const Vec2& at, const Vec2& chord, double size) {
        const Vec2 left{-chord.y / size, chord.x / size};
        double nearest = kInfinity;
        for (const Interval& span : spans(at, left)) {
            if (std::abs(span.lo) < std::abs(nearest)) nearest = span.lo;
        }
        return nearest;
    }

    /// Removes points that are within the tolerance of the remaining polyline.
    void simplify(Polyline& loop) const {
        if (loop.size() < 4) return;
        // Two points far apart divide the loop.
        std::size_t far = 0;
        double farthest = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2 d = loop[i] - loop[0];
            if (std::hypot(d.x, d.y) > farthest) {
                farthest = std::hypot(d.x, d.y);
                far = i;
            }
        }
        std::vector<bool> kept(loop.size() + 1);
        kept[0] = kept[far] = true;
        std::vector<std::pair<std::size_t, std::size_t>> waiting{{0, far}, {far, loop.size()}};
        while (!waiting.empty()) {
            const auto [begin, end] = waiting.back();
            waiting.pop_back();
            interruption_point();
            std::size_t worst = begin;
            double most = tolerance_;
            for (std::size_t i = begin + 1; i < end; ++i) {
                const double d = distance(loop[i], loop[begin], loop[end % loop.size()]);
                if (d > most) {
                    most = d;
                    worst = i;
                }
            }
            if (worst == begin) continue;
            kept[worst] = true;
            waiting.push_back({begin, worst});
            waiting.push_back({worst, end});
        }
        std::size_t n = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            if (kept[i]) loop[n++] = loop[i];
        }
        loop.resize(n);
    }

    static double distance(const Vec2& p, const Vec2& a, const Vec2& b) {
        const Vec2 ab = b - a, ap = p - a;
        const double squared = ab.x * ab.x + ab.y * ab.y;
        const double along =
            squared > 0 ? std::clamp((ap.x * ab.x + ap.y * ab.y) / squared, 0.0, 1.0) : 0.0;
        return std::hypot(ap.x - along * ab.x, ap.y - along * ab.y);
    }

    const Measurable& solid_;
    const PlaneFrame& frame_;
    double tolerance_;
    double unit_ = 0, x0_ = 0, y0_ = 0;
    std::int64_t columns_ = 0, rows_ = 0;
    std::map<std::int64_t, std::vector<Interval>> row_spans_, column_spans_;
    std::vector<EdgeCrossing> around_;
    std::vector<Segment> segments_;
    LineSpans found_;
    SectionOutlines out_;
};

}  // namespace

double SectionOutlines::area() const {
    double twice = 0;
    for (const Polyline& loop : loops) {
        const Vec2 o = loop.front();
        for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
            const Vec2 a = loop[i] - o, b = loop[i + 1] - o;
            twice += a.x * b.y - a.y * b.x;
        }
    }
    return 0.5 * twice;
}

double least_tolerance(const Box3& box) {
    if (box.empty()) return 0;
    const double reach = std::max(max_component(abs(box.lo)), max_component(abs(box.hi)));
    return 1e-9 * length(box.size()) + 1e-13 * reach;
}

SectionOutlines trace_section(const Measurable& solid, const PlaneFrame& frame,
                              const OutlineOptions& options) {
    // The negated comparison refuses NaN, which would split chords endlessly.
    if (!(options.tolerance > 0.0) || options.cells < 1) {
        throw Error(ErrorKind::Usage, "outlines need a tolerance above 0 and at least one cell");
    }
    if (solid.box().bounded() && options.tolerance < least_tolerance(solid.box())) {
        throw Error(ErrorKind::Usage,
                    "outlines need a tolerance of at least 1e-9 of the solid's size");
    }
    const double level = dot(frame.normal, frame.origin);
    if (solid.box().empty() || !solid.extent(frame.normal).contains(level)) return {};
    return ContourFollower(solid, frame, options).run();
}

}  // namespace alhazen
