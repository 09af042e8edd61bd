#include "alhazen/math/odd_segments.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/math/orientation.h"

namespace alhazen {

namespace {

/// The coordinate that orders points on the segment.
double along(const PlaneSegment& s, Vec2 p) {
    return std::abs(s[1].x - s[0].x) >= std::abs(s[1].y - s[0].y) ? p.x : p.y;
}

struct Range {
    double lo, hi;
    Range(double a, double b) : lo(std::min(a, b)), hi(std::max(a, b)) {}
};
bool overlap(const Range& a, const Range& b) {
    return std::max(a.lo, b.lo) <= std::min(a.hi, b.hi);
}

class OddSegments {
  public:
    explicit OddSegments(std::span<const PlaneSegment> segments)
        : segments_(segments), shared_(segments.size()), cuts_(segments.size()) {}

    std::vector<SegmentPart> find() {
        find_shared();
        std::vector<SegmentPart> parts;
        for (std::uint32_t k = 0; k < segments_.size(); ++k) {
            if (shared_[k]) {
                divide(k, parts);
            } else {
                parts.push_back({k, 2 * k, 2 * k + 1});
            }
        }
        drop_pairs(parts);
        return parts;
    }

  private:
    [[nodiscard]] Vec2 end(std::uint32_t e) const { return segments_[e / 2][e % 2]; }
    [[nodiscard]] Range xs(std::uint32_t k) const { return {segments_[k][0].x, segments_[k][1].x}; }
    [[nodiscard]] Range ys(std::uint32_t k) const { return {segments_[k][0].y, segments_[k][1].y}; }

    /// Sweeps over x.
    void find_shared() {
        std::vector<std::uint32_t> order;
        for (std::uint32_t k = 0; k < segments_.size(); ++k) {
            if (!(segments_[k][0] == segments_[k][1])) order.push_back(k);
        }
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(xs(a).lo, a) < std::pair(xs(b).lo, b);
        });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const double last = xs(order[i]).hi;
            for (std::size_t j = i + 1; j < order.size() && xs(order[j]).lo <= last; ++j) {
                if (overlap(ys(order[i]), ys(order[j]))) compare(order[i], order[j]);
            }
        }
    }

    /// Notes what two segments share.
    void compare(std::uint32_t a, std::uint32_t b) {
        const PlaneSegment &s = segments_[a], &t = segments_[b];
        if (orientation(s[0], s[1], t[0]) != 0 || orientation(s[0], s[1], t[1]) != 0) return;
        const Range own(along(s, s[0]), along(s, s[1])), other(along(s, t[0]), along(s, t[1]));
        if (!(std::max(own.lo, other.lo) < std::min(own.hi, other.hi))) return;
        shared_[a] = shared_[b] = true;
        const auto cut = [&](std::uint32_t of, const Range& range, std::uint32_t by) {
            for (const std::uint32_t e : {2 * by, 2 * by + 1}) {
                const double at = along(s, end(e));
                if (at > range.lo && at < range.hi) cuts_[of].push_back(e);
            }
        };
        cut(a, own, b);
        cut(b, other, a);
    }

    /// Appends the parts of a segment.
    void divide(std::uint32_t k, std::vector<SegmentPart>& parts) {
        const PlaneSegment& s = segments_[k];
        const bool falls = along(s, s[1]) < along(s, s[0]);
        std::vector<std::uint32_t>& cuts = cuts_[k];
        std::sort(cuts.begin(), cuts.end(), [&](std::uint32_t a, std::uint32_t b) {
            const double at = along(s, end(a)), bt = along(s, end(b));
            return at != bt ? (at < bt) != falls : a < b;
        });
        std::uint32_t from = 2 * k;
        for (const std::uint32_t e : cuts) {
            if (end(e) == end(from)) continue;
            parts.push_back({k, from, e});
            from = e;
        }
        parts.push_back({k, from, 2 * k + 1});
    }

    /// Keeps one of an odd number of equal parts, and none of an even number.
    void drop_pairs(std::vector<SegmentPart>& parts) const {
        const auto key = [&](std::size_t i) {
            const Vec2 a = end(parts[i].from), b = end(parts[i].to);
            const std::pair one(a.x, a.y), two(b.x, b.y);
            return std::pair(std::min(one, two), std::max(one, two));
        };
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (shared_[parts[i].segment]) order.push_back(i);
        }
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(key(a), a) < std::pair(key(b), b);
        });
        std::vector<bool> dropped(parts.size());
        for (std::size_t i = 0, next = 0; i < order.size(); i = next) {
            while (next < order.size() && key(order[next]) == key(order[i])) ++next;
            for (std::size_t k = i + (next - i) % 2; k < next; ++k) dropped[order[k]] = true;
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (!dropped[i]) parts[kept++] = parts[i];
        }
        parts.resize(kept);
    }

    std::span<const PlaneSegment> segments_;
    std::vector<bool> shared_;                      ///< [segment] with others, in part
    std::vector<std::vector<std::uint32_t>> cuts_;  ///< [segment] ends of others within it
};

}  // namespace

std::vector<SegmentPart> odd_segments(std::span<const PlaneSegment> segments) {
    return OddSegments(segments).find();
}

}  // namespace alhazen
