// The area of the section of a solid by a plane: sums over lines in the plane.

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/sampling/random.h"
#include "alhazen/sampling/sobol.h"
#include "alhazen/solids/solid_measures.h"
#include "alhazen/solids/stratified_chords.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kPilotLinesInPlane = 128;
constexpr std::uint32_t kFirstLinesInPlane = 512;
constexpr std::uint32_t kMostLines = std::uint32_t{1} << 27;
constexpr std::uint32_t kLinesPerTask = 1024;
/// Lines of a replicate after which a section that none of them met is taken for empty, with the
/// interval of all lines.
constexpr std::uint32_t kMostUnmet = 1 << 15;
/// Hanley and Lippman-Hand 1983: what n lines did not meet has a share of at most 3 / n.
constexpr double kUnmetOfLines = 3;

/// The ranges of dot(aside, p - origin) of the parts of a solid that the plane may cut: disjoint,
/// ascending.
std::vector<Interval> ranges_of(const Measurable& solid, const PlaneFrame& frame,
                                const Vec3& origin, const Vec3& aside) {
    std::vector<Interval> across, beside, merged;
    solid.part_extents(frame.normal, across);
    solid.part_extents(aside, beside);
    const double place = dot(frame.origin, frame.normal), shift = dot(aside, origin);
    std::vector<Interval> cut;
    for (std::size_t i = 0; i < across.size(); ++i) {
        if (!across[i].contains(place) || beside[i].empty()) continue;
        cut.push_back({beside[i].lo - shift, beside[i].hi - shift});
    }
    std::sort(cut.begin(), cut.end(),
              [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
    for (const Interval& range : cut) {
        if (!merged.empty() && range.lo <= merged.back().hi) {
            merged.back().hi = std::max(merged.back().hi, range.hi);
        } else {
            merged.push_back(range);
        }
    }
    return merged;
}

/// Parallel lines along one direction in the plane, where the solid's parts may be.
class LineRow {
  public:
    LineRow(const Measurable& solid, const PlaneFrame& frame, const Vec3& origin, const Vec3& along,
            std::uint64_t key)
        : solid_(solid),
          origin_(origin),
          along_(along),
          aside_(cross(frame.normal, along)),
          key_(mix64(key)),
          ranges_(ranges_of(solid, frame, origin, aside_)) {
        for (const Interval& range : ranges_) {
            width_ += range.width();
            reach_.push_back(width_);
        }
    }
    /// True if the plane cuts no part.
    [[nodiscard]] bool empty() const { return !(width_ > 0.0); }

    void grow_to(std::uint32_t lines) {
        const std::uint32_t fresh = lines - lines_;
        const std::size_t tasks = (fresh + kLinesPerTask - 1) / kLinesPerTask;
        std::vector<Sum> parts(kReplicates * tasks);
        parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t task = begin; task < end; ++task) {
                const auto first = static_cast<std::uint32_t>(task % tasks) * kLinesPerTask;
                parts[task] = sum_of(task / tasks, lines_ + first,
                                     lines_ + std::min(fresh, first + kLinesPerTask));
            }
        });
        for (std::size_t task = 0; task < parts.size(); ++task) {
            sums_[task / tasks].lengths += parts[task].lengths;
            sums_[task / tasks].ends += parts[task].ends;
            sums_[task / tasks].inconsistent += parts[task].inconsistent;
        }
        lines_ = lines;
    }
    [[nodiscard]] std::uint32_t lines() const { return lines_; }
    [[nodiscard]] Estimate area() const {
        Replicates area{};
        for (std::size_t r = 0; r < kReplicates; ++r) {
            area[r] = width_ * sums_[r].lengths / lines_;
        }
        return mean_of(area);
    }
    [[nodiscard]] double width() const { return width_; }
    /// Bound of the area, for chords of a length, if no line met the solid; else 0.
    [[nodiscard]] double unseen(double length) const {
        if (ends() > 0) return 0;
        return kUnmetOfLines / (double{kReplicates} * lines_) * width_ * length;
    }
    /// Mean number of ends of spans on a line.
    [[nodiscard]] double ends() const {
        double sum = 0;
        for (const Sum& s : sums_) sum += s.ends;
        return sum / (double{kReplicates} * lines_);
    }
    [[nodiscard]] std::uint64_t inconsistent() const {
        std::uint64_t sum = 0;
        for (const Sum& s : sums_) sum += s.inconsistent;
        return sum;
    }

  private:
    struct Sum {
        double lengths = 0;
        double ends = 0;
        std::uint64_t inconsistent = 0;
    };

    [[nodiscard]] Sum sum_of(std::size_t replicate, std::uint32_t begin, std::uint32_t end) const {
        Sum sum;
        LineSpans found;
        for (std::uint32_t i = begin; i < end; ++i) {
            const double s = place_of(width_ * scrambled_sobol(key_ + replicate, i, 0));
            solid_.cross({origin_ + s * aside_, along_}, false, found);
            sum.inconsistent += found.consistent ? 0 : 1;
            sum.ends += 2.0 * static_cast<double>(found.spans.size());
            for (const Interval& span : found.spans) sum.lengths += span.hi - span.lo;
        }
        return sum;
    }

    /// The point of the ranges that lies so far along them.
    [[nodiscard]] double place_of(double along) const {
        const auto at = std::upper_bound(reach_.begin(), reach_.end() - 1, along);
        const auto k = static_cast<std::size_t>(at - reach_.begin());
        return ranges_[k].lo + (along - (k == 0 ? 0.0 : reach_[k - 1]));
    }

    const Measurable& solid_;
    Vec3 origin_, along_, aside_;
    std::uint64_t key_;
    std::vector<Interval> ranges_;
    std::vector<double> reach_;  ///< [range] sum of the widths up to its end
    double width_ = 0;
    std::uint32_t lines_ = 0;
    std::array<Sum, kReplicates> sums_;
};

}  // namespace

PlaneFrame frame_of(const SectionPlane& plane) {
    // Divided by the largest component first: squares of others may overflow or vanish.
    const double largest = max_component(abs(plane.normal));
    if (!(largest > 0.0) || !is_finite(plane.normal) || !std::isfinite(plane.offset)) {
        throw Error(ErrorKind::Usage,
                    "a plane needs a normal that is not zero, and finite numbers");
    }
    const double size = length(plane.normal / largest);
    const Vec3 n = plane.normal / largest / size;
    const Vec3 right = std::hypot(n.x, n.y) > 1e-9 ? normalize(cross({0, 0, 1}, n)) : Vec3{1, 0, 0};
    const double distance = plane.offset / largest / size;
    if (!std::isfinite(distance)) {
        throw Error(ErrorKind::Usage, "the plane is too far away for its distance to be a number");
    }
    return {distance * n, right, cross(n, right), n};
}

SectionArea section_area(const Measurable& solid, const SectionPlane& plane,
                         const MeasureOptions& options) {
    check_relative_error(options.relative_error);
    const Deadline deadline(options.seconds, options.stop);
    const PlaneFrame frame = frame_of(plane);
    const Box3 box = solid.box();
    SectionArea found;
    if (box.empty() || !solid.extent(frame.normal).contains(dot(frame.origin, frame.normal))) {
        found.reached = true;
        return found;
    }
    if (!box.bounded()) {
        throw Error(ErrorKind::Usage,
                    "the solid has no bounded box; if it is bounded, intersect it with a box");
    }
    // An origin in the middle of the box keeps numbers small.
    const Vec3 center = box.center();
    const Vec3 origin = center - dot(center - frame.origin, frame.normal) * frame.normal;
    // Along the axes of the plane, and oblique to them: lines along an edge have a large variance.
    double least = 0;
    Vec3 best;
    double done = 0;
    for (const double turn : {0.0, 0.6435, 1.5708, 2.2143}) {
        const Vec3 along = turn == 0.0 ? frame.right
                           : turn == 1.5708
                               ? frame.up
                               : std::cos(turn) * frame.right + std::sin(turn) * frame.up;
        LineRow pilot(solid, frame, origin, along,
                      options.seed + static_cast<std::uint64_t>(1000 * turn));
        if (pilot.empty()) {
            found.reached = true;
            return found;
        }
        pilot.grow_to(kPilotLinesInPlane);
        done += kReplicates * kPilotLinesInPlane;
        const double spread =
            pilot.ends() > 0 ? pilot.area().half_width : std::numeric_limits<double>::infinity();
        if (turn == 0.0 || spread < least) {
            least = spread;
            best = along;
        }
    }
    LineRow row(solid, frame, origin, best, mix64(options.seed) + 5);
    row.grow_to(kFirstLinesInPlane);
    const double slack = kRounding * (solid.magnitude() + length(frame.origin));
    double length_of_rows = 0;  // of the parts along the lines
    for (const Interval& range : ranges_of(solid, frame, origin, best)) {
        length_of_rows += range.width();
    }
    for (;;) {
        const Estimate area = row.area();
        // Error of an outline displaced by the slack. The length of the outline is at most about
        // both extents times the mean number of crossings of a line.
        const double outline = row.ends() * (length_of_rows + row.width());
        found.area = with_rounding(area, slack * outline + kSumming * area.value);
        found.area.half_width += row.unseen(length_of_rows);
        found.reached = found.area.half_width <= options.relative_error * found.area.value;
        const double lines = static_cast<double>(kReplicates) * row.lines();
        done += lines;
        const std::uint32_t most = row.ends() > 0 ? kMostLines : kMostUnmet;
        if (found.reached || row.lines() >= most || !deadline.allows(lines, done)) {
            break;
        }
        row.grow_to(2 * row.lines());
    }
    found.lines = static_cast<std::uint64_t>(done);
    found.inconsistent_lines = row.inconsistent();
    return found;
}

}  // namespace alhazen
