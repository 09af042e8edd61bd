#pragma once
/// Flatness of sub-patches in pixels, their edges, and splitting.
///
/// Source: Lane, Carpenter, Whitted and Blinn, "Scan Line Methods for Displaying Parametrically
/// Defined Surfaces", CACM 23(1), 1980 (flat: planar, with straight boundary curves; a patch that
/// is flat in one direction is split in the other only); Clark, "A Fast Scan-Line Algorithm for
/// Rendering Parametric Surfaces", SIGGRAPH 1979 (an edge that is straight is replaced by its
/// chord).
/// Differs: control points of a straight edge move to the nearest points of the chord, not to its
/// thirds. Distances include depth, in pixels at the depth of the point, so that depths are as
/// exact as silhouettes.
/// Conventions: whether an edge is straight depends only on its own control points, in either
/// direction: two patches that share an edge agree.
/// Complexity: constant for a sub-patch.

#include <array>

#include "alhazen/renderers/lane_carpenter/options.h"
#include "alhazen/renderers/lane_carpenter/sample_grid.h"
#include "alhazen/renderers/lane_carpenter/sub_patch.h"

namespace alhazen {

/// The degrees of a patch.
struct PatchDegrees {
    int u = 3, v = 3;
    [[nodiscard]] int count() const { return (u + 1) * (v + 1); }
};

/// Halves of a net of control points at u = 1/2 or v = 1/2, by midpoints.
void halve_net_u(PatchDegrees degrees, const HomogeneousPoint* net, HomogeneousPoint* low,
                 HomogeneousPoint* high);
void halve_net_v(PatchDegrees degrees, const HomogeneousPoint* net, HomogeneousPoint* low,
                 HomogeneousPoint* high);

/// The segment between two points of the picture, in pixels of three dimensions; the same bits if
/// the points are exchanged.
struct ScreenChord {
    ScreenPoint from;
    double scale = 0;  ///< pixels per unit of nearness
    Vec3 along;
    double squared = 0;  ///< squared length

    ScreenChord(const ScreenView& view, const ScreenPoint& a, const ScreenPoint& b);
    /// True if the squared distance of `p` is at most `squared_distance`.
    [[nodiscard]] bool is_within(const ScreenPoint& p, double squared_distance) const;
};

class Subdivision {
  public:
    /// `keeps_seams`: sub-patches with an edge between samples are not dropped.
    Subdivision(const ScreenView& view, const SampleGrid& grid, const ScanLineOptions& options,
                double flatness, bool keeps_seams)
        : view_(view),
          grid_(grid),
          split_(options.split),
          clark_(options.cracks == Cracks::Clark),
          keeps_seams_(keeps_seams),
          squared_(flatness * flatness) {}

    /// Sets step, rows and edges of a sub-patch from its parameters and points.
    void judge(PatchDegrees degrees, SubPatch& patch) const;

    /// Splits by `parent.step` into children, which must then be judged. Returns their number.
    int split(PatchDegrees degrees, const SubPatch& parent,
              const std::array<SubPatch*, 4>& children) const;

  private:
    using Projected = std::array<ScreenPoint, kMaxPatchOrder * kMaxPatchOrder>;

    void judge_before_eye(PatchDegrees degrees, SubPatch& patch) const;
    [[nodiscard]] bool is_out_of_view(PatchDegrees degrees, const SubPatch& patch) const;
    void find_straight_sides(PatchDegrees degrees, SubPatch& patch, Projected& at) const;
    /// Moves the control points of a side to the nearest points of its chord, which preserves the
    /// parameters along it, so that the adjacent patch does not slide.
    void straighten(PatchDegrees degrees, std::size_t side, SubPatch& patch, Projected& at) const;
    /// Parameter, 0 to 1, of the point of the chord from a to b that is nearest to p.
    [[nodiscard]] double share_of_chord(const ScreenPoint& p, const ScreenPoint& a,
                                        const ScreenPoint& b) const;
    [[nodiscard]] bool in_reach(const ScreenPoint& p) const {
        return std::abs(p.x) <= view_.reach() && std::abs(p.y) <= view_.reach();
    }
    [[nodiscard]] bool is_row_straight(const ScreenPoint* row, int degree, int stride) const;
    [[nodiscard]] PatchStep step_of(PatchDegrees degrees, const SubPatch& patch,
                                    const Projected& at) const;

    ScreenView view_;
    const SampleGrid& grid_;
    SplitRule split_;
    bool clark_, keeps_seams_;
    double squared_;
};

}  // namespace alhazen
