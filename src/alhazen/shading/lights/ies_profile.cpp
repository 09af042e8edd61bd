#include "alhazen/shading/lights/ies_profile.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "alhazen/base/error.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// Reads lines, then numbers, which may be spread over lines of any length.
class IesReader {
  public:
    IesReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(ErrorKind::Scene, "IES profile: " + message, {name_, line_, 0});
    }
    [[nodiscard]] bool at_end() const { return rest_.empty(); }
    std::string_view line() {
        const std::size_t end = rest_.find('\n');
        std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        ++line_;
        while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
        return text;
    }
    double number(const char* what) {
        const auto blank = [](char c) {
            return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
        };
        while (!rest_.empty() && blank(rest_.front())) {
            if (rest_.front() == '\n') ++line_;
            rest_.remove_prefix(1);
        }
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
    int line_ = 0;
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

constexpr double kSlack = 1e-9;  // radians

/// The equivalent angle, by symmetry, in the measured range.
double folded(double angle, double first, double last) {
    double a = std::fmod(angle, 2.0 * kPi);
    if (a < 0.0) a += 2.0 * kPi;
    if (first >= kPi / 2 - kSlack && last <= 1.5 * kPi + kSlack) {
        // Measured from 90 to 270: symmetric about the plane through 90 and 270.
        if (a < kPi / 2) return kPi - a;
        return a > 1.5 * kPi ? 3.0 * kPi - a : a;
    }
    if (last > kPi + kSlack) return a;
    if (a > kPi) a = 2.0 * kPi - a;
    return last <= kPi / 2 + kSlack && a > kPi / 2 ? kPi - a : a;
}

}  // namespace

IesProfile::IesProfile(std::string_view text, const std::string& name) : text_(text) {
    IesReader reader(text_, name);
    if (text.size() > kMostBytes) reader.fail("the file is larger than 16 MiB");
    std::string_view tilt;
    while (!tilt.starts_with("TILT=")) {
        if (reader.at_end()) reader.fail("expected a line 'TILT=...'; is this an IES file?");
        tilt = reader.line();
    }
    if (tilt == "TILT=INCLUDE") {
        (void)reader.number("lamp to luminaire geometry");
        const std::size_t pairs = reader.count("number of tilt angles", kMostAngles);
        for (std::size_t i = 0; i < 2 * pairs; ++i) (void)reader.number("tilt");
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
    (void)reader.number("ballast-lamp photometric factor");
    (void)reader.number("input watts");
    verticals_ = reader.angles(verticals, "vertical angles");
    horizontals_ = reader.angles(horizontals, "horizontal angles");
    for (std::size_t i = 0; i < verticals * horizontals; ++i) {
        const double value = scale * reader.number("candela");
        if (!(value >= 0.0 && value <= 1e12)) reader.fail("candela must be from 0 to 10^12");
        candela_.push_back(value);
        largest_ = std::max(largest_, value);
    }
}

double IesProfile::candela(double vertical, double horizontal) const {
    if (vertical < verticals_.front() - kSlack || vertical > verticals_.back() + kSlack) return 0.0;
    const BetweenAngles v = between_angles(verticals_, vertical);
    BetweenAngles h{0, 0, 0.0};
    if (horizontals_.size() > 1) {
        const double last = horizontals_.back();
        const double angle = folded(horizontal, horizontals_.front(), last);
        h = between_angles(horizontals_, angle);
        // Interpolates from the last angle round to the first if 360 degrees is not measured.
        const double gap = horizontals_.front() + 2.0 * kPi - last;
        if (angle > last && gap > kSlack) h = {h.below, 0, std::min(1.0, (angle - last) / gap)};
    }
    const auto column = [&](std::size_t i) {
        return value(i, v.below) + v.share * (value(i, v.above) - value(i, v.below));
    };
    return (1.0 - h.share) * column(h.below) + h.share * column(h.above);
}

double IesProfile::lumens() const {
    // Finer than usual spacings of the measured angles.
    constexpr int kRows = 720, kColumns = 360;
    double sum = 0.0;
    for (int i = 0; i < kRows; ++i) {
        const double solid =
            2.0 * kPi / kColumns * (std::cos(kPi * i / kRows) - std::cos(kPi * (i + 1) / kRows));
        for (int j = 0; j < kColumns; ++j) {
            sum += solid * candela(kPi * (i + 0.5) / kRows, 2.0 * kPi * (j + 0.5) / kColumns);
        }
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
