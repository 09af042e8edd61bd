#include "alhazen/session/technical/line_chains.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace alhazen {

namespace {

/// A style and a position in the picture.
using End = std::tuple<LineStyle, std::int64_t, std::int64_t>;
End end_of(const DrawingLine& line, bool last) {
    const Vec2& p = last ? line.points.back() : line.points.front();
    return {line.style, std::llround(100.0 * p.x), std::llround(100.0 * p.y)};
}

constexpr double kShortest = 2;
double length_of(const DrawingLine& line) {
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < line.points.size(); ++k) {
        const Vec2 d = line.points[k + 1] - line.points[k];
        sum += std::hypot(d.x, d.y);
    }
    return sum;
}

}  // namespace

std::vector<DrawingLine> chained(std::vector<DrawingLine> lines) {
    std::multimap<End, std::size_t> ends;
    std::vector<bool> used(lines.size(), false);
    const auto joins = [&](const DrawingLine& line) {
        return !line.arc && !line.closed && line.points.size() >= 2;
    };
    for (std::size_t k = 0; k < lines.size(); ++k) {
        if (!joins(lines[k])) continue;
        ends.emplace(end_of(lines[k], false), k);
        ends.emplace(end_of(lines[k], true), k);
    }
    std::vector<DrawingLine> result;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        if (used[k]) continue;
        used[k] = true;
        DrawingLine line = std::move(lines[k]);
        for (int turn = 0; turn < 2 && joins(line); ++turn) {
            for (bool grown = true; grown;) {
                grown = false;
                const auto [first, last] = ends.equal_range(end_of(line, true));
                for (auto at = first; at != last && !grown; ++at) {
                    DrawingLine& next = lines[at->second];
                    if (used[at->second]) continue;
                    if (end_of(next, false) != at->first) {
                        std::reverse(next.points.begin(), next.points.end());
                    }
                    line.points.insert(line.points.end(), next.points.begin() + 1,
                                       next.points.end());
                    used[at->second] = grown = true;
                }
            }
            std::reverse(line.points.begin(), line.points.end());
        }
        if (line.arc || length_of(line) >= kShortest) result.push_back(std::move(line));
    }
    return result;
}

}  // namespace alhazen
