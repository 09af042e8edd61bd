#pragma once
/// The crossings of a line with a cell of a patch: Newton's method where it provably finds the one
/// root, halving where that is not proven.
///
/// Source: Toth, "On Ray Tracing Parametric Surfaces", SIGGRAPH 1985 (a test that Newton's method
/// converges, else halving); Gale and Nikaido, "The Jacobian Matrix and Global Univalence of
/// Mappings", Mathematische Annalen 159, 1965 (why the test implies at most one root).
/// Differs: the test bounds the derivative's change over the cell by Bernstein coefficients, in
/// place of interval arithmetic; a root near a border is settled by winding numbers
/// (patch_borders.h).
/// Conventions: docs/design/patches.md has the proofs and bounds.

#include "alhazen/shapes/patches/patch_borders.h"
#include "alhazen/shapes/patches/patch_value.h"

namespace alhazen {

/// A bicubic patch relative to a line: the weighted control points minus the line's origin, along
/// the axes of the line's plane (x, y) and along the line (z).
struct alignas(64) CubicLine {
    double x[16], y[16], z[16];
};
/// A cell of a CubicLine, without z. Lanes may read up to two numbers past the end of a row, with
/// factor zero: past x is y, past y is `rest`.
struct alignas(64) CubicCell {
    double x[16], y[16];
    double rest[4];  ///< zero
};

/// A crossing, with the parameters of the patch.
struct PatchRoot {
    double t = 0, u = 0, v = 0;
};

/// Largest |F_aa| + 2 |F_ab| + |F_bb| of a certified cell, for each of the line's two equations F,
/// in the cell's own parameters from -1 to 1, with the equations solved for these at the middle,
/// over the cell with its margin. A certified cell has at most one root; it is within half of this
/// bound from the first step of Newton's method from the middle, and the method converges to it.
inline constexpr double kCertified = 0.5;
/// Bound up to which there is at most one root; Newton's method may not find it.
inline constexpr double kUnique = 0.95;
/// Fraction of a cell's width that is added on each side.
inline constexpr double kCellMargin = 0x1p-10;

/// The certified function: the point, or the point times its weight, relative to the line's origin.
/// Equal for patches without weights.
enum class RootOf { Point, WeightedPoint };

/// What is proven of Newton's method in a cell: it converges, or the root to which it converges is
/// the only one.
enum class NewtonProof { Converges, Unique };

/// Finds the root in a cell from (u, v), the first step of Newton's method from its middle. `noise`
/// is the rounding error of a step in widths of the cell, if above kCellMargin. With
/// NewtonProof::Unique the result false is inconclusive.
[[nodiscard]] bool certified_root(NewtonProof proof, RootOf what, BezierView net,
                                  const PatchLine& line, const PatchCell& cell, double noise,
                                  double u, double v, PatchRoot& root);

/// The part of a line in which roots are required, by distance from its origin, for a cell whose
/// second derivatives |S_aa| + 2 |S_ab| + |S_bb|, in half-widths, are at most `bend`.
struct LineRange {
    double least, most, bend;
};

/// The same for a bicubic patch, with RootOf::WeightedPoint. A root outside of `range` may be
/// omitted: then false, if the root is that of a certified cell.
[[nodiscard]] bool certified_root(NewtonProof proof, BezierView net, const CubicLine& seen,
                                  const PatchLine& line, const PatchCell& cell, double noise,
                                  double u, double v, const LineRange* range, PatchRoot& root);

struct CubicRoot;  // the result of Newton's method: patch_lanes.h

/// True if the result of Newton's method for a bicubic patch lies in its cell.
[[nodiscard]] bool is_root(const BezierView& net, const PatchLine& line, const PatchCell& cell,
                           const CubicRoot& at, PatchRoot& root);

/// The parts of CellSearch that do not depend on how cells are stored.
class CellSettling {
  public:
    CellSettling(BezierView net, const PatchLine& line) : net_(net), line_(line) {}

  protected:
    [[nodiscard]] bool settle(PatchCell cell, PatchRoot& root) const;
    /// The `t` of the result is not set.
    [[nodiscard]] PatchRoot nearest_point(const PatchCell& cell) const;

    BezierView net_;
    const PatchLine& line_;
};

/// Additional state of a search, for bicubic patches.
template <class Net>
struct CellSearchFacts {};
template <>
struct CellSearchFacts<CubicCell> {
    const CubicLine* seen = nullptr;
    const LineRange* range = nullptr;
    PatchCell whole{};  ///< the cell to which `range` applies
};

/// Iterates over the roots in a cell, halving it until its parts are certified or tiny. `Net` is
/// the cell relative to the line: a CubicCell for bicubic patches, a PlaneNet for others.
template <class Net>
class CellSearch : private CellSettling, private CellSearchFacts<Net> {
  public:
    CellSearch(BezierView net, const PatchLine& line, const PatchCell& cell);
    /// For a bicubic patch. Roots outside of the range, if given, may be omitted.
    CellSearch(BezierView net, const PatchLine& line, const PatchCell& cell, const CubicLine& seen,
               const LineRange* range);

    /// Finds the next root; false if there are no more.
    bool next(PatchRoot& root);

  private:
    struct Entry {
        Net net;
        PatchCell cell;
    };
    // Each halving leaves one entry.
    static constexpr int kMostEntries = 2 * kMaxCellLevel + 3;
    // Exceeded only by patches that degenerate to curves.
    static constexpr int kMostCells = 4000;

    void push_halves(bool along_u);
    [[nodiscard]] bool find_root(NewtonProof proof, const PatchCell& cell, double noise, double u,
                                 double v, PatchRoot& root) const;

    int size_ = 0, cells_ = 0;
    Entry stack_[kMostEntries];
};

}  // namespace alhazen
