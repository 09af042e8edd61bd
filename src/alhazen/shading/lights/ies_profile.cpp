#include "alhazen/shading/lights/ies_profile.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "alhazen/base/error.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// Reads lines, then numbers, which may be spread over lines of any length.
class IesReader {
  public:
    IesReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(ErrorKind::Scene, "IES profile: " + message, {name_, last_read_, 0});
    }
    [[nodiscard]] bool at_end() const { return rest_.empty(); }
    std::string_view line() {
        const std::size_t end = rest_.find('\n');
        std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        last_read_ = line_++;
        while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
        return text;
    }
    void skip_blanks() {
        const auto blank = [](char c) {
            return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
        };
        while (!rest_.empty() && blank(rest_.front())) {
            if (rest_.front() == '\n') ++line_;
            rest_.remove_prefix(1);
        }
        last_read_ = line_;
    }
    /// The line of what follows but blanks; 0: nothing does. A control-Z ends the file.
    int line_of_rest() {
        skip_blanks();
        return rest_.empty() || rest_.front() == '\x1a' ? 0 : line_;
    }
    double number(const char* what) {
        skip_blanks();
        if (rest_.starts_with('+')) rest_.remove_prefix(1);
        double value = 0.0;
        const auto [end, status] =
            std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (status != std::errc{} || !std::isfinite(value)) {
            fail(std::string("expected a number: ") + what);
        }
        rest_.remove_prefix(std::size_t(end - rest_.data()));
        return value;
    }
    std::size_t count(const char* what, std::size_t most) {
        const double value = number(what);
        if (!(value >= 1.0 && value <= double(most) && value == std::floor(value))) {
            fail(std::string(what) + " must be from 1 to " + std::to_string(most));
        }
        return static_cast<std::size_t>(value);
    }
    std::vector<double> angles(std::size_t n, const char* what) {
        std::vector<double> result;
        for (std::size_t i = 0; i < n; ++i) {
            const double degrees = number(what);
            if (!(std::abs(degrees) <= 360.0)) fail(std::string(what) + ": beyond 360 degrees");
            result.push_back(degrees * kRadiansPerDegree);
            if (i > 0 && !(result[i] > result[i - 1])) fail(std::string(what) + " must ascend");
        }
        return result;
    }

  private:
    std::string_view rest_;
    const std::string& name_;
    int line_ = 1;       ///< of `rest_`
    int last_read_ = 1;  ///< line of what was read last
};

/// Position of an angle in a list: the index below, and the fraction of the interval to the next.
struct BetweenAngles {
    std::size_t below, above;
    double share;
};
BetweenAngles between_angles(const std::vector<double>& angles, double angle) {
    const auto after = std::upper_bound(angles.begin(), angles.end(), angle);
    if (after == angles.begin()) return {0, 0, 0.0};
    const std::size_t below = std::size_t(after - angles.begin()) - 1;
    if (after == angles.end()) return {below, below, 0.0};
    return {below, below + 1, (angle - angles[below]) / (angles[below + 1] - angles[below])};
}

/// sin x - x cos x for x >= 0, also where the difference would cancel.
double sine_less_cosine(double x) {
    if (x >= 0.25) return std::sin(x) - x * std::cos(x);
    const double s = x * x;
    return x * s *
           (1.0 / 3.0 - s * (1.0 / 30.0 - s * (1.0 / 840.0 - s * (1.0 / 45360.0 - s / 3991680.0))));
}

/// Weights of the values at `angles` in the integral of their linear interpolant times the sine
/// over [0, pi].
std::vector<double> sine_weights(const std::vector<double>& angles) {
    std::vector<double> weights(angles.size(), 0.0);
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
        const double from = std::max(angles[i], 0.0), to = std::min(angles[i + 1], kPi);
        if (!(from < to)) continue;
        const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
        const double width = angles[i + 1] - angles[i];
        const double all = 2.0 * std::sin(middle) * std::sin(half);
        const double upper =
            ((middle - angles[i]) * all + 2.0 * std::cos(middle) * sine_less_cosine(half)) / width;
        weights[i] += all - upper;
        weights[i + 1] += upper;
    }
    return weights;
}

constexpr double kSlack = 1e-9;  // radians

/// True if measured from 90 to 270 degrees: symmetric about the plane through 90 and 270.
bool is_of_far_half(double first, double last) {
    return first >= kPi / 2 - kSlack && last <= 1.5 * kPi + kSlack;
}
/// True if measured all round.
bool is_periodic(double first, double last) {
    return last > kPi + kSlack && !is_of_far_half(first, last);
}

/// The equivalent angle, by symmetry, in the measured range.
double folded(double angle, double first, double last) {
    double a = std::fmod(angle, 2.0 * kPi);
    if (a < 0.0) a += 2.0 * kPi;
    if (is_of_far_half(first, last)) {
        if (a < kPi / 2) return kPi - a;
        return a > 1.5 * kPi ? 3.0 * kPi - a : a;
    }
    if (is_periodic(first, last)) return a < first ? a + 2.0 * kPi : a;
    if (a > kPi) a = 2.0 * kPi - a;
    return last <= kPi / 2 + kSlack && a > kPi / 2 ? kPi - a : a;
}

/// Position of an azimuth among the measured horizontal angles.
BetweenAngles between_columns(const std::vector<double>& angles, double azimuth) {
    if (angles.size() < 2) return {0, 0, 0.0};
    const double last = angles.back();
    const double angle = folded(azimuth, angles.front(), last);
    const BetweenAngles h = between_angles(angles, angle);
    // Interpolates from the last angle round to the first if 360 degrees is not measured.
    const double gap = angles.front() + 2.0 * kPi - last;
    if (angle > last && gap > kSlack && !is_of_far_half(angles.front(), last)) {
        return {h.below, 0, std::min(1.0, (angle - last) / gap)};
    }
    return h;
}

/// The azimuths from 0 to 2 pi between which `between_columns` is linear, ascending.
std::vector<double> azimuth_breaks(const std::vector<double>& angles) {
    std::vector<double> breaks{0.0, kPi / 2, kPi, 1.5 * kPi, 2.0 * kPi};
    for (const double angle : angles) {
        for (const double image : {angle, -angle, kPi - angle, kPi + angle}) {
            const double a = std::fmod(image, 2.0 * kPi);
            breaks.push_back(a < 0.0 ? a + 2.0 * kPi : a);
        }
    }
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

/// What stands behind 'TILT='; none if the line does not begin so.
std::optional<std::string_view> tilt_of(std::string_view line) {
    line = trimmed(line);
    if (!line.starts_with("TILT")) return std::nullopt;
    line = trimmed(line.substr(4));
    if (!line.starts_with('=')) return std::nullopt;
    return trimmed(line.substr(1));
}

/// True if the line names the standard of 1995 or a later one.
bool names_standard_since_1995(std::string_view line) {
    const std::size_t at = line.find("LM-63-");
    return at != std::string_view::npos && line.size() >= at + 10 &&
           line.substr(at + 6, 4) >= "1995";
}

bool is_word(std::string_view text, std::string_view capitals) {
    return std::equal(text.begin(), text.end(), capitals.begin(), capitals.end(),
                      [](char a, char b) { return (a >= 'a' && a <= 'z' ? a - 32 : a) == b; });
}

}  // namespace

IesProfile::IesProfile(std::string_view text, const std::string& name) : text_(text) {
    refuse_wide_text(text, name);
    IesReader reader(without_byte_order_mark(text_), name);
    if (text.size() > kMostBytes) reader.fail("the file is larger than 16 MiB");
    std::string_view line = reader.line();
    bool since_1995 = false;
    std::optional<std::string_view> tilt;
    while (!(tilt = tilt_of(line))) {
        if (reader.at_end()) reader.fail("expected a line 'TILT=...'; is this an IES file?");
        since_1995 = since_1995 || names_standard_since_1995(line);
        line = reader.line();
    }
    if (is_word(*tilt, "INCLUDE")) {
        (void)reader.number("lamp to luminaire geometry");
        const std::size_t pairs = reader.count("number of tilt angles", kMostAngles);
        for (std::size_t i = 0; i < pairs; ++i) (void)reader.number("tilt angle");
        for (std::size_t i = 0; i < pairs; ++i) {
            if (reader.number("tilt factor") != 1.0) ignored_tilt_ = *tilt;
        }
    } else if (!is_word(*tilt, "NONE")) {
        ignored_tilt_ = *tilt;
    }
    (void)reader.number("number of lamps");
    (void)reader.number("lumens per lamp");
    double scale = reader.number("candela multiplier");
    const std::size_t verticals = reader.count("number of vertical angles", kMostAngles);
    const std::size_t horizontals = reader.count("number of horizontal angles", kMostAngles);
    if (verticals * horizontals > text.size()) reader.fail("more values than the file can hold");
    if (reader.number("photometric type") != 1.0) {
        reader.fail("only photometric type C (1) is read: vertical angles from straight down");
    }
    for (const char* what : {"units", "width", "length", "height"}) (void)reader.number(what);
    scale *= reader.number("ballast factor");
    const double photometric = reader.number("ballast-lamp photometric factor");
    if (!since_1995) scale *= photometric;
    (void)reader.number("input watts");
    verticals_ = reader.angles(verticals, "vertical angles");
    horizontals_ = reader.angles(horizontals, "horizontal angles");
    for (std::size_t i = 0; i < verticals * horizontals; ++i) {
        const double value = scale * reader.number("candela");
        if (!(value >= 0.0 && value <= 1e12)) reader.fail("candela must be from 0 to 10^12");
        candela_.push_back(value);
        largest_ = std::max(largest_, value);
    }
    line_of_surplus_ = reader.line_of_rest();
}

double IesProfile::candela(double vertical, double horizontal) const {
    if (vertical < verticals_.front() - kSlack || vertical > verticals_.back() + kSlack) return 0.0;
    const BetweenAngles v = between_angles(verticals_, vertical);
    const BetweenAngles h = between_columns(horizontals_, horizontal);
    const auto column = [&](std::size_t i) {
        return value(i, v.below) + v.share * (value(i, v.above) - value(i, v.below));
    };
    return (1.0 - h.share) * column(h.below) + h.share * column(h.above);
}

double IesProfile::lumens() const {
    const std::vector<double> weights = sine_weights(verticals_);
    std::vector<double> columns;
    for (std::size_t i = 0; i < horizontals_.size(); ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < weights.size(); ++j) sum += weights[j] * value(i, j);
        columns.push_back(sum);
    }
    // The middle of an interval is the mean over it, whatever holds at its ends.
    const std::vector<double> breaks = azimuth_breaks(horizontals_);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const BetweenAngles h = between_columns(horizontals_, 0.5 * (breaks[i] + breaks[i + 1]));
        const double mean = (1.0 - h.share) * columns[h.below] + h.share * columns[h.above];
        sum += (breaks[i + 1] - breaks[i]) * mean;
    }
    return sum;
}

double profile_factor(const LightProfile& profile, const Vec3& from_light) {
    if (!profile.profile) return 1.0;
    const Vec3 down = unit_or(profile.down, {0, 0, -1});
    const Vec3 front =
        unit_or(profile.front - dot(profile.front, down) * down, perpendicular(down));
    const Vec3 side = cross(front, down);
    const double vertical = std::acos(std::clamp(dot(from_light, down), -1.0, 1.0));
    const double horizontal = std::atan2(dot(from_light, side), dot(from_light, front));
    return profile.profile->candela(vertical, horizontal) / (kLumensPerWatt * kPi);
}

double largest_factor(const LightProfile& profile) {
    return profile.profile ? profile.profile->largest_candela() / (kLumensPerWatt * kPi) : 1.0;
}

double mean_factor(const LightProfile& profile) {
    return profile.profile ? profile.profile->lumens() / (4.0 * kPi * kLumensPerWatt * kPi) : 1.0;
}

}  // namespace alhazen
