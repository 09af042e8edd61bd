#include "alhazen/shapes/swept/profile_outline.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "alhazen/math/odd_segments.h"

namespace alhazen {

namespace {

bool is_finite(const Profile& profile) {
    return std::all_of(profile.curves.begin(), profile.curves.end(), [](const ProfileCurve& curve) {
        return std::all_of(curve.p.begin(), curve.p.end(),
                           [](const Vec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
    });
}

ProfileCurve reversed(const ProfileCurve& curve) {
    return {.p = {curve.p[3], curve.p[2], curve.p[1], curve.p[0]}, .line = curve.line};
}

/// The coordinates of the control points, in the direction in which they are less.
std::array<double, 8> undirected(const ProfileCurve& curve) {
    std::array<double, 8> there{}, back{};
    for (std::size_t i = 0; i < 4; ++i) {
        there[2 * i] = back[6 - 2 * i] = curve.p[i].x;
        there[2 * i + 1] = back[7 - 2 * i] = curve.p[i].y;
    }
    return std::min(there, back);
}

/// A curve that is left, and the number of the one that it is a part of.
struct OutlinePart {
    ProfileCurve curve;
    std::uint32_t of = 0;
};

/// Appends the first of every odd number of equal cubics.
void append_odd_cubics(const std::vector<ProfileCurve>& curves, std::vector<OutlinePart>& parts) {
    std::vector<std::pair<std::array<double, 8>, std::uint32_t>> cubics;
    for (std::uint32_t i = 0; i < curves.size(); ++i) {
        if (!curves[i].line) cubics.emplace_back(undirected(curves[i]), i);
    }
    std::sort(cubics.begin(), cubics.end());
    for (std::size_t i = 0, next = 0; i < cubics.size(); i = next) {
        while (next < cubics.size() && cubics[next].first == cubics[i].first) ++next;
        const std::uint32_t first = cubics[i].second;
        if ((next - i) % 2 != 0) parts.push_back({curves[first], first});
    }
}

/// Appends the parts of lines that an odd number of lines share. False: all of every line.
bool append_odd_lines(const std::vector<ProfileCurve>& curves, std::vector<OutlinePart>& parts) {
    std::vector<PlaneSegment> lines;
    std::vector<std::uint32_t> of;  // [line] its curve
    for (std::uint32_t i = 0; i < curves.size(); ++i) {
        if (!curves[i].line) continue;
        lines.push_back({curves[i].p[0], curves[i].p[3]});
        of.push_back(i);
    }
    const std::vector<SegmentPart> odd = odd_segments(lines);
    const auto end = [&](std::uint32_t e) { return lines[e / 2][e % 2]; };
    bool divided = odd.size() != lines.size();
    for (const SegmentPart& part : odd) {
        parts.push_back({line_curve(end(part.from), end(part.to)), of[part.segment]});
        divided = divided || part.from != 2 * part.segment || part.to != 2 * part.segment + 1;
    }
    return divided;
}

/// Joins curves in trails that close or join ends of other trails.
class Trails {
  public:
    explicit Trails(const std::vector<OutlinePart>& parts) : parts_(parts), used_(parts.size()) {
        for (std::uint32_t i = 0; i < parts.size(); ++i) {
            for (const std::uint32_t side : {0u, 1u}) ends_.push_back({at(i, side), i, side});
        }
        std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) {
            return std::tuple(a.at.x, a.at.y, a.side, a.part) <
                   std::tuple(b.at.x, b.at.y, b.side, b.part);
        });
    }

    Profile join() {
        // Trails that do not close begin where an odd number of curves meet.
        for (std::size_t i = 0, next = 0; i < ends_.size(); i = next) {
            while (next < ends_.size() && ends_[next].at == ends_[i].at) ++next;
            if ((next - i) % 2 != 0) follow(ends_[i].at);
        }
        for (std::uint32_t i = 0; i < parts_.size(); ++i) {
            if (!used_[i]) follow(at(i, 0));
        }
        return std::move(joined_);
    }

  private:
    struct End {
        Vec2 at;
        std::uint32_t part = 0, side = 0;
    };

    [[nodiscard]] Vec2 at(std::uint32_t part, std::uint32_t side) const {
        return parts_[part].curve.p[side == 0 ? 0 : 3];
    }

    /// Appends a trail that begins at a point; none if all curves there are used.
    void follow(Vec2 from) {
        const std::size_t before = joined_.curves.size();
        while (const std::optional<End> next = unused_at(from)) {
            used_[next->part] = true;
            const ProfileCurve& curve = parts_[next->part].curve;
            joined_.curves.push_back(next->side == 0 ? curve : reversed(curve));
            from = at(next->part, 1 - next->side);
        }
        if (joined_.curves.size() > before) {
            joined_.loop_ends.push_back(static_cast<std::uint32_t>(joined_.curves.size()));
        }
    }

    /// The end of a curve, if possible of one that begins there.
    [[nodiscard]] std::optional<End> unused_at(Vec2 p) const {
        auto end = std::lower_bound(ends_.begin(), ends_.end(), p, [](const End& a, const Vec2& b) {
            return std::pair(a.at.x, a.at.y) < std::pair(b.x, b.y);
        });
        for (; end != ends_.end() && end->at == p; ++end) {
            if (!used_[end->part]) return *end;
        }
        return std::nullopt;
    }

    const std::vector<OutlinePart>& parts_;
    std::vector<bool> used_;
    std::vector<End> ends_;  ///< sorted by place
    Profile joined_;
};

}  // namespace

void remove_shared_parts(Profile& profile) {
    if (!is_finite(profile)) return;
    std::vector<OutlinePart> parts;
    append_odd_cubics(profile.curves, parts);
    const bool divided = append_odd_lines(profile.curves, parts);
    if (!divided && parts.size() == profile.curves.size()) return;
    std::stable_sort(parts.begin(), parts.end(),
                     [](const OutlinePart& a, const OutlinePart& b) { return a.of < b.of; });
    const auto [lo, hi] = profile.bounds();
    profile = Trails(parts).join();
    if (!profile.curves.empty()) return;
    // Two points in place of an outline.
    profile.curves = {line_curve(lo, lo), line_curve(hi, hi)};
    profile.loop_ends = {1, 2};
}

}  // namespace alhazen
