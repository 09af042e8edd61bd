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

/// A bicubic patch from a line: the control points times their weights from its origin, along the
/// axes of its plane and along the line.
struct alignas(64) CubicLine {
    double x[16], y[16], z[16];
};
/// A cell of it, without the distance. Rows are read up to two numbers beyond the last, times zero:
/// of x the first of y, of y those of `rest`.
struct alignas(64) CubicCell {
    double x[16], y[16];
    double rest[4];  ///< zero
};

/// A crossing, in the parameters of the patch.
struct PatchRoot {
    double t = 0, u = 0, v = 0;
};

/// In a cell's own parameters from -1 to 1, with the line's two equations solved for them at its
/// middle: the cell is certified where the second derivatives' sum |F_aa| + 2 |F_ab| + |F_bb| is at
/// most this, for each of the two, over the cell with its margin. Then there is at most one root;
/// it is within half of this of the first step of Newton's method from the middle, which converges.
inline constexpr double kCertified = 0.5;
/// Up to this there is at most one root, but Newton's method may not find it.
inline constexpr double kUnique = 0.95;
/// Part of a cell's width that is added on each side.
inline constexpr double kCellMargin = 0x1p-10;

/// What is certified: the point, or the point times its weight, from the line's origin. The same
/// for patches without weights.
enum class RootOf { Point, WeightedPoint };

/// What is known of Newton's method in a cell: that it converges, or that what it converges to is
/// the only root.
enum class NewtonProof { Converges, Unique };

/// Finds the root in a cell from (u, v), the first step of Newton's method from its middle. `noise`
/// is the rounding error of a step in widths of the cell, where above kCellMargin. With
/// NewtonProof::Unique false says nothing of the cell.
[[nodiscard]] bool certified_root(NewtonProof proof, RootOf what, BezierView net,
                                  const PatchLine& line, const PatchCell& cell, double noise,
                                  double u, double v, PatchRoot& root);

/// Part of a line that roots may be left out beyond, by distance from its origin, in a cell whose
/// second derivatives |S_aa| + 2 |S_ab| + |S_bb|, in half-widths, are at most `bend`.
struct LineRange {
    double least, most, bend;
};

/// The same for a bicubic patch, of the point times its weight. A root out of `range` may be left
/// out: then false, where the root is that of a certified cell.
[[nodiscard]] bool certified_root(NewtonProof proof, BezierView net, const CubicLine& seen,
                                  const PatchLine& line, const PatchCell& cell, double noise,
                                  double u, double v, const LineRange* range, PatchRoot& root);

struct CubicRoot;  // what Newton's method converges to: patch_lanes.h

/// Whether what Newton's method converges to is in its cell, of a bicubic patch.
[[nodiscard]] bool is_root(const BezierView& net, const PatchLine& line, const PatchCell& cell,
                           const CubicRoot& at, PatchRoot& root);

/// The parts of CellSearch that do not depend on how cells are stored.
class CellSettling {
  public:
    CellSettling(BezierView net, const PatchLine& line) : net_(net), line_(line) {}

  protected:
    [[nodiscard]] bool settle(PatchCell cell, PatchRoot& root) const;
    /// Without its t.
    [[nodiscard]] PatchRoot nearest_point(const PatchCell& cell) const;

    BezierView net_;
    const PatchLine& line_;
};

/// The other facts of a search; bicubic patches have some.
template <class Net>
struct CellSearchFacts {};
template <>
struct CellSearchFacts<CubicCell> {
    const CubicLine* seen = nullptr;
    const LineRange* range = nullptr;
    PatchCell whole{};  ///< what `range` is of
};

/// Calls for each root in a cell: halves it until its parts are certified or tiny. `Net` is what
/// the line sees of a cell: a CubicCell of bicubic patches, a PlaneNet of others.
template <class Net>
class CellSearch : private CellSettling, private CellSearchFacts<Net> {
  public:
    CellSearch(BezierView net, const PatchLine& line, const PatchCell& cell);
    /// Of a bicubic patch. With a range roots beyond it may be left out.
    CellSearch(BezierView net, const PatchLine& line, const PatchCell& cell, const CubicLine& seen,
               const LineRange* range);

    /// Finds the next root; false where there are no more.
    bool next(PatchRoot& root);

  private:
    struct Entry {
        Net net;
        PatchCell cell;
    };
    // Each halving leaves one entry.
    static constexpr int kMostEntries = 2 * kMaxCellLevel + 3;
    // Only patches that are mere curves need more.
    static constexpr int kMostCells = 4000;

    void push_halves(bool along_u);
    [[nodiscard]] bool find_root(NewtonProof proof, const PatchCell& cell, double noise, double u,
                                 double v, PatchRoot& root) const;

    int size_ = 0, cells_ = 0;
    Entry stack_[kMostEntries];
};

}  // namespace alhazen
