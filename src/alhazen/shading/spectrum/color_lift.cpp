#include "alhazen/shading/spectrum/color_lift.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "alhazen/shading/spectrum/color_matching.h"

namespace alhazen {

namespace {

/// Wavelengths of the quadrature: every 8 nm to 716; the response beyond is assigned to the last.
constexpr int kNodes = 43;
constexpr double kNodeStep = 8.0;

/// Channels are clamped away from 0 and 1, which no polynomial reaches.
constexpr double kLeastChannel = 2e-4;

struct Node {
    double t;  ///< SmoothReflectance::place
    Rgb weight;
};

/// Quadrature weights for the integral of response times white light times a function, exact for
/// functions that are parabolas in each pair of steps.
std::array<Node, kNodes> make_nodes() {
    std::array<Node, kNodes> nodes{};
    for (int i = 0; i < kNodes; ++i) {
        nodes[std::size_t(i)].t = SmoothReflectance::place(kShortestWave + i * kNodeStep);
    }
    constexpr int kParts = 4;  // of a nanometre
    const int count = static_cast<int>(kLongestWave - kShortestWave) * kParts;
    for (int k = 0; k < count; ++k) {
        const double offset = (k + 0.5) / kParts;
        const double nm = kShortestWave + offset;
        const Rgb seen = (white_light(nm) / kParts) * response(nm);
        const double place = std::min(offset / kNodeStep, double{kNodes - 1});
        const int first = std::min(static_cast<int>(place) / 2 * 2, kNodes - 3);
        const double x = place - first;  // 0..2
        const double shares[3] = {0.5 * (x - 1.0) * (x - 2.0), x * (2.0 - x), 0.5 * x * (x - 1.0)};
        for (int i = 0; i < 3; ++i) nodes[std::size_t(first + i)].weight += shares[i] * seen;
    }
    // Scales the weights so that white stays white.
    Rgb sum;
    for (const Node& node : nodes) sum += node.weight;
    for (Node& node : nodes) {
        node.weight = {node.weight.r / sum.r, node.weight.g / sum.g, node.weight.b / sum.b};
    }
    return nodes;
}

const std::array<Node, kNodes>& nodes() {
    static const std::array<Node, kNodes> all = make_nodes();
    return all;
}

/// A colour, and its derivatives by the three coefficients.
struct ColorAndChange {
    Rgb color, by_a, by_b, by_c;
};

ColorAndChange color_and_change(const SmoothReflectance& r) {
    ColorAndChange sum;
    for (const Node& node : nodes()) {
        const double p = (r.a * node.t + r.b) * node.t + r.c;
        const double inverse = 1.0 / std::sqrt(1.0 + p * p);
        sum.color += (0.5 + 0.5 * p * inverse) * node.weight;
        const Rgb change = (0.5 * inverse * inverse * inverse) * node.weight;
        sum.by_c += change;
        sum.by_b += node.t * change;
        sum.by_a += (node.t * node.t) * change;
    }
    return sum;
}

double determinant_of(const Rgb& a, const Rgb& b, const Rgb& c) {
    return a.r * (b.g * c.b - b.b * c.g) - a.g * (b.r * c.b - b.b * c.r) +
           a.b * (b.r * c.g - b.g * c.r);
}

double largest(const Rgb& c) {
    return std::max({std::abs(c.r), std::abs(c.g), std::abs(c.b)});
}

/// Newton's method from `start`, with steps halved while they do not help. Returns the remaining
/// error.
double solve(const Rgb& color, SmoothReflectance& r, int steps) {
    constexpr double kEnough = 2e-5;
    ColorAndChange now = color_and_change(r);
    Rgb error = color - now.color;
    for (int i = 0; i < steps && largest(error) > kEnough; ++i) {
        const double d = determinant_of(now.by_a, now.by_b, now.by_c);
        if (!(std::abs(d) > 1e-300)) break;
        const double da = determinant_of(error, now.by_b, now.by_c) / d;
        const double db = determinant_of(now.by_a, error, now.by_c) / d;
        const double dc = determinant_of(now.by_a, now.by_b, error) / d;
        double share = 1.0;
        bool better = false;
        for (; share > 1e-3 && !better; share *= 0.5) {
            const SmoothReflectance tried{r.a + share * da, r.b + share * db, r.c + share * dc};
            const ColorAndChange there = color_and_change(tried);
            const Rgb left = color - there.color;
            if (!(largest(left) < largest(error))) continue;
            better = true;
            r = tried;
            now = there;
            error = left;
        }
        if (!better) break;
    }
    return largest(error);
}

double grey_coefficient(double value) {
    return (value - 0.5) / std::sqrt(value * (1.0 - value));
}

int largest_channel(const Rgb& c) {
    return c.r >= c.g ? (c.r >= c.b ? 0 : 2) : (c.g >= c.b ? 1 : 2);
}

/// Flags of the filled parts of a table; each part is filled on demand.
template <std::size_t Count>
class FilledParts {
  public:
    template <class Fill>
    void ensure(std::size_t part, const Fill& fill) {
        if (filled_[part].load(std::memory_order_acquire)) return;
        const std::lock_guard lock(mutex_);
        if (filled_[part].load(std::memory_order_relaxed)) return;
        fill();
        filled_[part].store(true, std::memory_order_release);
    }

  private:
    std::array<std::atomic<bool>, Count> filled_{};
    std::mutex mutex_;
};

/// Coefficients by the largest channel of a colour, its index, and the other two channels over it.
/// Columns of one ratio are filled on demand: most scenes have few colours.
class LiftTable {
  public:
    [[nodiscard]] SmoothReflectance start(const Rgb& color) {
        const int channel = largest_channel(color);
        const double most = color[channel];
        const auto place = [](double x) {
            const double p = std::clamp(x, 0.0, 1.0) * (kSide - 1);
            const int before = std::min(static_cast<int>(p), kSide - 2);
            return std::pair{before, p - before};
        };
        const auto [i, x] = place(color[(channel + 1) % 3] / most);
        const auto [j, y] = place(color[(channel + 2) % 3] / most);
        const auto [k, z] = place(level_of(most));
        for (int corner = 0; corner < 4; ++corner) {
            const int column_i = i + (corner & 1), column_j = j + (corner >> 1);
            columns_.ensure(
                static_cast<std::size_t>((channel * kSide + column_j) * kSide + column_i),
                [&] { fill_column(channel, column_i, column_j); });
        }
        SmoothReflectance sum;
        for (int corner = 0; corner < 8; ++corner) {
            const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
            const double share =
                (di != 0 ? x : 1.0 - x) * (dj != 0 ? y : 1.0 - y) * (dk != 0 ? z : 1.0 - z);
            const SmoothReflectance& r = at(channel, i + di, j + dj, k + dk);
            sum.a += share * r.a;
            sum.b += share * r.b;
            sum.c += share * r.c;
        }
        return sum;
    }

  private:
    static constexpr int kSide = 20;

    /// Levels are denser near black and near white, where coefficients change most.
    [[nodiscard]] static double value_of(double level) {
        const double s = level * level * (3.0 - 2.0 * level);
        return kLeastChannel + (1.0 - 2.0 * kLeastChannel) * s;
    }
    /// The inverse of `value_of`.
    [[nodiscard]] static double level_of(double value) {
        const double s =
            std::clamp((value - kLeastChannel) / (1.0 - 2.0 * kLeastChannel), 0.0, 1.0);
        return 0.5 - std::sin(std::asin(1.0 - 2.0 * s) / 3.0);
    }
    [[nodiscard]] static Rgb color_at(int channel, int i, int j, int k) {
        const double most = value_of(double(k) / (kSide - 1));
        Rgb color;
        color[channel] = most;
        color[(channel + 1) % 3] = std::max(kLeastChannel, most * i / (kSide - 1));
        color[(channel + 2) % 3] = std::max(kLeastChannel, most * j / (kSide - 1));
        return color;
    }
    [[nodiscard]] SmoothReflectance& at(int channel, int i, int j, int k) {
        return entries_[static_cast<std::size_t>(((channel * kSide + j) * kSide + i) * kSide + k)];
    }
    /// Fills a column from a middle level up and down, each entry from its neighbour; the middle
    /// entry is found by continuation from a grey.
    void fill_column(int channel, int i, int j) {
        constexpr int kMiddle = kSide / 2, kSteps = 40;
        const Rgb middle = color_at(channel, i, j, kMiddle);
        const double grey = (middle.r + middle.g + middle.b) / 3.0;
        SmoothReflectance r{0, 0, grey_coefficient(grey)};
        constexpr int kWays = 4;
        for (int way = 1; way <= kWays; ++way) {
            const double share = double(way) / kWays;
            solve((1.0 - share) * Rgb{grey, grey, grey} + share * middle, r, kSteps);
        }
        at(channel, i, j, kMiddle) = r;
        const SmoothReflectance from_middle = r;
        for (int k = kMiddle + 1; k < kSide; ++k) {
            solve(color_at(channel, i, j, k), r, kSteps);
            at(channel, i, j, k) = r;
        }
        r = from_middle;
        for (int k = kMiddle - 1; k >= 0; --k) {
            solve(color_at(channel, i, j, k), r, kSteps);
            at(channel, i, j, k) = r;
        }
    }

    std::vector<SmoothReflectance> entries_ =
        std::vector<SmoothReflectance>(3 * kSide * kSide * kSide);
    FilledParts<3 * kSide * kSide> columns_;
};

/// Colours whose largest channel is 1/2, by the other two channels, with shares denser near 0. Rows
/// are filled on demand.
class HalfTable {
  public:
    HalfTable() {
        for (int channel = 0; channel < 3; ++channel) {
            // Fills from the grey corner, each entry from its neighbour.
            SmoothReflectance r;
            for (int j = kSide - 1; j >= 0; --j) r = solved(channel, kSide - 1, j, r);
        }
    }
    [[nodiscard]] SmoothReflectance of(const Rgb& color) {
        const int channel = largest_channel(color);
        const double most = color[channel];
        const auto place = [&](double other) {
            const double share = std::clamp(other / most, 0.0, 1.0);
            const int before =
                std::min(static_cast<int>(std::sqrt(share) * (kSide - 1)), kSide - 2);
            const double from = share_at(before), to = share_at(before + 1);
            return std::pair{before, (share - from) / (to - from)};
        };
        const auto [i, x] = place(color[(channel + 1) % 3]);
        const auto [j, y] = place(color[(channel + 2) % 3]);
        const int first = channel * kSide + j;
        for (const int row : {first, first + 1}) {
            rows_.ensure(static_cast<std::size_t>(row), [&] { fill_row(row); });
        }
        const SmoothReflectance* const low = &at(channel, i, j);
        const SmoothReflectance* const high = low + kSide;
        const double shares[] = {(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y};
        const auto mean = [&](double SmoothReflectance::*value) {
            return shares[0] * low[0].*value + shares[1] * low[1].*value +
                   shares[2] * high[0].*value + shares[3] * high[1].*value;
        };
        return {mean(&SmoothReflectance::a), mean(&SmoothReflectance::b),
                mean(&SmoothReflectance::c)};
    }

  private:
    static constexpr int kSide = 65;
    [[nodiscard]] static double share_at(int i) {
        const double s = static_cast<double>(i) / (kSide - 1);
        return s * s;
    }
    [[nodiscard]] SmoothReflectance& at(int channel, int i, int j) {
        return entries_[static_cast<std::size_t>((channel * kSide + j) * kSide + i)];
    }
    /// Computes an entry by Newton's method from `from`.
    const SmoothReflectance& solved(int channel, int i, int j, SmoothReflectance from) {
        Rgb color;
        color[channel] = 0.5;
        color[(channel + 1) % 3] = std::max(kLeastChannel, 0.5 * share_at(i));
        color[(channel + 2) % 3] = std::max(kLeastChannel, 0.5 * share_at(j));
        solve(color, from, 40);
        return at(channel, i, j) = from;
    }
    /// Fills a row from its last entry, each from its neighbour.
    void fill_row(int row) {
        const int channel = row / kSide, j = row % kSide;
        SmoothReflectance r = at(channel, kSide - 1, j);
        for (int i = kSide - 2; i >= 0; --i) r = solved(channel, i, j, r);
    }

    std::vector<SmoothReflectance> entries_ = std::vector<SmoothReflectance>(3 * kSide * kSide);
    FilledParts<3 * kSide> rows_;
};

/// Recent results of one thread.
struct LiftCache {
    static constexpr std::size_t kPlaces = 256;
    struct Entry {
        Rgb color{-1, -1, -1};
        SmoothReflectance reflectance;
    };
    std::array<Entry, kPlaces> entries{};

    /// Returns the cached result, or computes it by `lift`.
    template <class Lift>
    [[nodiscard]] SmoothReflectance of(const Rgb& color, const Lift& lift) {
        Entry& entry = place_of(color);
        if (!(entry.color == color)) entry = {color, lift(color)};
        return entry.reflectance;
    }

  private:
    [[nodiscard]] Entry& place_of(const Rgb& color) {
        const std::uint64_t bits = std::bit_cast<std::uint64_t>(color.r) +
                                   3 * std::bit_cast<std::uint64_t>(color.g) +
                                   5 * std::bit_cast<std::uint64_t>(color.b);
        return entries[(bits * 0x9e3779b97f4a7c15u) >> 56];
    }
};
static_assert(LiftCache::kPlaces == 256);

SmoothReflectance lift(const Rgb& color) {
    static LiftTable table;
    Rgb inside;
    for (int i = 0; i < 3; ++i)
        inside[i] = std::clamp(color[i], kLeastChannel, 1.0 - kLeastChannel);
    SmoothReflectance r = table.start(inside);
    solve(inside, r, 12);
    return r;
}

}  // namespace

// The caches are made at first use: as thread-local values every thread would begin by copying
// 24 kB.
SmoothReflectance lifted(const Rgb& color) {
    thread_local const auto cache = std::make_unique<LiftCache>();
    return cache->of(color, lift);
}

SmoothReflectance lifted_half(const Rgb& color) {
    thread_local const auto cache = std::make_unique<LiftCache>();
    return cache->of(color, [](const Rgb& c) {
        static HalfTable table;
        return table.of(c);
    });
}

Rgb color_of(const SmoothReflectance& reflectance) {
    return color_and_change(reflectance).color;
}

}  // namespace alhazen
