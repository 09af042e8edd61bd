#include "alhazen/accel/light_buffer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"

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

/// Makes the lists of one light after the other.
class LightBufferBuilder {
  public:
    LightBufferBuilder(const BoundsSource& source, LightBuffer& made)
        : source_(source), made_(made), bodies_(source), cube_(made.cube_) {}

    void run() {
        for (const Vec3& light : made_.ends_.places()) add_light(light);
    }

  private:
    struct Entry {
        std::uint32_t cell;
        double begin;
        std::uint32_t body;
    };

    void add_light(const Vec3& light) {
        std::vector<Entry> entries;
        std::vector<LightBuffer::Cell> cells(cube_.size());
        for (std::uint32_t i = 0; i < bodies_.size(); ++i) add_body(light, i, entries, cells);
        const std::size_t first = made_.entries_.size();
        if (first + entries.size() > 0xFFFFFFFFu) {
            throw Error(ErrorKind::Resource,
                        "light_buffer: more than 4294967295 entries in its lists; lower the "
                        "resolution or the number of lights");
        }
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            if (a.cell != b.cell) return a.cell < b.cell;
            return a.begin != b.begin ? a.begin < b.begin : a.body < b.body;
        });
        for (std::size_t e = 0; e < entries.size(); ++e) {
            LightBuffer::Cell& cell = cells[entries[e].cell];
            if (cell.count++ == 0) cell.first = static_cast<std::uint32_t>(first + e);
            cell.lit += entries[e].begin <= cell.filled_to;
            made_.entries_.push_back(entries[e].body);
            made_.begins_.push_back(entries[e].begin);
        }
        made_.cells_.insert(made_.cells_.end(), cells.begin(), cells.end());
    }

    [[nodiscard]] double room() const { return 4 * made_.ends_.room(); }

    /// Not farther than its nearest point from the light.
    [[nodiscard]] double begin_of(const Vec3& light, std::uint32_t i) const {
        const Box3& b = bodies_.box(i);
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double beside = std::max(0.0, std::max(b.lo[k] - light[k], light[k] - b.hi[k]));
            square += beside * beside;
        }
        const BoundingSphere& sphere = bodies_.sphere(i);
        const double to_sphere = length(sphere.center - light) - sphere.radius;
        return std::max(0.0, std::max(std::sqrt(square), to_sphere) - room());
    }

    /// Which rows (or columns) of a face see the body: the wedge between two planes through the
    /// light, `side` 0 for columns.
    void find_rows(const Vec3& light, std::uint32_t i, int face, int side,
                   std::vector<bool>& seen) const {
        Vec3 along, across;
        along[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
        across[(face / 2 + 1 + side) % 3] = 1.0;
        seen.assign(static_cast<std::size_t>(cube_.resolution()), false);
        bool above_last = true;  // above the plane that the row begins at
        for (int r = 0; r <= cube_.resolution(); ++r) {
            const Vec3 normal = across - cube_.bound(r) * along;
            const double steepness = length(normal);
            const double place = dot(normal, light);
            const Interval e = bodies_.extent(i, normal, steepness);
            const bool below = e.lo - place <= room() * steepness;
            if (r > 0) seen[static_cast<std::size_t>(r - 1)] = above_last && below;
            above_last = e.hi - place >= -room() * steepness;
        }
    }

    void add_body(const Vec3& light, std::uint32_t i, std::vector<Entry>& entries,
                  std::vector<LightBuffer::Cell>& cells) {
        const double begin = begin_of(light, i);
        const bool may_fill = made_.config_.full_cells && source_.blocks_light(i);
        for (int face = 0; face < 6; ++face) {
            const Vec3 along = DirectionCube::direction(face, 0, 0);
            if (bodies_.extent(i, along, 1.0).hi - dot(along, light) < -room()) continue;
            find_rows(light, i, face, 0, columns_);
            find_rows(light, i, face, 1, rows_);
            for (int row = 0; row < cube_.resolution(); ++row) {
                if (!rows_[static_cast<std::size_t>(row)]) continue;
                for (int column = 0; column < cube_.resolution(); ++column) {
                    if (!columns_[static_cast<std::size_t>(column)]) continue;
                    const Cover cover = cover_of(light, i, begin, {face, column, row});
                    if (cover == Cover::None) continue;
                    const std::size_t cell = cube_.number(face, column, row);
                    entries.push_back({static_cast<std::uint32_t>(cell), begin, i});
                    if (may_fill && cover == Cover::Full)
                        fill(light, i, begin, {face, column, row}, cells[cell]);
                }
            }
        }
    }

    struct CellPlace {
        int face, column, row;
    };
    enum class Cover { None, Part, Full };

    /// How much of a cell a triangle covers, by the planes through the light and its edges. A ray
    /// passes within the room of a line from the light: a cell is beside the triangle, or filled by
    /// it, when that is so for all of those.
    [[nodiscard]] Cover cover_of(const Vec3& light, std::uint32_t i, double begin,
                                 const CellPlace& at) const {
        const std::array<Vec3, 3>* triangle = bodies_.triangle(i);
        if (triangle == nullptr) return Cover::Part;
        const auto corners = cube_.corners(at.face, at.column, at.row);
        const Vec3 p[3] = {(*triangle)[0] - light, (*triangle)[1] - light, (*triangle)[2] - light};
        // Where the triangle is, points of the cell are at least so far along its corners.
        const double depth = begin / std::sqrt(3.0);
        bool full = true;
        for (int k = 0; k < 3; ++k) {
            Vec3 normal = cross(p[k], p[(k + 1) % 3]);
            if (dot(normal, p[(k + 2) % 3]) < 0.0) normal = -normal;
            const double size = length(normal);
            // Of a sliver, or a triangle that the light lies in the plane of, nothing is known.
            if (!(size > 0.0) || !std::isfinite(size)) return Cover::Part;
            double least = std::numeric_limits<double>::infinity(), most = -least;
            for (const Vec3& c : corners) {
                const double beside = dot(normal, c) / size;
                least = std::min(least, beside);
                most = std::max(most, beside);
            }
            if (most * depth < -room()) return Cover::None;
            full = full && least * depth > 64 * room();
        }
        return full && is_steep(p, corners) ? Cover::Full : Cover::Part;
    }

    /// Whether rays of the cell come steeply enough to a triangle for what they pass beside the
    /// light not to matter.
    static bool is_steep(const Vec3 (&p)[3], const std::array<Vec3, 4>& corners) {
        const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
        const double size = length(normal);
        return size > 0.0 && std::all_of(corners.begin(), corners.end(), [&](const Vec3& c) {
                   return std::abs(dot(normal, c)) > 0.1 * size * length(c);
               });
    }

    /// The cell ends behind the nearest triangle that fills it: distances from the light are
    /// largest at its corners.
    void fill(const Vec3& light, std::uint32_t i, double begin, const CellPlace& at,
              LightBuffer::Cell& cell) const {
        const auto& [a, b, c] = *bodies_.triangle(i);
        const Vec3 normal = cross(b - a, c - a);
        const double height = dot(normal, a - light);
        double end = 0;
        for (const Vec3& corner : cube_.corners(at.face, at.column, at.row)) {
            end = std::max(end, std::abs(height / dot(normal, corner)) * length(corner));
        }
        // Beside the light a ray comes to the triangle so much later where it is slanted most.
        const double filled_to = (1.0 + 1e-9) * end + 16 * room();
        if (!(filled_to < cell.filled_to)) return;
        cell.filled_to = filled_to;
        cell.filled_from = begin;
    }

    const BoundsSource& source_;
    LightBuffer& made_;
    BoundedBodies bodies_;
    const DirectionCube& cube_;
    std::vector<bool> rows_, columns_;
};

LightBuffer::Config LightBuffer::configure(SettingsReader& reader) {
    Config config;
    config.resolution =
        reader.count("resolution", "cells along an edge of the cube around a light", 32, 1, 512);
    config.lights = reader.count("lights", "so many get a buffer", 16, 0, 1000);
    config.full_cells =
        reader.flag("full_cells", "lists end behind a triangle that fills their cell", true);
    config.shadow_cache = reader.flag("shadow_cache", "test the last occluder first", true);
    config.others = OtherRays::configure(reader);
    return config;
}

LightBuffer LightBuffer::build(const BoundsSource& source, const Config& config) {
    LightBuffer made;
    made.config_ = config;
    made.others_ = OtherRays(source, config.others);
    if (source.size() == 0) return made;
    made.space_ = PaddedBox(source);
    made.ends_ = RayEndFinder(source, made.space_, static_cast<std::size_t>(config.lights));
    made.cube_ = DirectionCube(config.resolution);
    made.number_ = LastOccluders::new_number();
    LightBufferBuilder(source, made).run();
    return made;
}

}  // namespace alhazen
