#include "alhazen/scene/line_bundle.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "alhazen/math/random.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

constexpr std::size_t kCellsPerTask = 256;
/// Of the cells that are cut these are the largest, whatever was seen in them: what is too small to
/// be seen at once must not be overlooked for good.
constexpr double kCutForSize = 0.25;
/// The same where hardly a line misses: what the corners may lack was not seen.
constexpr double kCutForSizeIfFull = 0.75;
/// So many lines that miss the solid show in the scatter.
constexpr std::uint64_t kEnoughMisses = 10;
/// Ends of spans are right to a few roundings of the numbers they are computed from.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Adds the span a < t < b of the line o + t d, |d| = 1, which counts `weight` times.
void add_span(const Vec3& o, const Vec3& d, double a, double b, double weight, Moments& m) {
    const double l0 = weight * (b - a);
    const double l1 = l0 * (0.5 * (a + b));
    const double l2 = l0 * (a * a + a * b + b * b) / 3.0;
    m.volume += l0;
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
    return *this;
}

Moments Moments::operator*(double factor) const {
    Moments m = *this;
    m.volume *= factor;
    m.first = factor * m.first;
    for (double& x : m.second) x *= factor;
    m.cosines *= factor;
    return m;
}

LineBundle::Sums& LineBundle::Sums::operator+=(const Sums& other) {
    all += other.all;
    for (std::size_t i = 0; i < differences.size(); ++i) differences[i] += other.differences[i];
    inconsistent += other.inconsistent;
    misses += other.misses;
    return *this;
}

LineBundle::LineBundle(const Measurable& solid, const BundleFrame& frame, const Vec3& center,
                       std::uint64_t key, Measured measured)
    : solid_(solid), frame_(frame), center_(center), key_(mix64(key)), measured_(measured) {
    const auto range = [&](const Vec3& axis) {
        const Interval extent = solid.extent(axis);
        const double shift = dot(axis, center);
        return Interval{extent.lo - shift, extent.hi - shift};
    };
    right_ = range(frame.right);
    up_ = range(frame.up);
}

std::uint64_t LineBundle::grow_to(std::uint64_t lines) {
    const auto cells = static_cast<std::size_t>(lines / kLinesPerCell);
    if (cells_.empty()) {
        const auto side = static_cast<std::size_t>(std::lround(std::sqrt(double(cells))));
        const double size = 1.0 / static_cast<double>(side);
        cells_.reserve(side * side);
        for (std::size_t i = 0; i < side * side; ++i) {
            const auto column = static_cast<double>(i % side), row = static_cast<double>(i / side);
            cells_.push_back({column * size, row * size, size, size});
        }
    } else if (cells > cells_.size()) {
        cut(cells);
        sums_ = {};
        casts_ = 0;
    }
    cast();
    return lines_of_round();
}

/// Cuts the cells with the largest scatter, and some of the largest, into four each.
void LineBundle::cut(std::size_t cells) {
    const std::size_t wanted = std::min(cells_.size(), (cells - cells_.size() + 2) / 3);
    std::vector<std::uint32_t> order(cells_.size());
    std::iota(order.begin(), order.end(), 0u);
    const double share = sums_.misses < kEnoughMisses ? kCutForSizeIfFull : kCutForSize;
    const auto for_size = static_cast<std::size_t>(share * static_cast<double>(wanted));
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(wanted - for_size);
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(wanted);
    const auto by = [&](auto&& size) {
        return [&, size](std::uint32_t a, std::uint32_t b) {
            const double of_a = size(cells_[a]), of_b = size(cells_[b]);
            return of_a != of_b ? of_a > of_b : a < b;
        };
    };
    std::nth_element(order.begin(), first, order.end(),
                     by([](const Cell& c) { return c.scatter; }));
    std::nth_element(first, last, order.end(), by([](const Cell& c) { return c.area(); }));
    std::vector<bool> is_cut(cells_.size());
    for (auto i = order.begin(); i != last; ++i) is_cut[*i] = true;
    std::vector<Cell> finer;
    finer.reserve(cells_.size() + 3 * wanted);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Cell& c = cells_[i];
        if (!is_cut[i]) {
            finer.push_back(c);
            continue;
        }
        const double w = 0.5 * c.width, h = 0.5 * c.height;
        for (const double x : {c.x, c.x + w}) {
            finer.push_back({x, c.y, w, h});
            finer.push_back({x, c.y + h, w, h});
        }
    }
    cells_ = std::move(finer);
}

void LineBundle::cast() {
    const std::size_t tasks = (cells_.size() + kCellsPerTask - 1) / kCellsPerTask;
    std::vector<Sums> parts(tasks);
    parallel_for(tasks, 1, [&](std::size_t begin, std::size_t end) {
        LineSpans found;
        for (std::size_t task = begin; task < end; ++task) {
            const std::size_t first = task * kCellsPerTask;
            const std::size_t last = std::min(cells_.size(), first + kCellsPerTask);
            for (std::size_t i = first; i < last; ++i) cast_in(cells_[i], i, found, parts[task]);
        }
    });
    for (const Sums& part : parts) {
        sums_ += part;
        inconsistent_ += part.inconsistent;
    }
    ++rounds_;
    ++casts_;
}

void LineBundle::cast_in(Cell& cell, std::uint64_t number, LineSpans& found, Sums& sums) const {
    std::uint64_t bits = mix64(key_ ^ mix64(rounds_ << 40 | number));
    // Any but that of the constant row.
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
    const double scatter = measured_ == Measured::Area ? pairs[0].cosines - pairs[1].cosines
                                                       : pairs[0].volume - pairs[1].volume;
    // Cells are put in order by it, which a NaN would break.
    cell.scatter = std::isfinite(scatter) ? std::abs(scatter) : 0;
}

/// Two lines opposite of each other about the middle of the cell.
void LineBundle::cast_pair(const Cell& cell, std::uint64_t bits, LineSpans& found, Moments& pair,
                           Sums& sums) const {
    const bool want_cosines = measured_ == Measured::Area;
    const double weight = cell.area() / kLinesPerCell;
    const double u = (static_cast<double>(bits >> 32) + 0.5) * 0x1p-32;
    const double v = (static_cast<double>(bits & 0xffffffffu) + 0.5) * 0x1p-32;
    for (const bool opposite : {false, true}) {
        const double x = cell.x + cell.width * (opposite ? 1 - u : u);
        const double y = cell.y + cell.height * (opposite ? 1 - v : v);
        const Vec3 offset = (right_.lo + right_.width() * x) * frame_.right +
                            (up_.lo + up_.width() * y) * frame_.up;
        solid_.cross({center_ + offset, frame_.d}, want_cosines, found);
        sums.inconsistent += found.consistent ? 0 : 1;
        sums.misses += found.consistent && found.spans.empty() ? 1 : 0;
        for (const Interval& span : found.spans) {
            add_span(offset, frame_.d, span.lo, span.hi, weight, pair);
        }
        pair.cosines += weight * found.cosines;
    }
}

double LineBundle::sparsest() const {
    double largest = 0;
    for (const Cell& c : cells_) largest = std::max(largest, c.area());
    return static_cast<double>(casts_ * kLinesPerCell) / largest;
}

double LineBundle::share() const {
    return right_.width() * up_.width() / static_cast<double>(casts_);
}

Moments LineBundle::moments(std::size_t replicate) const {
    Moments m = sums_.all;
    for (std::size_t row = 1; row < kReplicates; ++row) {
        const bool second = std::popcount(row & replicate) % 2 != 0;
        m += sums_.differences[row] * (second ? -1.0 : 1.0);
    }
    return m * share();
}

Replicates LineBundle::volumes() const {
    Replicates v{};
    for (std::size_t r = 0; r < kReplicates; ++r) v[r] = moments(r).volume;
    return v;
}

Replicates LineBundle::areas() const {
    Replicates v{};
    for (std::size_t r = 0; r < kReplicates; ++r) v[r] = moments(r).cosines;
    return v;
}

Deadline::Deadline(double seconds, const StopFlag* stop)
    : seconds_(seconds), stop_(stop), begin_(now()) {}

double Deadline::room(double lines_done) const {
    if (stop_ != nullptr && stop_->requested()) return 0;
    const double elapsed = now() - begin_;
    return lines_done * (seconds_ / elapsed - 1);
}

Estimate with_rounding(Estimate estimate, double magnitude) {
    estimate.half_width += kRounding * magnitude;
    return estimate;
}

Estimate with_rare_misses(Estimate volume, std::uint64_t misses, double lines) {
    // Of an event that never came in n trials the share is below 3/n in 95 of 100 cases.
    constexpr double kRuleOfThree = 3.0;
    const bool all_alike = volume.half_width <= kRounding * std::abs(volume.value);
    if (misses >= kEnoughMisses || all_alike) return volume;
    volume.half_width += kRuleOfThree / lines * std::abs(volume.value);
    return volume;
}

Estimate half_sample_estimate(const Replicates& replicates) {
    Estimate e = mean_of(replicates);
    // Of independent ones the mean would scatter less, by the root of their number.
    e.half_width *= std::sqrt(double{kReplicates - 1});
    return e;
}

}  // namespace alhazen
