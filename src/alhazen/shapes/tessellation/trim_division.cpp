#include "alhazen/shapes/tessellation/trim_division.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/base/interruption.h"
#include "alhazen/shapes/patches/nurbs/trim_arcs.h"
#include "alhazen/shapes/tessellation/derivative_bounds.h"

namespace alhazen {

namespace {

/// The borders of the pieces as lines of the parameter plane, and the pieces between them.
class PieceGrid {
  public:
    explicit PieceGrid(std::span<const BezierPiece> pieces) : pieces_(pieces) {
        for (const BezierPiece& piece : pieces) {
            lines_[0].insert(lines_[0].end(), {piece.lo.x, piece.hi.x});
            lines_[1].insert(lines_[1].end(), {piece.lo.y, piece.hi.y});
        }
        for (int axis = 0; axis < 2; ++axis) {
            std::vector<double>& lines = lines_[axis];
            std::sort(lines.begin(), lines.end());
            lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
            const double largest = std::max(std::abs(lines.front()), std::abs(lines.back()));
            near_[axis] = std::max(0x1p-40 * (lines.back() - lines.front()), 0x1p-48 * largest);
        }
        cells_.assign((lines_[0].size() - 1) * (lines_[1].size() - 1), kNoPiece);
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            cells_[cell_of(0.5 * (pieces[k].lo + pieces[k].hi))] = static_cast<std::uint32_t>(k);
        }
    }
    static constexpr std::uint32_t kNoPiece = 0xFFFFFFFFu;

    [[nodiscard]] const std::vector<double>& lines(int axis) const { return lines_[axis]; }

    /// The nearest line if it is very near, else x.
    [[nodiscard]] double snapped(double x, int axis) const {
        const std::vector<double>& lines = lines_[axis];
        const auto after = std::lower_bound(lines.begin(), lines.end(), x);
        if (after != lines.end() && *after - x <= near_[axis]) return *after;
        if (after != lines.begin() && x - *std::prev(after) <= near_[axis])
            return *std::prev(after);
        return x;
    }
    [[nodiscard]] Vec2 snapped(const Vec2& p) const { return {snapped(p.x, 0), snapped(p.y, 1)}; }

    [[nodiscard]] bool is_line(double x, int axis) const {
        return std::binary_search(lines_[axis].begin(), lines_[axis].end(), x);
    }

    /// The cells that the closed range meets, [first, last); a line is of the cells on both sides.
    [[nodiscard]] std::pair<std::size_t, std::size_t> cells_over(double lo, double hi,
                                                                 int axis) const {
        const std::vector<double>& lines = lines_[axis];
        const auto first = std::lower_bound(lines.begin(), lines.end(), lo) - lines.begin();
        const auto last = std::upper_bound(lines.begin(), lines.end(), hi) - lines.begin();
        const auto most = std::ssize(lines) - 1;
        return {static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(first - 1, 0, most)),
                static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(last, 0, most))};
    }
    [[nodiscard]] std::uint32_t piece_in(std::size_t column, std::size_t row) const {
        return cells_[column * (lines_[1].size() - 1) + row];
    }
    /// The piece around a point that is not on its border, or kNoPiece.
    [[nodiscard]] std::uint32_t piece_at(const Vec2& p) const {
        for (int axis = 0; axis < 2; ++axis) {
            const double x = axis == 0 ? p.x : p.y;
            if (!(x > lines_[axis].front() && x < lines_[axis].back())) return kNoPiece;
        }
        return cells_[cell_of(p)];
    }
    [[nodiscard]] const BezierPiece& piece(std::uint32_t index) const { return pieces_[index]; }

  private:
    [[nodiscard]] std::size_t cell_of(const Vec2& p) const {
        const auto index = [](const std::vector<double>& lines, double x) {
            return static_cast<std::size_t>(std::upper_bound(lines.begin(), lines.end(), x) -
                                            lines.begin() - 1);
        };
        return index(lines_[0], p.x) * (lines_[1].size() - 1) + index(lines_[1], p.y);
    }

    std::span<const BezierPiece> pieces_;
    std::vector<double> lines_[2];  ///< [axis] ascending
    double near_[2] = {0, 0};
    std::vector<std::uint32_t> cells_;
};

/// Bounds of the derivatives of a piece by the parameters of the domain, in a part of it.
Vec2 speed_in(const BezierPiece& piece, const Vec2& lo, const Vec2& hi) {
    const auto range = [](double from, double to, double begin, double end) {
        // Of at least this width, so that differences of control points are not all rounding.
        constexpr double kLeast = 0x1p-16;
        const double a = std::clamp((from - begin) / (end - begin), 0.0, 1.0);
        const double b = std::clamp((to - begin) / (end - begin), 0.0, 1.0);
        const double widen = std::max(0.0, 0.5 * (kLeast - (b - a)));
        return Interval{std::max(a - widen, 0.0), std::min(b + widen, 1.0)};
    };
    const Interval u = range(lo.x, hi.x, piece.lo.x, piece.hi.x);
    const Interval v = range(lo.y, hi.y, piece.lo.y, piece.hi.y);
    const Vec2 bounds = first_derivative_bounds(part_of(piece.net, u.lo, u.hi, v.lo, v.hi));
    return {bounds.x / ((u.hi - u.lo) * (piece.hi.x - piece.lo.x)),
            bounds.y / ((v.hi - v.lo) * (piece.hi.y - piece.lo.y))};
}

class LoopDivider {
  public:
    LoopDivider(const PieceGrid& grid, std::span<const BezierPiece> pieces, double tolerance,
                std::uint64_t max_chords)
        : grid_(grid), tolerance_(tolerance), max_chords_(max_chords) {
        for (const BezierPiece& piece : pieces) {
            speeds_.push_back(speed_in(piece, piece.lo, piece.hi));
        }
    }

    /// The points of each loop, the last one before the first. False if there are too many.
    bool divide(std::span<const TrimArc> arcs, std::vector<std::vector<Vec2>>& loops) {
        for (const TrimArc& arc : arcs) {
            interruption_point();
            points_ = &loops[arc.loop];
            if (points_->empty()) points_->push_back(grid_.snapped(arc.begin));
            divide(arc, kMaxHalvings);
            if (count_ > max_chords_) return false;
        }
        return true;
    }

  private:
    static constexpr int kMaxHalvings = 24;

    template <class Points>
    void divide(const TrimArcOf<Points>& arc, int depth) {
        if (count_ > max_chords_) return;
        if (depth == 0 || arc.straight() || is_flat(arc)) {
            const Vec2 end = grid_.snapped(arc.end);
            if (end == points_->back()) return;
            points_->push_back(end);
            ++count_;
            return;
        }
        const auto [first, second] = halved(arc);
        divide(first, depth - 1);
        divide(second, depth - 1);
    }

    /// True if the chord is within the tolerance of the arc on all pieces around it.
    template <class Points>
    [[nodiscard]] bool is_flat(const TrimArcOf<Points>& arc) const {
        constexpr std::size_t kMostPieces = 16;
        const auto [u_first, u_last] = grid_.cells_over(arc.lo.x, arc.hi.x, 0);
        const auto [v_first, v_last] = grid_.cells_over(arc.lo.y, arc.hi.y, 1);
        if (bend_of(arc, {1, 1}) == 0.0) return true;
        if ((u_last - u_first) * (v_last - v_first) > kMostPieces) return false;
        // The speeds of whole pieces, which are known, suffice for most arcs that are flat.
        for (const bool whole : {true, false}) {
            Vec2 speed;
            for (std::size_t i = u_first; i < u_last; ++i) {
                for (std::size_t j = v_first; j < v_last; ++j) {
                    const std::uint32_t k = grid_.piece_in(i, j);
                    if (k == PieceGrid::kNoPiece) continue;
                    const Vec2 here = whole ? speeds_[k] : speed_in(grid_.piece(k), arc.lo, arc.hi);
                    speed = {std::max(speed.x, here.x), std::max(speed.y, here.y)};
                }
            }
            // The speeds of u and v may have one direction.
            if (std::sqrt(2.0) * bend_of(arc, speed) <= tolerance_) return true;
        }
        return false;
    }

    /// A bound of the distance of the arc from its chord, with u and v scaled: the largest distance
    /// of a control point, as the distance is convex.
    template <class Points>
    static double bend_of(const TrimArcOf<Points>& arc, const Vec2& scale) {
        const auto scaled = [&](const Vec2& p) { return Vec2{scale.x * p.x, scale.y * p.y}; };
        const Vec2 chord = scaled(arc.end - arc.begin);
        const double length2 = chord.x * chord.x + chord.y * chord.y;
        double most = 0.0;
        for (const HomogeneousPoint& point : arc.points) {
            const Vec2 p = scaled(Vec2{point.x / point.w, point.y / point.w} - arc.begin);
            const double along = p.x * chord.x + p.y * chord.y;
            const double s = length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
            most = std::max(most, std::hypot(p.x - s * chord.x, p.y - s * chord.y));
        }
        return most;
    }

    const PieceGrid& grid_;
    double tolerance_;
    std::uint64_t max_chords_;
    std::vector<Vec2> speeds_;  ///< [piece]
    std::vector<Vec2>* points_ = nullptr;
    std::uint64_t count_ = 0;
};

/// Divides chords at the borders of pieces and lists them by piece.
class ChordSorter {
  public:
    ChordSorter(const PieceGrid& grid, std::vector<TrimDivision::Part>& parts)
        : grid_(grid), parts_(parts) {}

    void add(const Vec2& from, const Vec2& to) {
        cuts_.clear();
        cut(from, to, 0);
        cut(from, to, 1);
        std::sort(cuts_.begin(), cuts_.end(),
                  [](const Cut& a, const Cut& b) { return a.at < b.at; });
        cuts_.push_back({1.0, to});
        Vec2 begin = from;
        for (const Cut& next : cuts_) {
            if (next.point == begin) continue;
            add_within(begin, next.point);
            begin = next.point;
        }
    }
    [[nodiscard]] std::uint64_t count() const { return count_; }

  private:
    struct Cut {
        double at;
        Vec2 point;
    };

    /// Appends the points where the chord crosses lines of an axis.
    void cut(const Vec2& from, const Vec2& to, int axis) {
        const auto part = [](const Vec2& p, int k) { return k == 0 ? p.x : p.y; };
        const double a = part(from, axis), b = part(to, axis);
        const double c = part(from, 1 - axis), d = part(to, 1 - axis);
        const std::vector<double>& lines = grid_.lines(axis);
        auto line = std::upper_bound(lines.begin(), lines.end(), std::min(a, b));
        for (; line != lines.end() && *line < std::max(a, b); ++line) {
            const double at = (*line - a) / (b - a);
            const double across = grid_.snapped(
                std::clamp(c + at * (d - c), std::min(c, d), std::max(c, d)), 1 - axis);
            cuts_.push_back({at, axis == 0 ? Vec2{*line, across} : Vec2{across, *line}});
        }
    }

    void add_within(const Vec2& from, const Vec2& to) {
        for (const Vec2& p : {from, to}) {
            if (grid_.is_line(p.x, 0) || grid_.is_line(p.y, 1)) add_on_border(p);
        }
        const bool along_line = (from.x == to.x && grid_.is_line(from.x, 0)) ||
                                (from.y == to.y && grid_.is_line(from.y, 1));
        if (along_line) return;
        const std::uint32_t piece = grid_.piece_at(0.5 * (from + to));
        if (piece == PieceGrid::kNoPiece) return;
        parts_[piece].chords.push_back({from, to});
        ++count_;
    }

    void add_on_border(const Vec2& p) {
        const auto [u_first, u_last] = grid_.cells_over(p.x, p.x, 0);
        const auto [v_first, v_last] = grid_.cells_over(p.y, p.y, 1);
        for (std::size_t i = u_first; i < u_last; ++i) {
            for (std::size_t j = v_first; j < v_last; ++j) {
                const std::uint32_t k = grid_.piece_in(i, j);
                if (k == PieceGrid::kNoPiece) continue;
                const Vec2 lo = grid_.piece(k).lo, hi = grid_.piece(k).hi;
                if (p.x < lo.x || p.x > hi.x || p.y < lo.y || p.y > hi.y) continue;
                std::vector<Vec2>& points = parts_[k].on_border;
                if (points.empty() || points.back() != p) points.push_back(p);
            }
        }
    }

    const PieceGrid& grid_;
    std::vector<TrimDivision::Part>& parts_;
    std::vector<Cut> cuts_;
    std::uint64_t count_ = 0;
};

}  // namespace

std::optional<TrimDivision> divided_trims(std::span<const TrimLoop> loops,
                                          std::span<const BezierPiece> pieces, double tolerance,
                                          std::uint64_t max_chords) {
    constexpr std::uint64_t kMostParts = 4;  // on average
    const PieceGrid grid(pieces);
    std::vector<std::vector<Vec2>> points(loops.size());
    LoopDivider divider(grid, pieces, tolerance, max_chords);
    if (!divider.divide(trim_arcs(loops, kInfinity), points)) return std::nullopt;
    std::vector<TrimDivision::Part> parts(pieces.size());
    ChordSorter sorter(grid, parts);
    std::vector<TrimLoop> polylines;
    for (std::vector<Vec2>& loop : points) {
        if (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
        if (loop.size() < 3) continue;
        loop.push_back(loop.front());
        for (std::size_t k = 0; k + 1 < loop.size(); ++k) {
            sorter.add(loop[k], loop[k + 1]);
            if (sorter.count() > kMostParts * max_chords) return std::nullopt;
        }
        polylines.push_back({TrimCurve{.degree = 1, .points = std::move(loop)}});
    }
    if (polylines.empty()) {  // a region of nothing
        polylines.push_back({TrimCurve{.degree = 1, .points = {pieces[0].lo, pieces[0].lo}}});
    }
    return TrimDivision{std::move(parts), TrimRegion(polylines)};
}

}  // namespace alhazen
