#include "alhazen/accel/directions/light_buffer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"

namespace alhazen {
std::uint32_t& LastOccluders::of(std::uint64_t buffer, std::size_t light) {
    struct Entry {
        std::uint64_t buffer = 0;
        std::size_t light = 0;
        std::uint32_t primitive = kNone;
    };
    static thread_local std::array<Entry, 64> entries;
    Entry& entry = entries[(buffer * 31 + light) % entries.size()];
    if (entry.buffer != buffer || entry.light != light) entry = {buffer, light, kNone};
    return entry.primitive;
}

std::uint64_t LastOccluders::new_number() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

/// Makes the lists of all lights, one after another.
class LightBufferBuilder {
  public:
    LightBufferBuilder(const BoundsSource& source, LightBuffer& made)
        : source_(source), made_(made), bodies_(source), margin_(4 * made.ends_.margin()) {}

    void run() {
        for (const Vec3& light : made_.ends_.places()) add_light(light);
    }

  private:
    struct Entry {
        std::size_t cell;
        double begin;
        std::uint32_t body;
    };

    void add_light(const Vec3& light) {
        light_ = light;
        LightBuffer::Light& made = made_.lights_.emplace_back();
        windows_ = {};
        for (std::uint32_t i = 0; i < bodies_.size(); ++i) windows_.include(box_from_light(i));
        const double all = windows_.area();
        double of_all = 0, of_small = 0;  // areas of the windows of each
        DirectionWindows small;
        for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
            DirectionWindows own;
            own.include(box_from_light(i));
            const double area = own.area();
            of_all += area;
            if (!(area < kLarge * all)) continue;
            of_small += area;
            small.include(box_from_light(i));
        }
        add_windows(made.all, of_all);
        windows_ = small;
        if (windows_.area() < 0.5 * all) add_windows(made.small, of_small);
    }

    /// Divides the windows and makes the lists of their cells. `covered`: sum of the areas of the
    /// windows of all primitives.
    void add_windows(LightBuffer::Light::Windows& made, double covered) {
        divide(covered);
        cells_.assign(windows_.size(), {});
        entries_.clear();
        for (std::uint32_t i = 0; i < bodies_.size(); ++i) add_body(i);
        std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
            if (a.cell != b.cell) return a.cell < b.cell;
            return a.begin != b.begin ? a.begin < b.begin : a.body < b.body;
        });
        for (const Entry& entry : entries_) {
            LightBuffer::Cell& cell = cells_[entry.cell];
            // Nothing behind the polygon that fills the cell is lit.
            if (entry.begin > cell.filled_to) continue;
            if (cell.count++ == 0) cell.first = static_cast<std::uint32_t>(made_.entries_.size());
            made_.entries_.push_back(entry.body);
            made_.begins_.push_back(entry.begin);
        }
        if (made_.entries_.size() > 0xFFFFFFFFu) {
            throw Error(ErrorKind::Resource,
                        "light_buffer: more than 4294967295 entries in its lists; lower the "
                        "density or the number of lights");
        }
        made = {windows_, made_.cells_.size()};
        made_.cells_.insert(made_.cells_.end(), cells_.begin(), cells_.end());
    }

    void divide(double covered) {
        const LightBuffer::Config& config = made_.config_;
        // Lists of primitives that lie in front of each other would be as long as these are many.
        const double deep = covered / windows_.area() / kMostInDepth;
        const double count =
            std::min(kMostCells, config.density * double(bodies_.size()) / std::fmax(1.0, deep));
        const double edge = config.resolution > 0 ? windows_.longest_edge() / config.resolution
                                                  : std::sqrt(windows_.area() / count);
        windows_.divide(edge, kMostInRow);
    }

    /// A box relative to the light, extended by the deviation of rays.
    [[nodiscard]] Box3 box_from_light(std::uint32_t i) const {
        const Box3& b = bodies_.box(i);
        const Vec3 margin{margin_, margin_, margin_};
        return {b.lo - light_ - margin, b.hi - light_ + margin};
    }

    /// Lower bound of the distance of a primitive from the light.
    [[nodiscard]] double begin_of(const Box3& box, std::uint32_t i) const {
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double beside = std::max(0.0, std::max(box.lo[k], -box.hi[k]));
            square += beside * beside;
        }
        const BoundingSphere& sphere = bodies_.sphere(i);
        const double to_sphere = length(sphere.center - light_) - sphere.radius;
        return std::max(0.0, std::max(std::sqrt(square), to_sphere) - margin_);
    }

    /// Range of normal . (p - light) over the points of a primitive.
    [[nodiscard]] Interval extent(std::uint32_t i, const Vec3& normal, double steepness) const {
        Interval range = bodies_.extent(i, normal, steepness);
        if (bodies_.outline(i).empty()) range = intersection(range, source_.extent(i, normal));
        const double place = dot(normal, light_);
        return {range.lo - place, range.hi - place};
    }

    /// Whether a primitive has points above and below a plane through the light, a u + b v = w on a
    /// face.
    struct Sides {
        bool above, below;
    };
    [[nodiscard]] Sides sides_of(std::uint32_t i, int face, double a, double b, double w) const {
        Vec3 normal = -w * DirectionCube::direction(face, 0, 0);
        normal[(face / 2 + 1) % 3] = a;
        normal[(face / 2 + 2) % 3] = b;
        const double steepness = length(normal);
        const Interval e = extent(i, normal, steepness);
        return {e.hi >= -margin_ * steepness, e.lo <= margin_ * steepness};
    }
    /// Removes columns (side 0) or rows (side 1) at both ends that the primitive does not reach.
    void trim(std::uint32_t i, std::size_t side, DirectionWindows::Cells& cells) const {
        auto& [first, last] = cells.ends[side];
        const double a = side == 0 ? 1 : 0;
        const auto sides = [&](int bound) {
            return sides_of(i, cells.face, a, 1 - a, windows_.bound(cells.face, side, bound));
        };
        while (first < last && !sides(first + 1).below) ++first;
        while (first < last && !sides(last).above) --last;
    }

    void add_body(std::uint32_t i) {
        interruption_point();
        const Box3 box = box_from_light(i);
        const double begin = begin_of(box, i);
        const bool may_fill = made_.config_.full_cells && source_.blocks_light(i);
        for (int face = 0; face < 6; ++face) {
            const auto slopes = DirectionWindows::slopes_of(box, face);
            if (!slopes) continue;
            const auto seen = windows_.cells_of(*slopes, face);
            if (!seen) continue;
            DirectionWindows::Cells cells = *seen;
            trim(i, 0, cells);
            trim(i, 1, cells);
            const auto [columns, rows] = cells.ends;
            const bool corners = columns[0] < columns[1] && rows[0] < rows[1];
            for (int row = rows[0]; row <= rows[1]; ++row) {
                for (int column = columns[0]; column <= columns[1]; ++column) {
                    const DirectionWindows::Slopes at = windows_.slopes_of_cell(face, column, row);
                    const std::size_t cell = windows_.number(face, column, row);
                    const double begin_here = std::max(begin, begin_in(box, face, at));
                    if (!bodies_.outline(i).empty()) {
                        add_polygon(i, face, at, cell, begin_here, may_fill);
                    } else if (!corners || !is_beside(i, face, at)) {
                        entries_.push_back({cell, begin_here, i});
                    }
                }
            }
        }
    }

    /// Lower bound of the distance from the light of the part of a box visible in a cell.
    [[nodiscard]] double begin_in(const Box3& box, int face,
                                  const DirectionWindows::Slopes& at) const {
        const auto part = DirectionWindows::depth_of(box, face, at);
        double square = 1;
        for (const Interval& s : at) {
            const double least = std::max(0.0, std::max(s.lo, -s.hi));
            square += least * least;
        }
        return std::max(0.0, (1.0 - 1e-12) * part * std::sqrt(square) - margin_);
    }

    /// True if a primitive is separated from a cell along one of its diagonals.
    [[nodiscard]] bool is_beside(std::uint32_t i, int face,
                                 const DirectionWindows::Slopes& at) const {
        const auto& [u, v] = at;
        return !sides_of(i, face, 1, 1, u.hi + v.hi).below ||
               !sides_of(i, face, 1, 1, u.lo + v.lo).above ||
               !sides_of(i, face, 1, -1, u.hi - v.lo).below ||
               !sides_of(i, face, 1, -1, u.lo - v.hi).above;
    }

    enum class Cover { None, Part, Full };
    using Corners = std::array<Vec3, 4>;

    void add_polygon(std::uint32_t i, int face, const DirectionWindows::Slopes& at,
                     std::size_t cell, double begin, bool may_fill) {
        const Corners corners{DirectionCube::direction(face, at[0].lo, at[1].lo),
                              DirectionCube::direction(face, at[0].hi, at[1].lo),
                              DirectionCube::direction(face, at[0].hi, at[1].hi),
                              DirectionCube::direction(face, at[0].lo, at[1].hi)};
        outline_.clear();
        for (const Vec3& p : bodies_.outline(i)) outline_.push_back(p - light_);
        const Cover cover = cover_of(begin, corners);
        if (cover == Cover::None) return;
        entries_.push_back({cell, begin, i});
        if (may_fill && cover == Cover::Full) fill(i, begin, corners, cells_[cell]);
    }

    /// How much of a cell the outline covers, by the planes through the light and its edges. A ray
    /// lies within the deviation of a line from the light: the polygon misses, or fills, a cell
    /// only if it does so for all of these lines.
    [[nodiscard]] Cover cover_of(double begin, const Corners& corners) const {
        // At the polygon, points of the cell are at least this far along the cell's corners.
        const double depth = begin / std::sqrt(3.0);
        bool full = true;
        const std::size_t n = outline_.size();
        for (std::size_t k = 0; k < n; ++k) {
            Vec3 normal = cross(outline_[k], outline_[(k + 1) % n]);
            if (dot(normal, outline_[(k + 2) % n]) < 0.0) normal = -normal;
            const double size = length(normal);
            // Undecided for a sliver, and for a polygon whose plane contains the light.
            if (!(size > 0.0) || !std::isfinite(size)) return Cover::Part;
            double least = std::numeric_limits<double>::infinity(), most = -least;
            for (const Vec3& c : corners) {
                const double beside = dot(normal, c) / size;
                least = std::min(least, beside);
                most = std::max(most, beside);
            }
            if (most * depth < -margin_) return Cover::None;
            full = full && least * depth > 64 * margin_;
        }
        return full && is_steep(corners) ? Cover::Full : Cover::Part;
    }

    /// True if rays of the cell reach the polygon at an angle so steep that their deviation at the
    /// light is negligible.
    [[nodiscard]] bool is_steep(const Corners& corners) const {
        const Vec3 normal = outline_normal();
        const double size = length(normal);
        return size > 0.0 && std::all_of(corners.begin(), corners.end(), [&](const Vec3& c) {
                   return std::abs(dot(normal, c)) > 0.1 * size * length(c);
               });
    }

    [[nodiscard]] Vec3 outline_normal() const {
        return cross(outline_[1] - outline_[0], outline_[2] - outline_[0]);
    }

    /// Ends the cell behind the nearest polygon that fills it: distances from the light are largest
    /// at its corners.
    void fill(std::uint32_t i, double begin, const Corners& corners,
              LightBuffer::Cell& cell) const {
        const Vec3 normal = outline_normal();
        const double height = dot(normal, outline_[0]);
        double end = 0;
        for (const Vec3& corner : corners) {
            end = std::max(end, std::abs(height / dot(normal, corner)) * length(corner));
        }
        // The margin allows for the additional distance at which a deviating ray reaches an oblique
        // polygon.
        const double filled_to = (1.0 + 1e-9) * end + 16 * margin_;
        if (!(filled_to < cell.filled_to)) return;
        cell.filled_to = filled_to;
        cell.filled_from = begin;
        cell.filler = i;
    }

    /// Fraction of all visible directions.
    static constexpr double kLarge = 0.01;
    static constexpr double kMostCells = 1 << 21;
    /// Mean number of primitives in a direction from which on the cells become fewer.
    static constexpr double kMostInDepth = 64;
    static constexpr int kMostInRow = 4096;

    const BoundsSource& source_;
    LightBuffer& made_;
    BoundingProxies bodies_;
    double margin_;  ///< how far rays may deviate at the light
    Vec3 light_;
    DirectionWindows windows_;
    std::vector<Entry> entries_;
    std::vector<LightBuffer::Cell> cells_;
    std::vector<Vec3> outline_;  ///< outline of the current polygon, relative to the light
};

LightBuffer::Config LightBuffer::configure(SettingsReader& reader) {
    Config config;
    config.density = reader.number("density", "cells of a light per primitive", 16, 1e-6, 1000);
    config.resolution = reader.count(
        "resolution", "cells along the longest edge of a light's window, 0: by the density", 0, 0,
        4096);
    if (config.resolution > 0) reader.exclude("density", "resolution");
    config.lights = reader.count("lights", "maximum number of lights with a buffer", 16, 0, 1000);
    config.full_cells =
        reader.flag("full_cells", "lists end behind a polygon that fills their cell", true);
    config.shadow_cache = reader.flag("shadow_cache", "test the last occluder first", true);
    config.others = FallbackAccelerator::configure(reader);
    return config;
}

LightBuffer LightBuffer::build(const BoundsSource& source, const Config& config) {
    LightBuffer made;
    made.config_ = config;
    made.others_ = FallbackAccelerator(source, config.others);
    if (source.size() == 0) return made;
    made.space_ = PaddedBox(source);
    made.ends_ = RayEndFinder(source, made.space_, static_cast<std::size_t>(config.lights));
    made.number_ = LastOccluders::new_number();
    LightBufferBuilder(source, made).run();
    return made;
}

}  // namespace alhazen
