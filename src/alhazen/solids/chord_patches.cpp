#include "alhazen/solids/chord_patches.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace alhazen {

namespace {

constexpr std::size_t kMostPatches = 64;
/// Least share of gaps along an axis of a patch that is divided.
constexpr double kLeastGaps = 0.5;

/// The gaps of intervals along an axis.
struct Gaps {
    double share = 0;   ///< of their hull that they leave free
    double widest = 0;  ///< width of the widest gap
    double middle = 0;  ///< of the widest gap
    Interval hull;
};

Gaps gaps_of(std::span<const Interval> intervals, std::vector<std::uint32_t>& members) {
    std::sort(members.begin(), members.end(),
              [&](std::uint32_t a, std::uint32_t b) { return intervals[a].lo < intervals[b].lo; });
    Gaps gaps;
    double free = 0, reach = intervals[members.front()].lo;
    for (const std::uint32_t i : members) {
        const double gap = intervals[i].lo - reach;
        if (gap > 0) free += gap;
        if (gap > gaps.widest) {
            gaps.widest = gap;
            gaps.middle = reach + 0.5 * gap;
        }
        reach = std::max(reach, intervals[i].hi);
    }
    gaps.hull = {intervals[members.front()].lo, reach};
    if (free > 0) gaps.share = free / gaps.hull.width();
    return gaps;
}

/// Parts and the gaps of their shadows.
struct Group {
    std::vector<std::uint32_t> members;
    Gaps right, up;

    Group(std::vector<std::uint32_t> parts, std::span<const Interval> along_right,
          std::span<const Interval> along_up)
        : members(std::move(parts)),
          right(gaps_of(along_right, members)),
          up(gaps_of(along_up, members)) {}

    [[nodiscard]] bool divides() const { return std::max(right.share, up.share) >= kLeastGaps; }
    /// Free area of the axis that would be divided.
    [[nodiscard]] double free() const {
        return right.hull.width() * up.hull.width() * std::max(right.share, up.share);
    }
};

}  // namespace

std::vector<ChordPatch> chord_patches(std::span<const Interval> right,
                                      std::span<const Interval> up) {
    std::vector<std::uint32_t> all(right.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<Group> groups;
    groups.emplace_back(std::move(all), right, up);
    while (groups.size() < kMostPatches) {
        const auto emptier = [](const Group& a, const Group& b) {
            return (a.divides() ? a.free() : -1) < (b.divides() ? b.free() : -1);
        };
        const auto found = std::max_element(groups.begin(), groups.end(), emptier);
        if (!found->divides()) break;
        const bool across = found->right.share >= found->up.share;
        const double middle = across ? found->right.middle : found->up.middle;
        const std::span<const Interval> along = across ? right : up;
        std::vector<std::uint32_t> below, above;
        for (const std::uint32_t i : found->members) {
            (along[i].lo < middle ? below : above).push_back(i);
        }
        if (below.empty() || above.empty()) break;  // rounding
        *found = Group(std::move(below), right, up);
        groups.emplace_back(std::move(above), right, up);
    }
    std::vector<ChordPatch> patches;
    for (const Group& group : groups) patches.push_back({group.right.hull, group.up.hull});
    return patches;
}

}  // namespace alhazen
