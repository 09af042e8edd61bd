#pragma once
/// Parallel lines through a solid over a net of cells, and what they sum to.
///
/// Source, Differs, Conventions: see solid_measures.h, of which this is the inside.

#include <array>
#include <vector>

#include "alhazen/base/progress.h"
#include "alhazen/sampling/confidence.h"
#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

/// Half samples of every estimate; a power of two.
inline constexpr std::size_t kReplicates = 16;
/// An estimate by each of the half samples, or by independent sets of lines.
using Replicates = std::array<double, kReplicates>;

/// Sums over spans of moments up to the second.
struct Moments {
    double volume = 0;
    Vec3 first;
    std::array<double, 6> second{};  ///< xx, yy, zz, xy, yz, zx
    double cosines = 0;
    double measured = 0;  ///< volume or cosines, less the model of them: as precise as can be

    Moments& operator+=(const Moments& other);
    [[nodiscard]] Moments operator*(double factor) const;
};

/// A right-handed frame: lines run along `d`, and stand on the plane of the other two.
struct BundleFrame {
    Vec3 d, right, up;
};

/// The lines of one direction. Where they stand is cut into cells, finer where what they measure
/// varies; in every cell there are two pairs of lines, each pair opposite of each other about the
/// middle. A half sample takes one pair of each cell, twice.
///
/// Which cells are cut is told by a survey: lines that are no part of the estimate, seven for a
/// cell, and beyond it on all sides, so that a rim which only touches a corner is seen. They also
/// give the curvature of what is measured, a model of it that is taken away from the lines of the
/// cell and added as its integral.
class StratifiedChords {
  public:
    enum class Measured { Volume, Area };

    /// `center`: moments are about it.
    StratifiedChords(const Measurable& solid, const BundleFrame& frame, const Vec3& center,
                     std::uint64_t key, Measured measured = Measured::Volume);

    [[nodiscard]] const Vec3& direction() const { return frame_.d; }
    /// That the estimates are made of.
    [[nodiscard]] std::uint64_t lines() const { return casts_ * kLinesPerCell * cells_.size(); }
    /// As many as there would be if they lay everywhere as where they are sparsest.
    [[nodiscard]] double sparsest() const;
    /// Cuts the cells until there are about so many lines, and casts all lines anew. Where there
    /// are as many cells already, casts other lines and keeps the earlier ones. Returns the number
    /// of lines cast, those of surveys included: about kCostOfLine for each.
    std::uint64_t grow_to(std::uint64_t lines);
    static constexpr double kCostOfLine = 2.25;

    /// By a half sample. Cosines sum to this direction's share of the area; they are those of a
    /// bundle that measures the area only.
    [[nodiscard]] Moments moments(std::size_t replicate) const;
    [[nodiscard]] Replicates volumes() const;
    [[nodiscard]] Replicates areas() const;
    /// Lines whose crossings did not come in pairs, of all that were ever cast.
    [[nodiscard]] std::uint64_t inconsistent() const { return inconsistent_; }
    /// Of one round.
    [[nodiscard]] std::uint64_t lines_of_round() const { return kLinesPerCell * cells_.size(); }
    /// Lines that missed the solid.
    [[nodiscard]] std::uint64_t misses() const { return sums_.misses; }

  private:
    /// Second derivatives, xx, xy, yy, where half a cell's side is 1.
    using Curvature = std::array<float, 3>;
    /// A part of the unit square.
    struct Cell {
        double x, y;
        float size;
        float scatter = 0;  ///< guess of the variance of the two pairs, in units of scale_
        Curvature curvature{};
        float trust = 0;  ///< share of the curvature that the model takes: 0 where it is no model
        bool quarter = false;  ///< of a cell that was surveyed
        bool surveyed = false;

        [[nodiscard]] double area() const { return double{size} * size; }
        [[nodiscard]] std::array<Cell, 4> quarters() const;
    };
    static constexpr std::uint64_t kLinesPerCell = 4;
    struct Sums {
        Moments all;
        /// First pair less the second one, of the cells of each row of the Hadamard matrix.
        std::array<Moments, kReplicates> differences;
        std::uint64_t inconsistent = 0, misses = 0, lines = 0;  ///< lines: of surveys

        Sums& operator+=(const Sums& other);
    };

    void make_grid(std::size_t cells);
    void survey();
    void survey_cell(Cell& cell, std::uint64_t bits, LineSpans& found, Sums& sums) const;
    void cut(std::size_t cells);
    void cast();
    void cast_in(Cell& cell, std::uint64_t number, LineSpans& found, Sums& sums) const;
    void cast_pair(const Cell& cell, std::uint64_t bits, LineSpans& found, Moments& pair,
                   Sums& sums) const;
    /// Casts the line at a place of the unit square; returns where it stands.
    Vec3 cast_line(double x, double y, LineSpans& found, Sums& sums) const;
    template <class F>
    Sums over_cells(F&& f);
    [[nodiscard]] double share() const;

    const Measurable& solid_;
    BundleFrame frame_;
    Vec3 center_;
    std::uint64_t key_;
    Measured measured_;
    Interval right_, up_;  ///< of what the lines stand on, from the centre
    double scale_;         ///< what is measured by a line is some share of it
    std::vector<Cell> cells_;
    std::uint64_t rounds_ = 0, casts_ = 0;  ///< in all, and since the cells were cut
    std::uint64_t inconsistent_ = 0;
    std::uint64_t missed_ = 0;    ///< lines that missed, of all
    std::uint64_t surveyed_ = 0;  ///< lines of surveys
    Sums sums_;
};

/// The work on numbers that grow until their interval is narrow or time is over.
class Deadline {
  public:
    Deadline(double seconds, const StopFlag* stop);
    /// Whether `lines` more fit in, to judge from the `lines_done` so far.
    [[nodiscard]] bool allows(double lines, double lines_done) const {
        return lines <= room(lines_done);
    }
    /// How many more fit in.
    [[nodiscard]] double room(double lines_done) const;

  private:
    double seconds_;
    const StopFlag* stop_;
    double begin_;
};

/// Widens an interval by what rounding does to the spans, relative to the numbers involved.
[[nodiscard]] Estimate with_rounding(Estimate estimate, double magnitude);

/// Widens the interval of a volume where the solid fills its shadow's rectangle so well that hardly
/// one of the lines missed it, yet not all lines are alike: what the corners lack is too rare to
/// show in the scatter, and only bounded by how often it was not seen. `lines`: as many as
/// StratifiedChords has where they are sparsest.
[[nodiscard]] Estimate with_rare_misses(Estimate volume, std::uint64_t misses, double lines);

/// The estimate whose half samples these are, with its interval.
[[nodiscard]] Estimate half_sample_estimate(const Replicates& half_samples);

}  // namespace alhazen
