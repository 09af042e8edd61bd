#include "alhazen/solids/spans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "alhazen/geometry/ray_scale.h"
#include "alhazen/math/constants.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

constexpr std::size_t kRaysPerTask = 256;

/// Sorts crossings by solid; those of one solid keep their order along the line.
void sort_by_solid(std::vector<SpanList::Crossing>& crossings) {
    std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) {
        return a.solid != b.solid ? a.solid < b.solid : a.hit < b.hit;
    });
}

/// Finds all crossings of the whole line with solids, sorted by solid.
void cross_line(const SolidList& solids, const Ray& ray, SpanList& list) {
    Ray line = ray;
    line.t_min = -kInfinity;
    line.t_max = kInfinity;
    list.hits.clear();
    list.crossings.clear();
    list.inside_at_start.clear();
    list.end_is_known = false;
    solids.aggregate().all_hits(line, list.hits, nullptr);
    for (std::uint32_t i = 0; i < list.hits.size(); ++i) {
        if (const auto solid = solids.solid_of(list.hits[i])) list.crossings.push_back({*solid, i});
    }
    sort_by_solid(list.crossings);
    solids.inside_at_minus_infinity(line, list.inside_at_start);
    std::sort(list.inside_at_start.begin(), list.inside_at_start.end());
}

bool has(const std::vector<SolidId>& sorted, SolidId solid) {
    return std::binary_search(sorted.begin(), sorted.end(), solid);
}

/// True if the line ends (t = +inf) inside the solid; tests the beginning of the reversed line.
/// Rarely called.
bool ends_inside(const SolidList& solids, const Ray& ray, SolidId solid, SpanList& list) {
    if (!list.end_is_known) {
        list.inside_at_end.clear();
        solids.inside_at_minus_infinity({ray.origin, -ray.direction, -kInfinity, kInfinity},
                                        list.inside_at_end);
        std::sort(list.inside_at_end.begin(), list.inside_at_end.end());
        list.end_is_known = true;
    }
    return has(list.inside_at_end, solid);
}

/// Pairs the crossings of one solid to spans.
class Pairer {
  public:
    Pairer(const SolidList& solids, const Ray& ray, SpanList& list)
        : solids_(solids), ray_(ray), list_(list) {}

    /// `begin`, `end`: index range of the solid's crossings.
    void pair(SolidId solid, std::size_t begin, std::size_t end) {
        bool inside = has(list_.inside_at_start, solid);
        const bool began_inside = inside;
        entry_ = {-kInfinity, false, {}};
        first_ = list_.spans.size();
        for (std::size_t i = begin; i < end; ++i) {
            const Hit& hit = list_.hits[list_.crossings[i].hit];
            if (inside) {
                close(solid, {hit.t, true, hit});
            } else {
                entry_ = {hit.t, true, hit};
            }
            inside = !inside;
        }
        if ((inside || began_inside) && inside != ends_inside(solids_, ray_, solid, list_)) {
            list_.spans.resize(first_);
            list_.inconsistent.push_back(solid);
            return;
        }
        if (inside) close(solid, {kInfinity, false, {}});
        clip();
    }

  private:
    /// Adds the span from entry_ to `exit`, unless they are one point, where the line only touches
    /// the surface.
    void close(SolidId solid, const SpanEnd& exit) {
        if (is_one_point(entry_, exit)) return;
        if (list_.spans.size() > first_ && is_one_point(list_.spans.back().exit, entry_)) {
            list_.spans.back().exit = exit;
        } else {
            list_.spans.push_back({solid, entry_, exit});
        }
    }

    /// True if two crossings, a before b, coincide within rounding.
    [[nodiscard]] bool is_one_point(const SpanEnd& a, const SpanEnd& b) const {
        if (a.t == b.t) return true;
        const double gap = b.t - a.t;
        const double reach = std::max(std::abs(a.t), std::abs(b.t));
        // Far above any error bound; decides nearly all pairs.
        const double far = 1e-9 * (reach + length(ray_.origin) / length(ray_.direction));
        if (!(gap <= far) || !a.is_crossing || !b.is_crossing) return false;
        const Vec3 margin = surface_at(solids_.aggregate(), ray_, a.hit).error +
                            surface_at(solids_.aggregate(), ray_, b.hit).error;
        return gap * length(ray_.direction) <= length(margin);
    }

    /// Clips the spans of the solid to the limits of the ray.
    void clip() {
        std::size_t kept = first_;
        for (std::size_t i = first_; i < list_.spans.size(); ++i) {
            SolidSpan span = list_.spans[i];
            if (span.entry.t < ray_.t_min) span.entry = {ray_.t_min, false, {}};
            if (span.exit.t > ray_.t_max) span.exit = {ray_.t_max, false, {}};
            if (span.entry.t < span.exit.t) list_.spans[kept++] = span;
        }
        list_.spans.resize(kept);
    }

    const SolidList& solids_;
    const Ray& ray_;
    SpanList& list_;
    SpanEnd entry_;
    std::size_t first_ = 0;
};

/// The hits that the end of a span (`side` -1: the entry, 1: the exit) may stand for, as its t left
/// the range of double: in the units of the rescaled ray, the nearest first.
std::vector<Hit> same_ends(const SolidQueries& queries, const Ray& usual, int exponent,
                           const SpanEnd& end, double side) {
    SpanList list;
    queries.spans(usual, list);
    std::vector<Hit> same;
    for (const SolidSpan& span : list.spans) {
        const SpanEnd& other = side < 0.0 ? span.entry : span.exit;
        const Hit &a = other.hit, &b = end.hit;
        if (other.is_crossing && a.primitive == b.primitive && a.path == b.path &&
            a.part == b.part && a.u == b.u && a.v == b.v &&
            std::ldexp(other.t, -exponent) == end.t) {
            same.push_back(a);
        }
    }
    return same;
}

/// Directions of the lines through a point: near the diagonals of a cube, so that one of them
/// enters any octant or quadrant along the axes.
constexpr std::array<Vec3, 12> kLines{{{1.0, 0.91374, 1.10353},
                                       {-1.0, 1.08827, 0.92173},
                                       {1.0, -1.13131, 0.94721},
                                       {1.0, 0.95873, -1.05317},
                                       {0.12137, 1.0, 0.31771},
                                       {1.0, 0.23719, -0.17093},
                                       {-0.27191, 0.14723, 1.0},
                                       {0.61333, -0.33911, 1.0},
                                       {1.0, 0.57721, 0.38197},
                                       {-0.41421, 1.0, -0.73205},
                                       {0.83147, 1.0, -0.19509},
                                       {1.0, -0.29028, -0.92387}}};
constexpr int kUsualLines = 4;

/// Votes of the lines through a point about one solid.
struct Votes {
    int inside = 0;
    int undecided = 0;  ///< lines whose crossings do not come in pairs
    bool on_surface = false;
};

class PointLocator {
  public:
    PointLocator(const SolidList& solids, const Vec3& point) : solids_(solids), point_(point) {}

    std::vector<Containment> run() {
        int lines = 0;
        for (const Vec3& direction : kLines) {
            if (lines >= kUsualLines && all_agree(lines)) break;
            look_along(direction);
            ++lines;
        }
        std::vector<Containment> found;
        for (const auto& [solid, v] : votes_) {
            const int outside = lines - v.undecided - v.inside;
            if (v.on_surface || v.inside > outside) found.push_back({solid, v.on_surface});
        }
        return found;
    }

  private:
    [[nodiscard]] bool all_agree(int lines) const {
        return std::all_of(votes_.begin(), votes_.end(), [&](const auto& entry) {
            const Votes& v = entry.second;
            return v.on_surface || (v.undecided == 0 && (v.inside == 0 || v.inside == lines));
        });
    }

    void look_along(const Vec3& direction) {
        const Ray ray{point_, direction, -kInfinity, kInfinity};
        cross_line(solids_, ray, list_);
        for (const SolidId solid : list_.inside_at_start) votes_.try_emplace(solid);
        for (const auto& crossing : list_.crossings) votes_.try_emplace(crossing.solid);
        for (auto& [solid, v] : votes_) count(ray, solid, v);
    }

    void count(const Ray& ray, SolidId solid, Votes& v) {
        const auto& all = list_.crossings;
        const auto [begin, end] =
            std::equal_range(all.begin(), all.end(), SpanList::Crossing{solid, 0},
                             [](const auto& a, const auto& b) { return a.solid < b.solid; });
        const bool begins = has(list_.inside_at_start, solid);
        bool inside = begins;
        const Hit* nearest = nullptr;
        for (auto crossing = begin; crossing != end; ++crossing) {
            const Hit& hit = list_.hits[crossing->hit];
            if (hit.t < 0.0) inside = !inside;
            if (nearest == nullptr || std::abs(hit.t) < std::abs(nearest->t)) nearest = &hit;
        }
        if (nearest != nullptr && is_at_point(ray, *nearest)) v.on_surface = true;
        const bool ends = begins != ((end - begin) % 2 != 0);
        if ((ends || begins) && ends != ends_inside(solids_, ray, solid, list_)) {
            ++v.undecided;
        } else {
            v.inside += inside;
        }
    }

    [[nodiscard]] bool is_at_point(const Ray& ray, const Hit& hit) const {
        const Surface surface = surface_at(solids_.aggregate(), ray, hit);
        // Intersections with the line lie up to twice as far away as the surface, along the line's
        // own direction: the bounds of the three components add up.
        const Vec3 margin = surface.error + 0x1p-52 * abs(point_);
        return length_squared(surface.point - point_) <= 4.0 * length_squared(margin);
    }

    const SolidList& solids_;
    const Vec3 point_;
    SpanList list_;
    std::map<SolidId, Votes> votes_;
};

}  // namespace

void SolidQueries::spans(const Ray& ray, SpanList& list) const {
    list.spans.clear();
    list.inconsistent.clear();
    if (!is_valid(ray)) return;
    const int exponent = unusual_exponent(ray.direction);
    if (exponent != 0) {
        spans(rescaled(ray, exponent), list);
        for (SolidSpan& span : list.spans) {
            for (SpanEnd* end : {&span.entry, &span.exit}) {
                end->t = end->hit.t = std::ldexp(end->t, -exponent);
            }
        }
        return;
    }
    cross_line(solids_, ray, list);
    Pairer pairer(solids_, ray, list);
    // Solids that contain the whole line have no crossing.
    std::size_t begin = 0;
    std::size_t start = 0;
    const auto& crossings = list.crossings;
    while (begin < crossings.size() || start < list.inside_at_start.size()) {
        const bool crossed =
            begin < crossings.size() && (start == list.inside_at_start.size() ||
                                         crossings[begin].solid <= list.inside_at_start[start]);
        const SolidId solid = crossed ? crossings[begin].solid : list.inside_at_start[start];
        std::size_t end = begin;
        while (end < crossings.size() && crossings[end].solid == solid) ++end;
        if (start < list.inside_at_start.size() && list.inside_at_start[start] == solid) ++start;
        pairer.pair(solid, begin, end);
        begin = end;
    }
    std::sort(list.spans.begin(), list.spans.end(), [](const SolidSpan& a, const SolidSpan& b) {
        return a.entry.t != b.entry.t ? a.entry.t < b.entry.t : a.solid < b.solid;
    });
}

SpanSurface SolidQueries::entry_surface(const Ray& ray, const SolidSpan& span) const {
    return surface(ray, span.entry, -1.0);
}
SpanSurface SolidQueries::exit_surface(const Ray& ray, const SolidSpan& span) const {
    return surface(ray, span.exit, 1.0);
}

SpanSurface SolidQueries::surface(const Ray& ray, const SpanEnd& end, double side) const {
    SpanSurface found;
    if (!end.is_crossing) {
        found.point = ray.at(end.t);
        return found;
    }
    const int exponent = unusual_exponent(ray.direction);
    const Ray usual = exponent == 0 ? ray : rescaled(ray, exponent);
    Hit hit = end.hit;
    hit.t = std::ldexp(hit.t, exponent);
    std::vector<Hit> same;
    if (exponent != 0 && !keeps_digits(end.t)) {
        same = same_ends(*this, usual, exponent, end, side);
        if (!same.empty()) hit = same.front();
    }
    Surface surface = surface_at(solids_.aggregate(), usual, hit);
    for (const Hit& other : same) {
        const Vec3 point = surface_at(solids_.aggregate(), usual, other).point;
        surface.error += abs(point - surface.point);
    }
    if (exponent != 0 && !keeps_digits(end.t) && same.empty()) {
        surface.error = {kInfinity, kInfinity, kInfinity};
    }
    found.point = surface.point;
    // A mesh may be wound inside out; the order of crossings is reliable.
    const bool as_wound = side * dot(surface.normal, usual.direction) >= 0.0;
    found.normal = as_wound ? surface.normal : -surface.normal;
    found.error = surface.error;
    found.material = surface.materials[0];
    return found;
}

Thickness SolidQueries::thickness(const Ray& given, SpanList& scratch) const {
    const Ray ray = rescaled(given, unusual_exponent(given.direction));
    spans(ray, scratch);
    Thickness sum;
    const double scale = length(ray.direction);
    double covered = -kInfinity;
    for (const SolidSpan& span : scratch.spans) {
        const double from = std::max(covered, span.entry.t);
        if (span.exit.t > from) {
            sum.inside_any += scale * (span.exit.t - from);
            covered = span.exit.t;
        }
        sum.of_solid.push_back({span.solid, scale * (span.exit.t - span.entry.t)});
    }
    auto& list = sum.of_solid;
    std::stable_sort(list.begin(), list.end(),
                     [](const auto& a, const auto& b) { return a.solid < b.solid; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (kept > 0 && list[kept - 1].solid == list[i].solid) {
            list[kept - 1].length += list[i].length;
        } else {
            list[kept++] = list[i];
        }
    }
    list.resize(kept);
    return sum;
}

std::vector<Containment> SolidQueries::inside(const Vec3& point) const {
    if (!is_finite(point)) return {};
    return PointLocator(solids_, point).run();
}

void SolidQueries::spans(std::span<const Ray> rays, SpanLists& lists) const {
    lists = {};
    if (rays.empty()) return;
    const std::size_t tasks = (rays.size() + kRaysPerTask - 1) / kRaysPerTask;
    std::vector<SpanLists> parts(tasks);
    parallel_for(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
        SpanLists& part = parts[begin / kRaysPerTask];
        SpanList list;
        for (std::size_t i = begin; i < end; ++i) {
            spans(rays[i], list);
            part.spans.insert(part.spans.end(), list.spans.begin(), list.spans.end());
            part.ends.push_back(part.spans.size());
            part.inconsistent += list.inconsistent.size();
        }
    });
    for (const SpanLists& part : parts) {
        const std::size_t before = lists.spans.size();
        lists.spans.insert(lists.spans.end(), part.spans.begin(), part.spans.end());
        for (const std::size_t end : part.ends) lists.ends.push_back(before + end);
        lists.inconsistent += part.inconsistent;
    }
}

std::vector<std::vector<Containment>> SolidQueries::inside(std::span<const Vec3> points) const {
    std::vector<std::vector<Containment>> found(points.size());
    if (points.empty()) return found;
    parallel_for(points.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) found[i] = inside(points[i]);
    });
    return found;
}

std::vector<Thickness> SolidQueries::thickness(std::span<const Ray> rays) const {
    std::vector<Thickness> found(rays.size());
    if (rays.empty()) return found;
    parallel_for(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
        SpanList scratch;
        for (std::size_t i = begin; i < end; ++i) found[i] = thickness(rays[i], scratch);
    });
    return found;
}

}  // namespace alhazen
