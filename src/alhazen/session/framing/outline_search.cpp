#include "alhazen/session/framing/outline_search.h"

#include "alhazen/math/unit_vector.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

constexpr int kRows = 64, kColumns = 256;
/// The window of a climb, and limits of the number of climbs and their steps.
constexpr int kClimbRows = 8, kClimbColumns = 48;
constexpr int kMostClimbs = 8, kMostSteps = 60;
/// Precision of the heights found, relative to the box.
constexpr double kPrecision = 1e-5;

/// Half the extent of a box along a unit vector.
double half_span(const Box3& box, const Vec3& along) {
    return 0.5 * dot(abs(along), box.size());
}

/// `count` columns, evenly spread about the middle.
std::vector<double> spread(double middle, double reach, int count) {
    std::vector<double> columns;
    for (int i = 0; i < count; ++i) {
        columns.push_back(middle + reach * (2.0 * (i + 0.5) / count - 1.0));
    }
    return columns;
}

}  // namespace

OutlineSearch::OutlineSearch(const Box3& box, const Vec3& direction, Shoot shoot)
    : shoot_(std::move(shoot)),
      center_(box.center()),
      scale_(length(direction)),
      up_(unit_or(direction, {0, 0, 1})),
      across_(perpendicular(up_)),
      along_(cross(up_, across_)),
      reach_up_(half_span(box, up_)),
      reach_across_(half_span(box, across_)),
      reach_along_(half_span(box, along_)) {}

OutlineSearch::Row OutlineSearch::shoot_row(double height,
                                            const std::vector<double>& columns) const {
    constexpr std::size_t kGrain = 32;
    const double unit = reach_up_ + reach_across_ + reach_along_;
    std::vector<std::optional<double>> found(columns.size());
    const auto ray_of = [&](double column) {
        const Vec3 middle = center_ + height * up_ + column * across_;
        return Ray{middle - (1.5 * reach_along_ + 1e-3 * unit) * along_, along_};
    };
    parallel_for(columns.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) found[i] = shoot_(ray_of(columns[i]));
    });
    Row row;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (!found[i]) continue;
        row.columns.push_back(columns[i]);
        row.points.push_back(ray_of(columns[i]).at(*found[i]));
    }
    return row;
}

OutlineSearch::Top OutlineSearch::climb(Top top, double reach, double room) const {
    for (int step = 0; step < kMostSteps && room > kPrecision * reach_up_; ++step) {
        const std::vector<double> columns = spread(top.column, reach, kClimbColumns);
        const double spacing = 2.0 * reach / kClimbColumns;
        Row row;
        int k = kClimbRows;
        for (; k > 0 && row.columns.empty(); --k) {
            row = shoot_row(top.height + room * k / kClimbRows, columns);
        }
        if (row.columns.empty()) {
            room /= kClimbRows;
            reach = std::max(0.5 * reach, 2.0 * room);
            continue;
        }
        // The loop decremented `k` after the row that hit.
        const std::size_t middle = row.columns.size() / 2;
        top = {row.columns[middle], top.height + room * (k + 1) / kClimbRows, row.points[middle]};
        const bool at_border = k + 1 == kClimbRows || row.columns.front() < columns[1] ||
                               row.columns.back() > columns[kClimbColumns - 2];
        if (at_border) continue;
        room /= kClimbRows;
        reach = 0.5 * (row.columns.back() - row.columns.front()) + 2.0 * (spacing + room);
    }
    return top;
}

std::optional<Vec3> OutlineSearch::farthest(double least) const {
    if (!(scale_ > 0) || !(reach_up_ >= 0) || !std::isfinite(scale_ * reach_up_)) return {};
    // Heights are relative to the middle of the box.
    const double bottom = std::max(least / scale_ - dot(up_, center_), -reach_up_);
    const double highest = (1.0 - 0x1p-20) * reach_up_;
    const double step = 2.0 * reach_up_ / kRows, spacing = 2.0 * reach_across_ / kColumns;
    const std::vector<double> columns = spread(0, reach_across_, kColumns);
    double height = highest;
    Row row;
    while (height > bottom && row.columns.empty()) {
        row = shoot_row(height, columns);
        if (row.columns.empty()) height -= step;
    }
    // The last step, less than a row.
    if (row.columns.empty()) {
        height = bottom;
        row = shoot_row(height, columns);
        if (row.columns.empty()) return {};
    }
    const std::size_t hits = row.columns.size();
    Top best{row.columns[hits / 2], height, row.points[hits / 2]};
    // The solid reaches the end of its box.
    if (height == highest) return best.point;
    int climbs = 0;
    for (std::size_t begin = 0, end; begin < hits && climbs < kMostClimbs; begin = end, ++climbs) {
        for (end = begin + 1; end < hits; ++end) {
            if (row.columns[end] - row.columns[end - 1] > 1.5 * spacing) break;
        }
        const std::size_t middle = (begin + end) / 2;
        const double reach = 0.5 * (row.columns[end - 1] - row.columns[begin]) + 2.0 * spacing;
        const Top top =
            climb({row.columns[middle], height, row.points[middle]}, reach + step, step);
        if (top.height > best.height) best = top;
    }
    return best.point;
}

}  // namespace alhazen
