#include "alhazen/solids/stratified_chords.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/sampling/random.h"
#include "alhazen/solids/chord_patches.h"

namespace alhazen {

namespace {

constexpr std::size_t kCellsPerTask = 256;
/// Share of cells that are cut for their size alone, whatever the survey saw, so that features too
/// small to be seen at once are found later; at least.
constexpr double kCutForSize = 0.15;
/// The same share if hardly any line misses: the survey did not see the empty corners.
constexpr double kCutForSizeIfFull = 0.75;
/// From this many misses on, they show in the variance.
constexpr std::uint64_t kEnoughMisses = 10;
/// Survey lines per cell: one in the middle, six on a hexagon around it; the hexagon's radius is up
/// to this many halves of the cell's side.
constexpr std::uint64_t kSurveyLines = 7;
constexpr double kLeastSurveyRadius = 1.1, kMostSurveyRadius = 1.7;
/// Growth of the number of cells between surveys, and after the last one.
constexpr double kSurveyGrowth = 1.5, kLastGrowth = 2;
/// Weight of the variance that a quarter inherits if it was surveyed itself: seven lines may miss a
/// feature.
constexpr float kWeightOfGuess = 0.1f;

/// Rule of three: the share of an event that never came in n trials is below 3/n in 95 of 100
/// cases.
constexpr double kRuleOfThree = 3.0;

/// Adds the span a < t < b of the line o + t d, |d| = 1, with a weight.
void add_span(const Vec3& o, const Vec3& d, double a, double b, double weight, Moments& m) {
    const double l0 = weight * (b - a);
    const double l1 = l0 * (0.5 * (a + b));
    const double l2 = l0 * (a * a + a * b + b * b) / 3.0;
    m.volume += l0;
    m.ends += 2 * weight;
    m.first += l0 * o + l1 * d;
    const auto second = [&](int i, int k) {
        return l0 * o[i] * o[k] + l1 * (o[i] * d[k] + d[i] * o[k]) + l2 * d[i] * d[k];
    };
    m.second[0] += second(0, 0);
    m.second[1] += second(1, 1);
    m.second[2] += second(2, 2);
    m.second[3] += second(0, 1);
    m.second[4] += second(1, 2);
    m.second[5] += second(2, 0);
}

}  // namespace

Moments& Moments::operator+=(const Moments& other) {
    volume += other.volume;
    first += other.first;
    for (std::size_t i = 0; i < second.size(); ++i) second[i] += other.second[i];
    cosines += other.cosines;
    ends += other.ends;
    measured += other.measured;
    return *this;
}

Moments Moments::operator*(double factor) const {
    Moments m = *this;
    m.volume *= factor;
    m.first = factor * m.first;
    for (double& x : m.second) x *= factor;
    m.cosines *= factor;
    m.ends *= factor;
    m.measured *= factor;
    return m;
}

StratifiedChords::Sums& StratifiedChords::Sums::operator+=(const Sums& other) {
    all += other.all;
    for (std::size_t i = 0; i < differences.size(); ++i) differences[i] += other.differences[i];
    squares += other.squares;
    fourths += other.fourths;
    inconsistent += other.inconsistent;
    misses += other.misses;
    lines += other.lines;
    return *this;
}

StratifiedChords::StratifiedChords(const Measurable& solid, const BundleFrame& frame,
                                   const Vec3& center, std::uint64_t key, Measured measured)
    : solid_(solid), frame_(frame), center_(center), key_(mix64(key)), measured_(measured) {
    const auto range = [&](const Vec3& axis) {
        const Interval extent = solid.extent(axis);
        const double shift = dot(axis, center);
        return Interval{extent.lo - shift, extent.hi - shift};
    };
    right_ = range(frame.right);
    up_ = range(frame.up);
    scale_ = measured == Measured::Area ? 1.0 : length(solid.box().size());
    cells_ = shadow();
}

ChordCells StratifiedChords::shadow() const {
    std::vector<Interval> along_right, along_up;
    solid_.part_extents(frame_.right, along_right);
    solid_.part_extents(frame_.up, along_up);
    std::vector<ChordPatch> found;
    const auto is_unbounded = [](const Interval& range) {
        return !(std::isfinite(range.lo) && std::isfinite(range.hi) && range.lo <= range.hi);
    };
    if (std::none_of(along_right.begin(), along_right.end(), is_unbounded) &&
        std::none_of(along_up.begin(), along_up.end(), is_unbounded) && !along_right.empty()) {
        found = chord_patches(along_right, along_up);
    }
    if (found.size() < 2) return ChordCells();
    // A patch's width as float, rounded up: its halves are exact.
    const auto place = [](const Interval& range, const Interval& whole, double shift, double& at,
                          float& width) {
        constexpr float kInfinite = std::numeric_limits<float>::infinity();
        at = (range.lo - shift - whole.lo) / whole.width();
        width = std::nextafter(static_cast<float>(range.width() / whole.width()), kInfinite);
    };
    std::vector<ChordCells::Patch> patches;
    for (const ChordPatch& patch : found) {
        ChordCells::Patch& p = patches.emplace_back();
        place(patch.right, right_, dot(frame_.right, center_), p.x, p.width);
        place(patch.up, up_, dot(frame_.up, center_), p.y, p.height);
    }
    return ChordCells(std::move(patches));
}

std::uint64_t StratifiedChords::grow_to(std::uint64_t lines) {
    const auto cells = static_cast<std::size_t>(lines / kLinesPerCell);
    const std::uint64_t before = surveyed_;
    if (cells_.size() == 0) cells_.make_grid(cells);
    if (cells > cells_.size()) {
        const auto last = static_cast<std::size_t>(double(cells) / kLastGrowth);
        for (;;) {
            survey();
            if (cells_.size() >= last) break;
            cells_.cut(
                std::min(last, static_cast<std::size_t>(kSurveyGrowth * double(cells_.size()))),
                share_for_size());
        }
        cells_.cut(cells, share_for_size());
        sums_ = {};
        casts_ = 0;
    }
    cast();
    return lines_of_round() + surveyed_ - before;
}

/// Sums of f(cell, its number, scratch, sums), in an order independent of the number of threads.
template <class F>
StratifiedChords::Sums StratifiedChords::over_cells(F&& f) {
    const std::size_t tasks = (cells_.size() + kCellsPerTask - 1) / kCellsPerTask;
    std::vector<Sums> parts(tasks);
    parallel_for(tasks, 1, [&](std::size_t begin, std::size_t end) {
        LineSpans found;
        for (std::size_t task = begin; task < end; ++task) {
            const std::size_t first = task * kCellsPerTask;
            const std::size_t last = std::min(cells_.size(), first + kCellsPerTask);
            for (std::size_t i = first; i < last; ++i) {
                interruption_point();
                f(cells_.all()[i], i, found, parts[task]);
            }
        }
    });
    // In pairs: the rounding grows with the logarithm of the number of parts.
    for (std::size_t step = 1; step < tasks; step *= 2) {
        for (std::size_t i = 0; i + step < tasks; i += 2 * step) parts[i] += parts[i + step];
    }
    const Sums sums = parts.empty() ? Sums{} : parts.front();
    inconsistent_ += sums.inconsistent;
    missed_ += sums.misses;
    ++rounds_;
    return sums;
}

/// Surveys the cells not surveyed yet.
void StratifiedChords::survey() {
    const Sums sums =
        over_cells([&](ChordCell& cell, std::uint64_t number, LineSpans& found, Sums& part) {
            if (cell.surveyed) return;
            survey_cell(cell, mix64(key_ ^ mix64(rounds_ << 40 | number)), found, part);
            part.lines += kSurveyLines;
        });
    surveyed_ += sums.lines;
}

/// The curvature, from a hexagon around the middle. Its difference from the curvature of the parent
/// cell measures how far the function is from a parabola, in both.
void StratifiedChords::survey_cell(ChordCell& cell, std::uint64_t bits, LineSpans& found,
                                   Sums& sums) const {
    const double half_x = 0.5 * cell.width, half_y = 0.5 * cell.height;
    const double mx = cell.x + half_x, my = cell.y + half_y;
    bool is_beyond = false;
    const auto value = [&](double x, double y) {
        // The solid touches the sides of its shadow's rectangle: beyond them is nothing.
        if (!(0 <= x && x <= 1 && 0 <= y && y <= 1)) {
            is_beyond = true;
            return 0.0;
        }
        cast_line(x, y, found, sums);
        if (measured_ == Measured::Area) return found.cosines;
        double sum = 0;
        for (const Interval& span : found.spans) sum += span.hi - span.lo;
        return sum / scale_;
    };
    constexpr double kThird = 1.04719755119659775;  // of half a turn
    const double u = static_cast<double>(bits >> 32) * 0x1p-32;
    const double v = static_cast<double>(bits & 0xffffffffu) * 0x1p-32;
    const double radius = kLeastSurveyRadius + v * (kMostSurveyRadius - kLeastSurveyRadius);
    const double middle = value(mx, my);
    double mean = 0, even = 0, slant = 0, odd = 0;
    for (int k = 0; k < 3; ++k) {
        const double angle = (u + k) * kThird;
        const double c = radius * std::cos(angle), s = radius * std::sin(angle);
        const double there = value(mx + half_x * c, my + half_y * s);
        const double opposite = value(mx - half_x * c, my - half_y * s);
        // Along this direction: xx c^2 + 2 xy c s + yy s^2
        const double second = (there + opposite - 2 * middle) / (radius * radius);
        mean += second / 3;
        even += second * (c * c - s * s) / (1.5 * radius * radius);
        slant += second * 2 * c * s / (1.5 * radius * radius);
        odd += (k == 1 ? -1 : 1) * (there - opposite) / (2 * radius * radius);
    }
    const ChordCell::Curvature before = cell.curvature;
    const double xx = mean + even, yy = mean - even;
    const auto squared = [](double a, double b, double c) { return a * a + 2 * b * b + c * c; };
    const double size = squared(xx, slant, yy);
    const double off =
        cell.quarter ? squared(xx - before[0], slant - before[1], yy - before[2]) : size;
    cell.curvature = {float(xx), float(slant), float(yy)};
    const bool is_model = off < size && !is_beyond;
    cell.trust = is_model ? static_cast<float>(1 - off / size) : 0.0f;
    const double area = cell.area();
    const auto seen = static_cast<float>((off + odd * odd) * area * area / 80);
    const float guess = cell.quarter ? seen + kWeightOfGuess * (cell.scatter - seen) : seen;
    // Cells are sorted by this value; a NaN would break the order.
    cell.scatter = std::isfinite(guess) ? guess : 0;
    cell.surveyed = true;
}

void StratifiedChords::cast() {
    sums_ += over_cells([&](ChordCell& cell, std::uint64_t number, LineSpans& found, Sums& part) {
        cast_in(cell, number, found, part);
    });
    ++casts_;
}

void StratifiedChords::cast_in(ChordCell& cell, std::uint64_t number, LineSpans& found,
                               Sums& sums) const {
    std::uint64_t bits = mix64(key_ ^ mix64(rounds_ << 40 | number));
    // Any row but the constant one.
    const std::size_t row = 1 + bits % (kReplicates - 1);
    Moments pairs[2];
    for (Moments& pair : pairs) {
        bits = mix64(bits);
        cast_pair(cell, bits, found, pair, sums);
    }
    sums.all += pairs[0];
    sums.all += pairs[1];
    sums.differences[row] += pairs[0];
    sums.differences[row] += pairs[1] * -1.0;
    const double difference = (pairs[0].measured - pairs[1].measured) / scale_;
    const double square = difference * difference;
    sums.squares += square;
    sums.fourths += square * square;
}

/// Two lines opposite each other about the middle of the cell.
void StratifiedChords::cast_pair(const ChordCell& cell, std::uint64_t bits, LineSpans& found,
                                 Moments& pair, Sums& sums) const {
    const double weight = cell.area() / kLinesPerCell;
    const double half_x = 0.5 * cell.width, half_y = 0.5 * cell.height;
    const double u = (static_cast<double>(bits >> 32) + 0.5) * 0x1p-31 - 1;
    const double v = (static_cast<double>(bits & 0xffffffffu) + 0.5) * 0x1p-31 - 1;
    for (const double side : {1.0, -1.0}) {
        const Vec3 offset = cast_line(cell.x + half_x * (1 + side * u),
                                      cell.y + half_y * (1 + side * v), found, sums);
        for (const Interval& span : found.spans) {
            add_span(offset, frame_.d, span.lo, span.hi, weight, pair);
        }
        pair.cosines += weight * found.cosines;
    }
    // The model minus its mean over the cell, for both lines.
    const ChordCell::Curvature& c = cell.curvature;
    const double model = c[0] * (u * u - 1.0 / 3) + 2 * c[1] * u * v + c[2] * (v * v - 1.0 / 3);
    pair.measured = (measured_ == Measured::Area ? pair.cosines : pair.volume) -
                    weight * scale_ * cell.trust * model;
}

Vec3 StratifiedChords::cast_line(double x, double y, LineSpans& found, Sums& sums) const {
    const Vec3 offset =
        (right_.lo + right_.width() * x) * frame_.right + (up_.lo + up_.width() * y) * frame_.up;
    solid_.cross({center_ + offset, frame_.d}, measured_ == Measured::Area, found);
    sums.inconsistent += found.consistent ? 0 : 1;
    sums.misses += found.consistent && found.spans.empty() ? 1 : 0;
    return offset;
}

double StratifiedChords::share_for_size() const {
    return missed_ < kEnoughMisses ? kCutForSizeIfFull : kCutForSize;
}

double StratifiedChords::sparsest() const {
    double largest = 0;
    for (const ChordCell& c : cells_.all()) largest = std::max(largest, c.area());
    return static_cast<double>(casts_ * kLinesPerCell) * cells_.covered() / largest;
}

double StratifiedChords::unseen_shadow() const {
    if (sums_.all.ends > 0) return 0;
    return kRuleOfThree / sparsest() * cells_.covered() * right_.width() * up_.width();
}

double StratifiedChords::share() const {
    return right_.width() * up_.width() / static_cast<double>(casts_);
}

Moments StratifiedChords::moments(std::size_t replicate) const {
    Moments m = sums_.all;
    for (std::size_t row = 1; row < kReplicates; ++row) {
        const bool second = std::popcount(row & replicate) % 2 != 0;
        m += sums_.differences[row] * (second ? -1.0 : 1.0);
    }
    return m * share();
}

Spread StratifiedChords::spread() const {
    Spread spread = spread_of_differences(sums_.squares, sums_.fourths);
    spread.deviation *= share() * scale_;
    return spread;
}

void check_relative_error(double error) {
    if (error >= 0) return;
    throw Error(ErrorKind::Usage,
                fmt::format("the relative error is {}; expected a number from 0", error));
}

Deadline::Deadline(double seconds, const StopFlag* stop) : seconds_(seconds), stop_(stop) {
    // A share of NaN seconds would be any number of lines.
    if (seconds >= 0) return;
    throw Error(ErrorKind::Usage,
                fmt::format("the time limit is {} seconds; expected a number from 0", seconds));
}

double Deadline::room(double lines_done) const {
    if (stop_ != nullptr && stop_->requested()) return 0;
    return lines_done * (seconds_ / time_.seconds() - 1);
}

Estimate with_rounding(Estimate estimate, double rounding) {
    estimate.half_width += rounding;
    estimate.rounding += rounding;
    return estimate;
}

Estimate with_rare_misses(Estimate volume, std::uint64_t misses, double lines, double rounding) {
    if (misses >= kEnoughMisses || volume.half_width <= rounding) return volume;
    volume.half_width += kRuleOfThree / lines * std::abs(volume.value);
    return volume;
}

Estimate half_sample_estimate(const Replicates& half_samples, double degrees) {
    Spread spread = spread_of_mean(half_samples);
    // The mean of independent ones would scatter less, by the root of their number.
    spread.deviation *= std::sqrt(double{kReplicates - 1});
    spread.degrees = std::min(spread.degrees, degrees);
    return estimate_of(mean_of(half_samples).value, spread);
}

}  // namespace alhazen
