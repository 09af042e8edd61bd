#include "alhazen/geometry/facets/convex_parts.h"

#include <algorithm>
#include <array>

#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/math/orientation.h"

namespace alhazen {

namespace {

using CornerLoop = std::vector<std::uint32_t>;

/// Works on the projection along the longest axis of the normal, in which loops around it turn
/// left.
class LoopParter {
  public:
    LoopParter(std::span<const Vec3> corners, const Vec3& normal) : corners_(corners) {
        const int c = dominant_axis(normal), a = (c + 1) % 3, b = (c + 2) % 3;
        const bool flip = normal[c] < 0.0;
        for (const Vec3& p : corners) flat_.push_back({p[flip ? b : a], p[flip ? a : b]});
    }

    std::vector<std::vector<Vec3>> parts(std::vector<CornerLoop> loops) {
        std::vector<std::vector<Vec3>> result;
        if (loops.size() == 1 && is_convex(loops[0])) {
            result.push_back(points(loops[0]));
            return result;
        }
        for (const CornerLoop& outline : joined(std::move(loops))) add_triangles(outline, result);
        return result;
    }

    [[nodiscard]] bool is_convex(const CornerLoop& loop) const {
        const std::size_t n = loop.size();
        int turns_back = 0;
        for (std::size_t k = 0; k < n; ++k) {
            const std::uint32_t a = loop[k], b = loop[(k + 1) % n], c = loop[(k + 2) % n];
            const int turn = turn_at(a, b, c);
            if (turn < 0 || (turn == 0 && is_spike(a, b, c))) return false;
            // A single revolution has two changes of direction along x.
            const bool right = flat_[a].x < flat_[b].x, next = flat_[b].x < flat_[c].x;
            turns_back += right != next;
        }
        return turns_back <= 2;
    }

  private:
    [[nodiscard]] int turn_at(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return orientation(flat_[a], flat_[b], flat_[c]);
    }
    /// True if the edges at b, which are in a line, run back and forth.
    [[nodiscard]] bool is_spike(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        const Vec2 to = flat_[b] - flat_[a], from = flat_[c] - flat_[b];
        return to.x * from.x + to.y * from.y < 0.0;
    }
    [[nodiscard]] std::vector<Vec3> points(const CornerLoop& loop) const {
        std::vector<Vec3> result;
        for (const std::uint32_t k : loop) result.push_back(corners_[k]);
        return result;
    }
    [[nodiscard]] double area(const CornerLoop& loop) const {
        double sum = 0.0;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vec2 a = flat_[loop[k]] - flat_[loop[0]];
            const Vec2 b = flat_[loop[(k + 1) % loop.size()]] - flat_[loop[0]];
            sum += a.x * b.y - a.y * b.x;
        }
        return sum;
    }
    [[nodiscard]] bool is_inside(const Vec2& p, const CornerLoop& loop) const {
        bool in = false;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vec2 &a = flat_[loop[k]], &b = flat_[loop[(k + 1) % loop.size()]];
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
                in = !in;
            }
        }
        return in;
    }

    /// The outlines, each with its holes joined to it by bridges.
    std::vector<CornerLoop> joined(std::vector<CornerLoop> loops) {
        std::vector<std::vector<std::size_t>> around(loops.size());
        for (std::size_t k = 0; k < loops.size(); ++k) {
            for (std::size_t j = 0; j < loops.size(); ++j) {
                if (j != k && is_inside(flat_[loops[k][0]], loops[j])) around[k].push_back(j);
            }
            const bool outline = around[k].size() % 2 == 0;
            if ((area(loops[k]) > 0.0) != outline) std::reverse(loops[k].begin(), loops[k].end());
        }
        std::vector<CornerLoop> result;
        for (std::size_t k = 0; k < loops.size(); ++k) {
            if (around[k].size() % 2 != 0) continue;
            std::vector<CornerLoop> holes;
            for (std::size_t j = 0; j < loops.size(); ++j) {
                const bool within =
                    std::find(around[j].begin(), around[j].end(), k) != around[j].end();
                if (within && around[j].size() == around[k].size() + 1) holes.push_back(loops[j]);
            }
            result.push_back(with_holes(loops[k], std::move(holes)));
        }
        return result;
    }

    [[nodiscard]] std::size_t rightmost(const CornerLoop& loop) const {
        std::size_t best = 0;
        for (std::size_t k = 1; k < loop.size(); ++k) {
            if (flat_[loop[k]].x > flat_[loop[best]].x) best = k;
        }
        return best;
    }
    CornerLoop with_holes(CornerLoop outline, std::vector<CornerLoop> holes) {
        std::sort(holes.begin(), holes.end(), [&](const CornerLoop& a, const CornerLoop& b) {
            return flat_[a[rightmost(a)]].x > flat_[b[rightmost(b)]].x;
        });
        for (std::size_t k = 0; k < holes.size(); ++k) {
            CornerLoop hole = holes[k];
            std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(rightmost(hole)),
                        hole.end());
            const std::size_t at =
                bridge(hole[0], outline, std::span<const CornerLoop>(holes).subspan(k));
            hole.push_back(hole[0]);
            hole.push_back(outline[at]);
            outline.insert(outline.begin() + static_cast<std::ptrdiff_t>(at) + 1, hole.begin(),
                           hole.end());
        }
        return outline;
    }
    /// The index in the outline of the nearest corner that is visible from `from`.
    [[nodiscard]] std::size_t bridge(std::uint32_t from, const CornerLoop& outline,
                                     std::span<const CornerLoop> holes) const {
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const Vec2 d = flat_[outline[k]] - flat_[from];
            order.push_back({d.x * d.x + d.y * d.y, k});
        }
        std::sort(order.begin(), order.end());
        for (const auto& [distance, k] : order) {
            if (!opens_to(outline, k, from)) continue;
            bool free = !is_crossed(from, outline[k], outline);
            for (const CornerLoop& hole : holes) {
                free = free && !is_crossed(from, outline[k], hole);
            }
            if (free) return k;
        }
        return order[0].second;
    }
    /// True if a point lies within the angle of the outline at a corner.
    [[nodiscard]] bool opens_to(const CornerLoop& loop, std::size_t k, std::uint32_t to) const {
        const std::uint32_t b = loop[k], a = loop[(k + loop.size() - 1) % loop.size()],
                            c = loop[(k + 1) % loop.size()];
        const bool left_of_in = turn_at(a, b, to) > 0, left_of_out = turn_at(b, c, to) > 0;
        return turn_at(a, b, c) >= 0 ? left_of_in && left_of_out : left_of_in || left_of_out;
    }
    [[nodiscard]] bool is_crossed(std::uint32_t a, std::uint32_t b, const CornerLoop& loop) const {
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const std::uint32_t c = loop[k], d = loop[(k + 1) % loop.size()];
            const auto meets = [&](std::uint32_t p) {
                return flat_[p] == flat_[a] || flat_[p] == flat_[b];
            };
            if (meets(c) || meets(d)) continue;
            if (turn_at(a, b, c) * turn_at(a, b, d) <= 0 &&
                turn_at(c, d, a) * turn_at(c, d, b) <= 0) {
                return true;
            }
        }
        return false;
    }

    void add_triangles(const CornerLoop& outline, std::vector<std::vector<Vec3>>& result) const {
        std::vector<std::array<std::uint32_t, 3>> triangles;
        triangulate(corners_, outline, triangles);
        for (auto t : triangles) {
            const int turn = turn_at(t[0], t[1], t[2]);
            if (turn == 0) continue;
            if (turn < 0) std::swap(t[1], t[2]);
            result.push_back({corners_[t[0]], corners_[t[1]], corners_[t[2]]});
        }
    }

    std::span<const Vec3> corners_;
    std::vector<Vec2> flat_;
};

/// The loops without repeated corners.
std::vector<CornerLoop> corner_loops(std::span<const Vec3> corners,
                                     std::span<const std::uint32_t> loop_ends) {
    std::vector<CornerLoop> loops;
    std::uint32_t first = 0;
    const std::uint32_t all = static_cast<std::uint32_t>(corners.size());
    for (std::size_t k = 0; k < std::max<std::size_t>(loop_ends.size(), 1); ++k) {
        const std::uint32_t end = loop_ends.empty() ? all : loop_ends[k];
        CornerLoop loop;
        for (std::uint32_t i = first; i < end; ++i) {
            if (loop.empty() || !(corners[i] == corners[loop.back()])) loop.push_back(i);
        }
        while (loop.size() > 1 && corners[loop.front()] == corners[loop.back()]) loop.pop_back();
        if (loop.size() >= 3) loops.push_back(std::move(loop));
        first = end;
    }
    return loops;
}

}  // namespace

std::vector<std::vector<Vec3>> convex_parts(std::span<const Vec3> corners,
                                            std::span<const std::uint32_t> loop_ends,
                                            const Vec3& normal) {
    std::vector<CornerLoop> loops = corner_loops(corners, loop_ends);
    if (loops.empty()) return {};
    return LoopParter(corners, normal).parts(std::move(loops));
}

bool is_convex_loop(std::span<const Vec3> corners, const Vec3& normal) {
    const std::vector<CornerLoop> loops = corner_loops(corners, {});
    return !loops.empty() && LoopParter(corners, normal).is_convex(loops[0]);
}

}  // namespace alhazen
