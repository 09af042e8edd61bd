#pragma once
/// Parallel lines through a solid, several independent scramblings of one net of them, and what
/// they sum to.
///
/// Source, Differs, Conventions: see solid_measures.h, of which this is the inside.

#include <array>
#include <vector>

#include "alhazen/base/progress.h"
#include "alhazen/sampling/confidence.h"
#include "alhazen/scene/lone_solid.h"

namespace alhazen {

/// Independent scramblings of every estimate.
inline constexpr std::size_t kReplicates = 16;
using Replicates = std::array<double, kReplicates>;

/// Sums over spans of moments up to the second.
struct Moments {
    double volume = 0;
    Vec3 first;
    std::array<double, 6> second{};  ///< xx, yy, zz, xy, yz, zx
    double cosines = 0;
    std::uint64_t inconsistent = 0;
    std::uint64_t misses = 0;  ///< lines that do not meet the solid

    Moments& operator+=(const Moments& other);
};

/// A right-handed frame: lines run along `d`, and stand on the plane of the other two.
struct BundleFrame {
    Vec3 d, right, up;
};

/// The lines of one direction. Grows by whole factors of two.
class LineBundle {
  public:
    /// `center`: moments are about it.
    LineBundle(const Measurable& solid, const BundleFrame& frame, const Vec3& center,
               std::uint64_t key);

    [[nodiscard]] const Vec3& direction() const { return frame_.d; }
    /// Lines of each scrambling so far.
    [[nodiscard]] std::uint32_t lines() const { return lines_; }
    void grow_to(std::uint32_t lines, bool want_cosines);

    /// Estimates of each scrambling. Cosines sum to this direction's share of the area.
    [[nodiscard]] Moments moments(std::size_t replicate) const;
    [[nodiscard]] Replicates volumes() const;
    [[nodiscard]] Replicates areas() const;
    [[nodiscard]] std::uint64_t inconsistent() const;
    /// Lines of all scramblings that missed the solid.
    [[nodiscard]] std::uint64_t misses() const;

  private:
    [[nodiscard]] Moments sum_of(std::size_t replicate, std::uint32_t begin, std::uint32_t end,
                                 bool want_cosines) const;

    const Measurable& solid_;
    BundleFrame frame_;
    Vec3 center_;
    std::uint64_t key_;
    Interval right_, up_;  ///< of what the lines stand on, from the centre
    std::uint32_t lines_ = 0;
    std::array<Moments, kReplicates> sums_;
};

/// The work on numbers that grow until their interval is narrow or time is over.
class Deadline {
  public:
    Deadline(double seconds, const StopFlag* stop);
    /// Whether `lines` more fit in, to judge from the `lines_done` so far.
    [[nodiscard]] bool allows(double lines, double lines_done) const;

  private:
    double seconds_;
    const StopFlag* stop_;
    double begin_;
};

/// Widens an interval by what rounding does to the spans, relative to the numbers involved.
[[nodiscard]] Estimate with_rounding(Estimate estimate, double magnitude);

/// Widens the interval of a volume where the solid fills its shadow's rectangle so well that hardly
/// one of `lines` missed it, yet not all lines are alike: what the corners lack is too rare to show
/// in the scatter, and only bounded by how often it was not seen.
[[nodiscard]] Estimate with_rare_misses(Estimate volume, std::uint64_t misses, double lines);

/// Mean of the replicates with its interval.
[[nodiscard]] Estimate estimate_of(const Replicates& replicates);

}  // namespace alhazen
