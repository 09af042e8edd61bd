#pragma once
/// Sums over parallel lines through a solid, stratified over grids of cells.
///
/// Implementation of solid_measures.h, which gives source, differences and conventions.

#include <array>
#include <cstdint>
#include <limits>

#include "alhazen/base/progress.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/sampling/confidence.h"
#include "alhazen/solids/chord_cells.h"
#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

/// Number of half samples of every estimate; a power of two.
inline constexpr std::size_t kReplicates = 16;
/// Error of the ends of spans, relative to the magnitude of the numbers they are computed from.
inline constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
/// Rounding error of the sums, relative to the sum of absolute values.
inline constexpr double kSumming = 300 * std::numeric_limits<double>::epsilon();

/// An estimate per half sample, or per independent set of lines.
using Replicates = std::array<double, kReplicates>;

/// Sums over spans of moments up to the second.
struct Moments {
    double volume = 0;
    Vec3 first;
    std::array<double, 6> second{};  ///< xx, yy, zz, xy, yz, zx
    double cosines = 0;
    double ends = 0;      ///< number of ends of spans
    double measured = 0;  ///< volume or cosines minus their model, for precision

    Moments& operator+=(const Moments& other);
    [[nodiscard]] Moments operator*(double factor) const;
};

/// A right-handed frame: lines run along `d`, perpendicular to the plane of the other two.
struct BundleFrame {
    Vec3 d, right, up;
};

/// The lines of one direction. Their base plane is cut into cells, finer where the measured
/// quantity varies. Every cell has two pairs of lines, each pair symmetric about the middle. A half
/// sample takes one pair of each cell, twice.
///
/// A survey chooses the cells to cut: seven lines per cell that are not part of the estimate. They
/// reach beyond the cell on all sides, so that a rim that touches only a corner is seen. Cells that
/// touch differ by a factor of two in their sides at most: where the lines of a cell did not see
/// what reaches into it from a neighbour, that is of the size of a cell there. The lines also give
/// the curvature of the measured quantity: a model that is subtracted from the lines of the
/// cell and added as its integral.
class StratifiedChords {
  public:
    enum class Measured { Volume, Area };

    /// `center`: reference point of the moments.
    StratifiedChords(const Measurable& solid, const BundleFrame& frame, const Vec3& center,
                     std::uint64_t key, Measured measured = Measured::Volume);

    [[nodiscard]] const Vec3& direction() const { return frame_.d; }
    /// Number of lines in the estimates.
    [[nodiscard]] std::uint64_t lines() const { return casts_ * kLinesPerCell * cells_.size(); }
    /// Number of lines if their density were that of the sparsest cells everywhere.
    [[nodiscard]] double sparsest() const;
    /// Cuts the cells until there are about `lines` lines, and casts all lines again. If there are
    /// as many cells already, casts additional lines and keeps the earlier ones. Returns the number
    /// of lines cast, including surveys: about kCostOfLine per line.
    std::uint64_t grow_to(std::uint64_t lines);
    static constexpr double kCostOfLine = 2.25;

    /// Moments of a half sample. For bundles that measure only the area, cosines sum to this
    /// direction's share of it.
    [[nodiscard]] Moments moments(std::size_t replicate) const;
    /// The measured volume, or this direction's share of the area, and its variance from the
    /// differences of the pairs of all cells, without rounding.
    [[nodiscard]] double value() const { return share() * sums_.all.measured; }
    [[nodiscard]] Spread spread() const;
    [[nodiscard]] Estimate estimate() const { return estimate_of(value(), spread()); }
    /// Area of the surface projected along this direction, every layer counted.
    [[nodiscard]] double projected_area() const { return share() * sums_.all.ends; }
    /// Extents of the narrowest rectangles that the lines fill.
    [[nodiscard]] double right_width() const { return right_.width() * cells_.narrowest()[0]; }
    [[nodiscard]] double up_width() const { return up_.width() * cells_.narrowest()[1]; }
    /// Area that a solid's shadow exceeds in at most 5 of 100 cases if no line met the solid; 0 if
    /// one did.
    [[nodiscard]] double unseen_shadow() const;
    /// Number of lines cast so far whose crossings could not be paired.
    [[nodiscard]] std::uint64_t inconsistent() const { return inconsistent_; }
    /// Number of lines in one round.
    [[nodiscard]] std::uint64_t lines_of_round() const { return kLinesPerCell * cells_.size(); }
    /// Number of lines that missed the solid.
    [[nodiscard]] std::uint64_t misses() const { return sums_.misses; }

  private:
    static constexpr std::uint64_t kLinesPerCell = 4;
    struct Sums {
        Moments all;
        /// First pair minus second pair, for the cells of each row of the Hadamard matrix.
        std::array<Moments, kReplicates> differences;
        /// Sums of second and fourth powers of these differences, in units of scale_.
        double squares = 0, fourths = 0;
        std::uint64_t inconsistent = 0, misses = 0, lines = 0;  ///< lines: those of surveys

        Sums& operator+=(const Sums& other);
    };

    /// The cells of the patches that the shadows of the solid's parts cover, not made yet.
    [[nodiscard]] ChordCells shadow() const;
    /// Of the cells that are cut, those that are cut for their size alone.
    [[nodiscard]] double share_for_size() const;
    void survey();
    void survey_cell(ChordCell& cell, std::uint64_t bits, LineSpans& found, Sums& sums) const;
    void cast();
    void cast_in(ChordCell& cell, std::uint64_t number, LineSpans& found, Sums& sums) const;
    void cast_pair(const ChordCell& cell, std::uint64_t bits, LineSpans& found, Moments& pair,
                   Sums& sums) const;
    /// Casts the line at a point of the unit square; returns its base point.
    Vec3 cast_line(double x, double y, LineSpans& found, Sums& sums) const;
    template <class F>
    Sums over_cells(F&& f);
    [[nodiscard]] double share() const;

    const Measurable& solid_;
    BundleFrame frame_;
    Vec3 center_;
    std::uint64_t key_;
    Measured measured_;
    Interval right_, up_;  ///< extent of the base rectangle, relative to the centre
    double scale_;         ///< unit of the value of a line
    ChordCells cells_;     ///< the solid has no shadow elsewhere
    std::uint64_t rounds_ = 0, casts_ = 0;  ///< in total; since the cells were last cut
    std::uint64_t inconsistent_ = 0;
    std::uint64_t missed_ = 0;    ///< lines that missed, in total
    std::uint64_t surveyed_ = 0;  ///< lines of surveys
    Sums sums_;
};

/// A time limit for work whose amount grows until the interval is narrow.
class Deadline {
  public:
    /// Throws Error (Usage) unless `seconds` is a number from 0; it may be infinite.
    Deadline(double seconds, const StopFlag* stop);
    /// True if `lines` more fit into the time, estimated from the `lines_done` so far.
    [[nodiscard]] bool allows(double lines, double lines_done) const {
        return lines <= room(lines_done);
    }
    /// Estimated number of further lines that fit into the time.
    [[nodiscard]] double room(double lines_done) const;

  private:
    double seconds_;
    const StopFlag* stop_;
    Stopwatch time_;
};

/// Throws Error (Usage) unless the requested error is a number from 0.
void check_relative_error(double error);

/// Widens an interval by a bound of the rounding error.
[[nodiscard]] Estimate with_rounding(Estimate estimate, double rounding);

/// Widens the interval of a volume if the solid fills the rectangle of its projection so well that
/// hardly a line missed it, yet lines differ: empty corners are too rare to show in the variance,
/// and bounded only by the number of misses. `lines`: see StratifiedChords::sparsest. Lines that
/// differ by at most `rounding` count as equal.
[[nodiscard]] Estimate with_rare_misses(Estimate volume, std::uint64_t misses, double lines,
                                        double rounding);

/// The estimate of half samples, with its interval. `degrees`: degrees of freedom of the variance
/// that the cells give; where few of them scatter, half samples have no more.
[[nodiscard]] Estimate half_sample_estimate(const Replicates& half_samples, double degrees);

}  // namespace alhazen
