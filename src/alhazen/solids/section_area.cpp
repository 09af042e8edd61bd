// The area of the section of a solid by a plane: sums over lines in the plane.

#include <algorithm>
#include <cmath>

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

/// Parallel lines along one direction in the plane.
class LineRow {
  public:
    LineRow(const Measurable& solid, const Vec3& origin, const Vec3& along, const Vec3& aside,
            std::uint64_t key)
        : solid_(solid), origin_(origin), along_(along), aside_(aside), key_(mix64(key)) {
        const Interval extent = solid.extent(aside);
        const double shift = dot(aside, origin);
        range_ = {extent.lo - shift, extent.hi - shift};
    }

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
            area[r] = range_.width() * sums_[r].lengths / lines_;
        }
        return mean_of(area);
    }
    [[nodiscard]] double width() const { return range_.width(); }
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
            const double s = range_.lo + range_.width() * scrambled_sobol(key_ + replicate, i, 0);
            solid_.cross({origin_ + s * aside_, along_}, false, found);
            sum.inconsistent += found.consistent ? 0 : 1;
            sum.ends += 2.0 * static_cast<double>(found.spans.size());
            for (const Interval& span : found.spans) sum.lengths += span.hi - span.lo;
        }
        return sum;
    }

    const Measurable& solid_;
    Vec3 origin_, along_, aside_;
    std::uint64_t key_;
    Interval range_;
    std::uint32_t lines_ = 0;
    std::array<Sum, kReplicates> sums_;
};

}  // namespace

PlaneFrame frame_of(const SectionPlane& plane) {
    const double size = length(plane.normal);
    if (!(size > 0.0) || !std::isfinite(size) || !std::isfinite(plane.offset)) {
        throw Error(ErrorKind::Usage,
                    "a plane needs a normal that is not zero, and finite numbers");
    }
    const Vec3 n = plane.normal / size;
    const Vec3 right = std::hypot(n.x, n.y) > 1e-9 ? normalize(cross({0, 0, 1}, n)) : Vec3{1, 0, 0};
    return {(plane.offset / size) * n, right, cross(n, right), n};
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
        throw Error(ErrorKind::Usage, "the solid is not bounded: its section may have no area");
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
        LineRow pilot(solid, origin, along, cross(frame.normal, along),
                      options.seed + static_cast<std::uint64_t>(1000 * turn));
        pilot.grow_to(kPilotLinesInPlane);
        done += kReplicates * kPilotLinesInPlane;
        const double spread = pilot.area().half_width;
        if (turn == 0.0 || spread < least) {
            least = spread;
            best = along;
        }
    }
    LineRow row(solid, origin, best, cross(frame.normal, best), mix64(options.seed) + 5);
    row.grow_to(kFirstLinesInPlane);
    const double slack =
        kRounding * (solid.magnitude() + std::abs(plane.offset) / length(plane.normal));
    const double length_of_rows = solid.extent(best).width();
    for (;;) {
        const Estimate area = row.area();
        // Error of an outline displaced by the slack. The length of the outline is at most about
        // both extents times the mean number of crossings of a line.
        const double outline = row.ends() * (length_of_rows + row.width());
        found.area = with_rounding(area, slack * outline + kSumming * area.value);
        found.reached = found.area.half_width <= options.relative_error * found.area.value;
        const double lines = static_cast<double>(kReplicates) * row.lines();
        done += lines;
        if (found.reached || row.lines() >= kMostLines || !deadline.allows(lines, done)) {
            break;
        }
        row.grow_to(2 * row.lines());
    }
    found.lines = static_cast<std::uint64_t>(done);
    found.inconsistent_lines = row.inconsistent();
    return found;
}

}  // namespace alhazen
