#include "alhazen/geometry/polygon/constrained_triangulation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <utility>

#include "alhazen/math/orientation.h"

namespace alhazen {

namespace {

/// A distance that rounding may make in regions of the size 1.
constexpr double kRounding = 0x1p-44;

double product_2d(Vec2 a, Vec2 b) {
    return a.x * b.y - a.y * b.x;
}
double dot_2d(Vec2 a, Vec2 b) {
    return a.x * b.x + a.y * b.y;
}

/// True if d is certainly within the circle of the counter-clockwise triangle a, b, c.
bool is_in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    const Vec2 p = a - d, q = b - d, r = c - d;
    const double pp = dot_2d(p, p), qq = dot_2d(q, q), rr = dot_2d(r, r);
    const double sum = pp * product_2d(q, r) + qq * product_2d(r, p) + rr * product_2d(p, q);
    const auto size = [](Vec2 s, Vec2 t) { return std::abs(s.x * t.y) + std::abs(s.y * t.x); };
    // Shewchuk's filter has 10 e with e = 2^-53.
    constexpr double kFilter = 16.0 * 0x1p-53;
    return sum > kFilter * (pp * size(q, r) + qq * size(r, p) + rr * size(p, q));
}

}  // namespace

ConstrainedTriangulation::ConstrainedTriangulation(std::vector<Vec2> points,
                                                   std::span<const Triangle> triangles)
    : points_(std::move(points)), out_(points_.size(), kNone) {
    struct Half {
        std::uint64_t ends;
        std::uint32_t h;
    };
    std::vector<Half> halves;
    halves.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        const std::uint32_t first = add_triangle(t[0], t[1], t[2]);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint64_t a = t[k], b = t[(k + 1) % 3];
            halves.push_back({std::min(a, b) << 32 | std::max(a, b), first + k});
            flags_[first + k] = kFixed;
        }
    }
    std::sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) {
        return std::pair(a.ends, a.h) < std::pair(b.ends, b.h);
    });
    for (std::size_t k = 0; k + 1 < halves.size(); ++k) {
        if (halves[k].ends != halves[k + 1].ends) continue;
        twins_[halves[k].h] = halves[k + 1].h;
        twins_[halves[k + 1].h] = halves[k].h;
    }
}

int ConstrainedTriangulation::side(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return orientation(points_[a], points_[b], points_[c]);
}

std::uint32_t ConstrainedTriangulation::edge_between(std::uint32_t a, std::uint32_t b) const {
    std::uint32_t found = kNone;
    visit_out(a, [&](std::uint32_t h) {
        if (origins_[next(h)] == b) found = h;
        if (origins_[previous(h)] == b) found = previous(h);
        return found != kNone;
    });
    return found;
}

void ConstrainedTriangulation::link(std::uint32_t h, std::uint32_t twin, std::uint8_t flags) {
    twins_[h] = twin;
    if (twin != kNone) twins_[twin] = h;
    flags_[h] = flags;
}

std::uint32_t ConstrainedTriangulation::add_triangle(std::uint32_t a, std::uint32_t b,
                                                     std::uint32_t c) {
    const auto first = static_cast<std::uint32_t>(origins_.size());
    for (const std::uint32_t corner : {a, b, c}) {
        out_[corner] = static_cast<std::uint32_t>(origins_.size());
        origins_.push_back(corner);
        twins_.push_back(kNone);
        flags_.push_back(0);
    }
    return first;
}

std::uint32_t ConstrainedTriangulation::add_vertex(const Vec2& p) {
    points_.push_back(p);
    out_.push_back(kNone);
    return static_cast<std::uint32_t>(points_.size() - 1);
}

/// Divides a triangle a, b, c into (a, b, p), (b, c, p) and (c, a, p).
std::uint32_t ConstrainedTriangulation::split_face(std::uint32_t triangle, const Vec2& p) {
    const std::uint32_t v = add_vertex(p);
    const std::uint32_t ab = 3 * triangle, bc = ab + 1, ca = ab + 2;
    const std::uint32_t a = origins_[ab], b = origins_[bc], c = origins_[ca];
    const std::uint32_t second = add_triangle(b, c, v), third = add_triangle(c, a, v);
    link(second, twins_[bc], flags_[bc]);
    link(third, twins_[ca], flags_[ca]);
    origins_[ca] = v;
    out_[a] = ab;
    link(bc, second + 2, 0);
    link(second + 1, third + 2, 0);
    link(third + 1, ca, 0);
    flags_[second + 2] = flags_[third + 2] = flags_[ca] = 0;
    return v;
}

/// Divides the edge a-b of (a, b, c), and of (b, a, d) on its other side, at p.
std::uint32_t ConstrainedTriangulation::split_edge(std::uint32_t h, const Vec2& p) {
    const std::uint32_t v = add_vertex(p);
    const std::uint32_t g = twins_[h], hn = next(h);
    const std::uint8_t flags = flags_[h];
    const std::uint32_t a = origins_[h], b = origins_[hn], c = origins_[previous(h)];
    const std::uint32_t pbc = add_triangle(v, b, c);
    link(pbc + 1, twins_[hn], flags_[hn]);
    origins_[hn] = v;
    link(hn, pbc + 2, 0);
    flags_[pbc] = flags;
    out_[a] = h;
    out_[c] = previous(h);
    if (g == kNone) {
        twins_[h] = kNone;
        return v;
    }
    const std::uint32_t gn = next(g), d = origins_[previous(g)];
    const std::uint32_t pad = add_triangle(v, a, d);
    link(pad + 1, twins_[gn], flags_[gn]);
    origins_[gn] = v;
    link(gn, pad + 2, 0);
    link(pad, h, flags);
    link(pbc, g, flags);
    out_[a] = h;
    out_[b] = g;
    out_[d] = previous(g);
    return v;
}

/// The new vertex, or kNone if a triangle would not turn left.
std::uint32_t ConstrainedTriangulation::split_if_valid(std::uint32_t h, const Vec2& p) {
    if (!fits(h, p) || (twins_[h] != kNone && !fits(twins_[h], p))) return kNone;
    return split_edge(h, p);
}

/// True if p divides the triangle of the edge `h` into two that turn left.
bool ConstrainedTriangulation::fits(std::uint32_t h, const Vec2& p) const {
    const Vec2 a = points_[origins_[h]], b = points_[origins_[next(h)]];
    const Vec2 c = points_[origins_[previous(h)]];
    return orientation(a, p, c) > 0 && orientation(p, b, c) > 0;
}

/// Replaces the edge a-b of (a, b, c) and (b, a, d) by d-c: (d, c, a) and (c, d, b).
void ConstrainedTriangulation::flip(std::uint32_t h) {
    const std::uint32_t g = twins_[h];
    const std::uint32_t bc = next(h), ca = previous(h), ad = next(g), db = previous(g);
    const std::uint32_t a = origins_[h], b = origins_[g], c = origins_[ca], d = origins_[db];
    struct Outer {
        std::uint32_t twin;
        std::uint8_t flags;
    };
    const auto outer = [&](std::uint32_t e) { return Outer{twins_[e], flags_[e]}; };
    const Outer of_bc = outer(bc), of_ca = outer(ca), of_ad = outer(ad), of_db = outer(db);
    origins_[h] = d, origins_[bc] = c, origins_[ca] = a;
    origins_[g] = c, origins_[ad] = d, origins_[db] = b;
    flags_[h] = flags_[g] = 0;
    link(bc, of_ca.twin, of_ca.flags);
    link(ca, of_ad.twin, of_ad.flags);
    link(ad, of_db.twin, of_db.flags);
    link(db, of_bc.twin, of_bc.flags);
    out_[a] = ca, out_[b] = db, out_[c] = bc, out_[d] = ad;
}

bool ConstrainedTriangulation::can_flip(std::uint32_t h) const {
    const std::uint32_t g = twins_[h];
    if (g == kNone || (flags_[h] & kFixed) != 0) return false;
    const std::uint32_t a = origins_[h], b = origins_[g];
    const std::uint32_t c = origins_[previous(h)], d = origins_[previous(g)];
    return side(d, c, a) > 0 && side(c, d, b) > 0;
}

bool ConstrainedTriangulation::should_flip(std::uint32_t h) const {
    const std::uint32_t g = twins_[h];
    return g != kNone && (flags_[h] & kFixed) == 0 &&
           is_in_circle(points_[origins_[h]], points_[origins_[next(h)]],
                        points_[origins_[previous(h)]], points_[origins_[previous(g)]]) &&
           can_flip(h);
}

/// Flips the given edges, and those around them, while that is certain to improve.
void ConstrainedTriangulation::legalize(std::vector<std::uint32_t> open) {
    while (!open.empty()) {
        const std::uint32_t h = open.back();
        open.pop_back();
        if (!should_flip(h)) continue;
        const std::uint32_t g = twins_[h];
        flip(h);
        for (const std::uint32_t e : {next(h), previous(h), next(g), previous(g)}) {
            open.push_back(e);
        }
    }
}

void ConstrainedTriangulation::improve() {
    std::vector<std::uint32_t> all;
    for (std::uint32_t h = 0; h < origins_.size(); ++h) {
        if (twins_[h] != kNone && twins_[h] > h) all.push_back(h);
    }
    legalize(std::move(all));
}

/// The triangle that contains p, found by walking from the one found last.
std::uint32_t ConstrainedTriangulation::locate(const Vec2& p) const {
    const std::size_t count = triangle_count();
    std::uint32_t t = last_ < count ? last_ : 0;
    // The first edge tested varies, so that the walk does not go round in circles.
    std::uint32_t random = 1;
    for (std::size_t step = 0; step < 2 * count + 64; ++step) {
        bool moved = false;
        random = random * 1664525u + 1013904223u;
        const std::uint32_t first = random >> 20;
        for (std::uint32_t k = 0; k < 3 && !moved; ++k) {
            const std::uint32_t h = 3 * t + (k + first) % 3;
            if (twins_[h] == kNone) continue;
            if (orientation(points_[origins_[h]], points_[origins_[next(h)]], p) < 0) {
                t = twins_[h] / 3;
                moved = true;
            }
        }
        if (!moved) return last_ = t;
    }
    for (t = 0; t < count; ++t) {
        const Vec2 a = points_[origins_[3 * t]], b = points_[origins_[3 * t + 1]];
        const Vec2 c = points_[origins_[3 * t + 2]];
        if (orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0) {
            return last_ = t;
        }
    }
    return last_;
}

std::uint32_t ConstrainedTriangulation::insert(const Vec2& p, double near) {
    const std::uint32_t t = locate(p);
    std::uint32_t on = kNone, beside = kNone;
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const Vec2 a = points_[origins_[h]], b = points_[origins_[next(h)]];
        if (std::abs(a.x - p.x) <= near && std::abs(a.y - p.y) <= near) return origins_[h];
        if (orientation(a, b, p) <= 0) on = h;
        const double off = product_2d(b - a, p - a), size = dot_2d(b - a, b - a);
        if (off * off <= near * near * size && twins_[h] != kNone) beside = h;
    }
    std::vector<std::uint32_t> around;
    std::uint32_t v = kNone;
    if (on != kNone) {
        v = split_edge(on, p);
    } else if (beside != kNone) {
        v = split_if_valid(beside, p);
    }
    if (v == kNone) v = split_face(t, p);
    visit_out(v, [&](std::uint32_t h) {
        around.push_back(next(h));
        return false;
    });
    legalize(std::move(around));
    last_ = out_[v] / 3;
    return v;
}

void ConstrainedTriangulation::toggle(std::uint32_t h) {
    flags_[h] = static_cast<std::uint8_t>((flags_[h] ^ kBorder) | kFixed);
    if (twins_[h] != kNone) flags_[twins_[h]] = flags_[h];
}

/// Makes the segment an edge by flips of the edges that it crosses. False if they do not end.
bool ConstrainedTriangulation::clear(std::uint32_t from, std::uint32_t to,
                                     std::vector<Edge> crossed) {
    std::size_t tries = 0;
    const std::size_t most = 64 + 16 * crossed.size();
    for (std::size_t k = 0; k < crossed.size(); ++k) {
        if (++tries > most) return false;
        const Edge edge = crossed[k];
        const std::uint32_t h = edge_between(edge[0], edge[1]);
        if (h == kNone) return false;
        if (!can_flip(h)) {
            crossed.push_back(edge);
            continue;
        }
        const std::uint32_t c = origins_[previous(h)], d = origins_[previous(twins_[h])];
        flip(h);
        if (c == from || c == to || d == from || d == to) continue;
        if (side(from, to, c) * side(from, to, d) < 0) crossed.push_back({c, d});
    }
    return true;
}

/// Divides the fixed edge `h` where the segment crosses it.
ConstrainedTriangulation::Advance ConstrainedTriangulation::divide(std::uint32_t from,
                                                                   std::uint32_t to,
                                                                   std::uint32_t h) {
    const Vec2 a = points_[from], b = points_[to];
    const std::uint32_t x = origins_[h], y = origins_[next(h)];
    const double right = std::abs(product_2d(b - a, points_[x] - a));
    const double left = std::abs(product_2d(b - a, points_[y] - a));
    const double share = right + left > 0.0 ? right / (right + left) : 0.5;
    // The same point, whichever end comes first.
    const Vec2 p = share <= 0.5 ? points_[x] + share * (points_[y] - points_[x])
                                : points_[y] + (left / (right + left)) * (points_[x] - points_[y]);
    const std::uint32_t v = split_if_valid(h, p);
    if (v != kNone) return {v, false};
    const auto is_near = [&](std::uint32_t end) {
        return std::abs(points_[end].x - p.x) <= kRounding &&
               std::abs(points_[end].y - p.y) <= kRounding;
    };
    for (const std::uint32_t end : {x, y}) {
        if (is_near(end)) return {end, false};
    }
    return {remove_sliver(fits(h, p) ? twins_[h] : h) ? from : kNone, false};
}

/// Flips the longest edge of a triangle without area. If it is fixed, the two others, which are the
/// same up to rounding, take its place.
bool ConstrainedTriangulation::remove_sliver(std::uint32_t h) {
    const auto length2 = [&](std::uint32_t e) {
        const Vec2 along = points_[origins_[next(e)]] - points_[origins_[e]];
        return dot_2d(along, along);
    };
    for (const std::uint32_t e : {next(h), previous(h)}) {
        if (length2(e) > length2(h)) h = e;
    }
    if (twins_[h] == kNone) return false;
    if ((flags_[h] & kFixed) != 0) {
        const auto border = static_cast<std::uint8_t>(flags_[h] & kBorder);
        for (const std::uint32_t e : {next(h), previous(h)}) {
            flags_[e] = static_cast<std::uint8_t>((flags_[e] ^ border) | kFixed);
            if (twins_[e] != kNone) flags_[twins_[e]] = flags_[e];
        }
        flags_[h] = flags_[twins_[h]] = 0;
    }
    if (!can_flip(h)) return false;
    flip(h);
    return true;
}

/// Goes from one vertex towards another, up to a vertex on the way or a fixed edge.
ConstrainedTriangulation::Advance ConstrainedTriangulation::advance(std::uint32_t from,
                                                                    std::uint32_t to, bool flips) {
    const Vec2 a = points_[from], b = points_[to];
    const auto is_ahead = [&](std::uint32_t v) { return dot_2d(points_[v] - a, b - a) > 0.0; };
    std::uint32_t edge = kNone, met = kNone, crossing = kNone;
    visit_out(from, [&](std::uint32_t h) {
        const std::uint32_t x = origins_[next(h)], y = origins_[previous(h)];
        const int side_x = side(from, to, x), side_y = side(from, to, y);
        if (x == to || (side_x == 0 && is_ahead(x))) {
            edge = h, met = x;
        } else if (y == to || (side_y == 0 && is_ahead(y))) {
            edge = previous(h), met = y;
        } else if (side_x < 0 && side_y > 0) {
            crossing = next(h);
        }
        return edge != kNone || crossing != kNone;
    });
    if (edge != kNone) {
        toggle(edge);
        return {met, true};
    }
    if (crossing == kNone) return {kNone, false};
    std::vector<Edge> crossed;
    for (;;) {
        if (!flips || (flags_[crossing] & kFixed) != 0) return divide(from, to, crossing);
        const std::uint32_t twin = twins_[crossing];
        if (twin == kNone) return {kNone, false};
        crossed.push_back({origins_[crossing], origins_[twin]});
        const std::uint32_t z = origins_[previous(twin)];
        const int side_z = z == to ? 0 : side(from, to, z);
        if (side_z == 0) {
            if (!clear(from, z, std::move(crossed))) return {kNone, false};
            const std::uint32_t made = edge_between(from, z);
            if (made == kNone) return {kNone, false};
            toggle(made);
            return {z, true};
        }
        crossing = side_z > 0 ? next(twin) : previous(twin);
    }
}

void ConstrainedTriangulation::connect(std::uint32_t from, std::uint32_t to) {
    std::vector<std::uint32_t> targets{to};
    // Each round ends at a vertex on the way, or divides an edge.
    std::size_t rounds = 64 + 4 * triangle_count();
    while (!targets.empty()) {
        if (from == targets.back()) {
            targets.pop_back();
            continue;
        }
        Advance step{kNone, false};
        if (rounds > 0) {
            --rounds;
            step = advance(from, targets.back(), true);
            if (step.vertex == kNone) step = advance(from, targets.back(), false);
        }
        if (step.vertex == kNone) {
            connect_along_edges(from, targets.back());
            from = targets.back();
        } else if (step.reached) {
            from = step.vertex;
        } else {
            targets.push_back(step.vertex);
        }
    }
}

/// Makes borders of the shortest way along edges: so the borders stay closed where rounding leaves
/// no straight way.
void ConstrainedTriangulation::connect_along_edges(std::uint32_t from, std::uint32_t to) {
    struct Way {
        double length;
        std::uint32_t vertex, edge;
        bool operator<(const Way& other) const { return length > other.length; }
    };
    std::vector<std::uint32_t> back(points_.size(), kNone);  // [vertex] half-edge towards `to`
    std::priority_queue<Way> open;
    open.push({0.0, to, kNone});
    std::vector<bool> done(points_.size());
    while (!open.empty() && !done[from]) {
        const Way way = open.top();
        open.pop();
        if (done[way.vertex]) continue;
        done[way.vertex] = true;
        back[way.vertex] = way.edge;
        visit_out(way.vertex, [&](std::uint32_t h) {
            for (const std::uint32_t e : {h, previous(h)}) {
                const std::uint32_t v = e == h ? origins_[next(h)] : origins_[e];
                const Vec2 along = points_[v] - points_[way.vertex];
                if (!done[v]) open.push({way.length + std::sqrt(dot_2d(along, along)), v, e});
            }
            return false;
        });
    }
    for (std::uint32_t v = from; v != to && back[v] != kNone;) {
        const std::uint32_t e = back[v];
        toggle(e);
        v = origins_[e] == v ? origins_[next(e)] : origins_[e];
    }
}

std::uint32_t ConstrainedTriangulation::largest() const {
    std::uint32_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < triangle_count(); ++t) {
        const auto [a, b, c] = triangle(t);
        const double area = product_2d(points_[b] - points_[a], points_[c] - points_[a]);
        if (area > most) most = area, best = t;
    }
    return best;
}

std::vector<ConstrainedTriangulation::Triangle> ConstrainedTriangulation::triangles(
    std::uint32_t seed, bool even) const {
    enum : std::uint8_t { Unknown, Even, Odd };
    std::vector<std::uint8_t> parity(triangle_count(), Unknown);
    std::vector<std::uint32_t> open{seed};
    parity[seed] = Even;
    std::vector<Triangle> found;
    while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        if ((parity[t] == Even) == even) found.push_back(triangle(t));
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
            if (twins_[h] == kNone) continue;
            std::uint8_t& other = parity[twins_[h] / 3];
            if (other != Unknown) continue;
            const bool turns = (flags_[h] & kBorder) != 0;
            other = turns == (parity[t] == Even) ? Odd : Even;
            open.push_back(twins_[h] / 3);
        }
    }
    return found;
}

}  // namespace alhazen
