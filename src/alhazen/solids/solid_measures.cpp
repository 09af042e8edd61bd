#include "alhazen/solids/solid_measures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/math/constants.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/sampling/random.h"
#include "alhazen/solids/line_through_sphere.h"
#include "alhazen/solids/stratified_chords.h"

namespace alhazen {

namespace {

constexpr std::uint64_t kPilotLines = 1024;  ///< per direction
constexpr std::uint64_t kFirstLines = 4096;
/// Limits for slow lines: the pilot and the first round take at most this share of the time, but at
/// least kLeastLines lines, below which estimates are meaningless.
constexpr double kShareOfPilot = 1.0 / 64, kShareOfFirst = 1.0 / 32;
constexpr std::uint64_t kLeastLines = 128;
/// The least worthwhile growth.
constexpr double kLeastGrowth = 1.25;
/// The interval of a bundle falls about with this power of the number of lines; kReserve times the
/// estimated lines make it narrow enough reliably.
constexpr double kOrder = 1.2, kReserve = 2;
/// Limits of the growth in one step.
constexpr double kLeastStep = 2, kMostStep = 16;
/// Independent line sets for Crofton's formula, and lines per set. The check converges slowly.
constexpr std::size_t kCroftonSets = 16;
constexpr std::uint32_t kCroftonLines = 2048, kLeastCroftonLines = 32;
constexpr double kShareOfCrofton = 1.0 / 16;  ///< largest share of the time
/// Share of the time for the volume when the area is measured too.
constexpr double kShareOfVolume = 0.875;
/// Half of an interval of the requested width is exceeded once in twenty cases; work on the volume
/// continues, within the time limit, until that is rare.
constexpr double kShareOfWanted = 0.5;
/// Largest allowed difference, as a multiple of both intervals.
constexpr double kAgreement = 2.5;
/// A direction whose volume differs is measured again with intervals narrower by this factor, so
/// many times: where chance has made the difference, it vanishes.
constexpr double kNarrower = 4;
constexpr int kRepeats = 2;

constexpr StratifiedChords::Measured kArea = StratifiedChords::Measured::Area;

/// Range of moments of inertia without overflow or loss of digits.
constexpr double kLeastMoment = 1e-290, kMostMoment = 1e300;

/// The axes of the world, and a frame oblique to common directions.
std::array<std::array<BundleFrame, 3>, 2> frames() {
    const Mat3 aslant = Affine::rotate({0.36, 0.48, 0.8}, 0.7236).linear *
                        Affine::rotate({1, 0.2, -0.3}, 0.5129).linear;
    std::array<std::array<BundleFrame, 3>, 2> all;
    const std::array<Mat3, 2> bases{Mat3{}, aslant};
    for (std::size_t i = 0; i < bases.size(); ++i) {
        const Vec3 x = bases[i].x_axis, y = bases[i].y_axis, z = bases[i].z_axis;
        all[i] = {BundleFrame{x, y, z}, BundleFrame{y, z, x}, BundleFrame{z, x, y}};
    }
    return all;
}

bool agree(const Estimate& a, const Estimate& b) {
    return std::abs(a.value - b.value) <= kAgreement * std::hypot(a.half_width, b.half_width);
}

class Measurer {
  public:
    Measurer(const Measurable& solid, const MeasureOptions& options)
        : solid_(solid),
          options_(options),
          deadline_(options.seconds, options.stop),
          volume_deadline_(options.seconds * (options.area ? kShareOfVolume : 1.0), options.stop) {
        check_relative_error(options.relative_error);
        box_ = solid.box();
    }

    SolidMeasures run() {
        SolidMeasures found;
        found.box = box_;
        if (box_.empty()) {
            found.reached = true;
            return found;
        }
        if (!box_.bounded()) {
            throw Error(ErrorKind::Usage,
                        "the solid has no bounded box; if it is bounded, intersect it with a box");
        }
        center_ = box_.center();
        slack_ = kRounding * solid_.magnitude();
        choose_frame();
        grow();
        repeat_what_differs();
        fill(found);
        return found;
    }

  private:
    /// Runs pilots along six directions and keeps the frame of the best one.
    void choose_frame() {
        const auto all = frames();
        StratifiedChords first(solid_, all[0][0], center_, mix64(options_.seed) + 50);
        grow_bundle(first, kLeastLines);  // measures the time per line
        double least = 0, least_area = 0;
        for (std::size_t f = 0; f < all.size(); ++f) {
            if (f > 0 && deadline_.room(lines_) <= 0) break;
            std::size_t best = 0;
            double best_work = 0, area_spread = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint64_t key = mix64(options_.seed) + 16 * f + k;
                StratifiedChords pilot(solid_, all[f][k], center_, key);
                grow_bundle(pilot, affordable(kPilotLines, kShareOfPilot));
                const double work = work_ahead(pilot);
                if (k == 0 || work < best_work) {
                    best = k;
                    best_work = work;
                }
                if (!options_.area) continue;
                StratifiedChords area_pilot(solid_, all[f][k], center_, key + 1000, kArea);
                grow_bundle(area_pilot, affordable(kPilotLines, kShareOfPilot));
                area_spread += area_pilot.spread().deviation;
            }
            const bool better =
                best_work < least || (best_work == least && area_spread < least_area);
            if (f > 0 && !better) continue;
            least = best_work;
            least_area = area_spread;
            frame_ = f;
            best_ = best;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t key = mix64(options_.seed) + 100 + 16 * frame_ + k;
            bundles_.emplace_back(solid_, all[frame_][k], center_, key);
            grow_bundle(bundles_.back(), affordable(kFirstLines, kShareOfFirst));
            if (!options_.area) continue;
            area_bundles_.emplace_back(solid_, all[frame_][k], center_, key + 1000, kArea);
            grow_bundle(area_bundles_.back(), affordable(kFirstLines, kShareOfFirst));
        }
    }

    /// `lines`, or fewer if they would take more than this share of the time.
    [[nodiscard]] std::uint64_t affordable(std::uint64_t lines, double share) const {
        const double room = share * deadline_.room(lines_) / StratifiedChords::kCostOfLine;
        const auto least = static_cast<double>(kLeastLines);
        return static_cast<std::uint64_t>(std::clamp(room, least, double(lines)));
    }

    /// Estimated number of lines for the requested error along the direction of a pilot.
    [[nodiscard]] double work_ahead(const StratifiedChords& pilot) const {
        const Estimate e = pilot.estimate();
        const double rounding = slack_ * pilot.projected_area() + kSumming * std::abs(e.value);
        const Estimate widened = with_rare_misses(e, pilot.misses(), pilot.sparsest(), rounding);
        const double wanted = options_.relative_error * std::abs(e.value);
        const double lines = static_cast<double>(pilot.lines());
        if (pilot.unseen_shadow() > 0) return kInfinity;
        if (!(wanted > 0)) return 0;
        // The term for rare misses falls as 1 / lines.
        return lines * std::max(std::pow(e.half_width / wanted, 1 / kOrder),
                                (widened.half_width - e.half_width) / wanted);
    }

    void grow_bundle(StratifiedChords& bundle, std::uint64_t lines) {
        lines_ += static_cast<double>(bundle.grow_to(lines));
    }
    /// Adds lines to narrow the interval by the factor, as far as time allows; otherwise casts new
    /// lines in the same cells. Returns false if there is no time for that either.
    bool enlarge(StratifiedChords& bundle, double factor, const Deadline& deadline) {
        const double room = deadline.room(lines_);
        const auto round = static_cast<double>(bundle.lines_of_round());
        const auto most = static_cast<double>(options_.most_lines_of_round);
        const double needed = kReserve * std::pow(factor, 1 / kOrder);
        const double growth = std::clamp(needed, kLeastStep, kMostStep);
        const double wanted =
            std::min({growth * round, room / StratifiedChords::kCostOfLine, most});
        const bool grows = wanted >= kLeastGrowth * round;
        if (!grows && room < round) return false;
        // Nothing was met by as many lines as a round may have.
        if (!grows && std::isinf(factor)) return false;
        grow_bundle(bundle, grows ? static_cast<std::uint64_t>(wanted) : 0);
        return true;
    }

    /// Ratio of the interval to the requested one; at most 1 if it is narrow enough.
    [[nodiscard]] static double excess(const Estimate& e, double relative) {
        const double wanted = relative * std::abs(e.value);
        return e.half_width <= wanted ? 1 : e.half_width / wanted;
    }

    void grow() {
        const auto grow_volume = [&](const Deadline& deadline) {
            for (;;) {
                const double factor = excess(volume(), kShareOfWanted * options_.relative_error);
                if (factor <= 1 || !enlarge(bundles_[best_], factor, deadline)) return;
            }
        };
        const auto grow_area = [&] {
            for (;;) {
                const double factor = excess(area(), options_.relative_error);
                if (factor <= 1 || !enlarge(area_bundles_[widest_area()], factor, deadline_))
                    return;
            }
        };
        grow_volume(volume_deadline_);
        if (options_.area) grow_area();
        grow_volume(deadline_);
        reached_ = excess(volume(), options_.relative_error) <= 1 &&
                   (!options_.area || excess(area(), options_.relative_error) <= 1);
    }

    /// Measures the directions again whose volumes differ, as far as time allows.
    void repeat_what_differs() {
        for (std::size_t k = 0; k < 3; ++k) {
            for (int i = 0; i < kRepeats && !agree(volume(), volume_along(k)); ++i) {
                if (!enlarge(bundles_[k], kNarrower, deadline_)) break;
            }
        }
    }

    [[nodiscard]] std::size_t widest_area() const {
        std::size_t widest = 0;
        for (std::size_t k = 1; k < 3; ++k) {
            if (area_bundles_[k].spread().deviation > area_bundles_[widest].spread().deviation)
                widest = k;
        }
        return widest;
    }

    [[nodiscard]] Estimate volume_along(std::size_t k) const {
        const StratifiedChords& bundle = bundles_[k];
        const Estimate e = bundle.estimate();
        const double rounding = volume_rounding(e.value);
        Estimate widened = with_rounding(
            with_rare_misses(e, bundle.misses(), bundle.sparsest(), rounding), rounding);
        // If no line met the solid: its shadow times its length along the lines.
        widened.half_width += bundle.unseen_shadow() * solid_.extent(bundle.direction()).width();
        return widened;
    }
    [[nodiscard]] Estimate volume() const { return volume_along(best_); }

    /// Error of the volume for a surface displaced by the slack: slack times its area, which is at
    /// most the sum of its projections along the three directions.
    [[nodiscard]] double volume_rounding(double volume) const {
        double surface = 0;
        for (const StratifiedChords& bundle : bundles_) surface += bundle.projected_area();
        return slack_ * surface + kSumming * std::abs(volume);
    }

    [[nodiscard]] Estimate area() const {
        double value = 0, rounding = 0, unseen = 0;
        std::array<Spread, 3> spreads;
        for (std::size_t k = 0; k < 3; ++k) {
            const StratifiedChords& bundle = area_bundles_[k];
            const double share = bundle.value();
            value += share;
            spreads[k] = bundle.spread();
            // Silhouettes with every side displaced by the slack, and sums of cosines.
            const double edges = 1 / bundle.right_width() + 1 / bundle.up_width();
            rounding += std::abs(share) * (2 * slack_ * edges + kSumming);
            // Two crossings, if no line met the solid.
            unseen += 2 * bundle.unseen_shadow();
        }
        Estimate area = with_rounding(estimate_of(value, sum_of(spreads)), rounding);
        area.half_width += unseen;
        return area;
    }

    /// Crofton's formula with isotropic lines through the ball around the box: the mean number of
    /// crossings times the surface of the ball is twice the area.
    [[nodiscard]] Estimate crofton() {
        const double radius = 0.5 * length(box_.size());
        std::array<double, kCroftonSets> area{};
        const double share = kShareOfCrofton * (lines_ + deadline_.room(lines_)) / kCroftonSets;
        const auto lines = static_cast<std::uint32_t>(
            std::clamp(share, double{kLeastCroftonLines}, double{kCroftonLines}));
        parallel_for(kCroftonSets, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t r = begin; r < end; ++r) {
                area[r] = 2 * kPi * radius * radius * mean_crossings(r, radius, lines);
            }
        });
        lines_ += static_cast<double>(kCroftonSets * lines);
        Estimate e = mean_of(area);
        // Counts are whole numbers: sets may all count the same and yet miss the mean by a part of
        // one. The rule of three, for lines with two crossings.
        e.half_width = std::max(e.half_width,
                                2 * kPi * radius * radius * 2 * 3 / double(kCroftonSets * lines));
        return with_rounding(e, std::abs(e.value) * (slack_ / radius + kSumming));
    }

    [[nodiscard]] double mean_crossings(std::size_t replicate, double radius,
                                        std::uint32_t lines) const {
        const std::uint64_t key = mix64(options_.seed + 77) + replicate;
        LineSpans found;
        double sum = 0;
        for (std::uint32_t i = 0; i < lines; ++i) {
            interruption_point();
            solid_.cross(line_through_sphere(key, i, center_, radius), false, found);
            sum += 2.0 * static_cast<double>(found.spans.size());
        }
        return sum / lines;
    }

    void fill(SolidMeasures& found) {
        found.volume = volume();
        found.in_range = std::isfinite(found.volume.hi());
        for (std::size_t k = 0; k < 3; ++k) {
            found.volume_by_direction[k] = volume_along(k);
            found.directions[k] = bundles_[k].direction();
            found.inconsistent_lines += bundles_[k].inconsistent();
            if (options_.area) found.inconsistent_lines += area_bundles_[k].inconsistent();
            found.directions_agree =
                found.directions_agree && agree(found.volume, found.volume_by_direction[k]);
        }
        fill_moments(found);
        if (options_.area) {
            found.area = area();
            found.area_by_crofton = crofton();
            found.areas_agree = agree(found.area, found.area_by_crofton);
            found.in_range = found.in_range && std::isfinite(found.area.hi());
        }
        found.lines = static_cast<std::uint64_t>(lines_);
        found.reached = reached_;
    }

    /// Computes centroid and inertia, which are ratios, per half sample and averages them.
    void fill_moments(SolidMeasures& found) const {
        std::array<Replicates, 3> centroid{};
        std::array<Replicates, 6> inertia{};
        for (std::size_t r = 0; r < kReplicates; ++r) {
            const Moments m = bundles_[best_].moments(r);
            // An empty solid, or one that hardly any line hits, has no centroid.
            if (!(m.volume > 0.0)) return;
            const Vec3 c = m.first / m.volume;
            std::array<double, 6> s = m.second;  // about the centroid
            s[0] -= m.volume * c.x * c.x;
            s[1] -= m.volume * c.y * c.y;
            s[2] -= m.volume * c.z * c.z;
            s[3] -= m.volume * c.x * c.y;
            s[4] -= m.volume * c.y * c.z;
            s[5] -= m.volume * c.z * c.x;
            for (int k = 0; k < 3; ++k) centroid[std::size_t(k)][r] = center_[k] + c[k];
            const std::array<double, 6> tensor{s[1] + s[2], s[2] + s[0], s[0] + s[1],
                                               -s[3],       -s[4],       -s[5]};
            for (std::size_t k = 0; k < 6; ++k) inertia[k][r] = tensor[k];
        }
        const double size = length(box_.size());
        const double rounding = volume_rounding(found.volume.value);
        const double shift = slack_ + rounding / found.volume.value * size;
        const double degrees = bundles_[best_].spread().degrees;
        found.has_moments = true;
        for (std::size_t k = 0; k < 3; ++k) {
            found.centroid[k] = with_rounding(half_sample_estimate(centroid[k], degrees), shift);
        }
        const double moment = found.volume.value * size * size;
        for (std::size_t k = 0; k < 6; ++k) {
            found.inertia[k] = with_rounding(half_sample_estimate(inertia[k], degrees),
                                             2 * rounding * size * size);
        }
        found.in_range = found.in_range && kLeastMoment <= moment && moment <= kMostMoment;
    }

    const Measurable& solid_;
    const MeasureOptions& options_;
    Deadline deadline_, volume_deadline_;
    Box3 box_;
    Vec3 center_;
    double slack_ = 0;  ///< largest displacement of a surface by rounding
    std::size_t frame_ = 0, best_ = 0;
    std::vector<StratifiedChords> bundles_, area_bundles_;
    double lines_ = 0;
    bool reached_ = false;
};

}  // namespace

SolidMeasures measure(const Measurable& solid, const MeasureOptions& options) {
    return Measurer(solid, options).run();
}

}  // namespace alhazen
