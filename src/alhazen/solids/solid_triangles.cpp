#include "alhazen/solids/solid_triangles.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <unordered_map>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/solids/collapsed_edges.h"
#include "alhazen/solids/solid_coordinates.h"

namespace alhazen {

namespace {

using SurfacePoint = IsolatedSolid::SurfacePoint;

/// Crossings of a line with the surface, without surfaces between media.
class SurfaceLine {
  public:
    explicit SurfaceLine(const IsolatedSolid& solid) : solid_(solid) {}

    /// The hit of a crossing that the last call of `cross` with `with_hits` found.
    [[nodiscard]] const Hit& hit(std::size_t k) const { return hits_[k]; }

    const std::vector<SurfacePoint>& cross(const Vec3& from, const Vec3& along, double t_min,
                                           double t_max, bool with_hits = false) {
        found_.clear();
        hits_.clear();
        solid_.crossings({from, along, t_min, t_max}, found_, with_hits ? &hits_ : nullptr);
        std::size_t kept = 0;
        for (std::size_t k = 0; k < found_.size(); ++k) {
            const SurfacePoint& p = found_[k];
            const bool leaves = dot(p.normal, along) > 0.0;
            const bool wall = kept > 0 && found_[kept - 1].t == p.t && !leaves &&
                              dot(found_[kept - 1].normal, along) > 0.0;
            if (wall) {
                --kept;
                continue;
            }
            found_[kept] = p;
            if (with_hits) hits_[kept] = hits_[k];
            ++kept;
        }
        found_.resize(kept);
        return found_;
    }
    /// Distance along a unit vector, in either direction, to the surface; infinite beyond `limit`.
    double distance(const Vec3& from, const Vec3& along, double limit) {
        double nearest = kInfinity;
        for (const SurfacePoint& p : cross(from, along, -limit, limit)) {
            nearest = std::min(nearest, std::abs(p.t));
        }
        return nearest;
    }
    const std::vector<Interval>& spans(const Vec3& from, const Vec3& along) {
        solid_.cross({from, along, -kInfinity, kInfinity}, false, line_);
        return line_.spans;
    }
    bool inside(const Vec3& p) {
        const auto& all = spans(p, {0, 0, 1});
        return std::any_of(all.begin(), all.end(),
                           [](const Interval& s) { return s.lo <= 0.0 && 0.0 < s.hi; });
    }

  private:
    const IsolatedSolid& solid_;
    std::vector<SurfacePoint> found_;
    std::vector<Hit> hits_;
    LineSpans line_;
};

/// A crossing of the surface with an edge of the lattice.
struct Crossing {
    Vec3 point, normal;
    std::uint32_t material = 0;
    SolidCoordinates::Place place;  ///< where the surface has its texture coordinates
};

/// The point nearest to the tangent planes at the crossings, weakly drawn to their mean, clamped to
/// a box.
Vec3 feature_point(std::span<const Crossing> crossings, const Vec3& lo, const Vec3& hi) {
    constexpr double kDraw = 0.02;
    const double share = 1.0 / static_cast<double>(crossings.size());
    Vec3 point;
    for (const Crossing& c : crossings) point = point + share * c.point;
    Mat3 sum{{kDraw, 0, 0}, {0, kDraw, 0}, {0, 0, kDraw}};
    for (const Crossing& c : crossings) {
        sum.x_axis = sum.x_axis + share * c.normal.x * c.normal;
        sum.y_axis = sum.y_axis + share * c.normal.y * c.normal;
        sum.z_axis = sum.z_axis + share * c.normal.z * c.normal;
    }
    const Mat3 solve = inverse(sum);
    for (int round = 0; round < 4; ++round) {
        Vec3 offset;
        for (const Crossing& c : crossings) {
            offset = offset + share * dot(c.normal, c.point - point) * c.normal;
        }
        point = point + solve * offset;
    }
    for (int k = 0; k < 3; ++k) point[k] = std::clamp(point[k], lo[k], hi[k]);
    return point;
}

/// A lattice. A node is one of its points, a cell the cube above a node.
class Lattice {
  public:
    Lattice(const IsolatedSolid& solid, double cell, double tolerance, bool with_uvs,
            TriangleMesh& mesh)
        : line_(solid), cell_(cell), tolerance_(tolerance), mesh_(mesh) {
        if (with_uvs) coordinates_.emplace(solid);
        const Box3 box = solid.box();
        // Irrational shifts keep lattice planes off likely planes of the solid; outermost nodes are
        // outside.
        const Vec3 shift{0.6180339887, 0.7548776662, 0.5698402910};
        for (int k = 0; k < 3; ++k) {
            const double lo = box.lo[k] - cell * shift[k];
            origin_[k] = lo;
            count_[static_cast<std::size_t>(k)] =
                static_cast<std::uint64_t>(std::ceil((box.hi[k] - lo) / cell)) + 2;
        }
        layer_[0].resize(count_[1] * count_[2]);
        layer_[1] = layer_[0];
    }

    enum class Outcome { Made, TooMany, TooCoarse };
    /// Creates the triangles. `certain`: cells are so small that no triangle needs a test.
    Outcome make(bool certain, std::uint64_t max_triangles) {
        if (!certain && !sees_all()) return Outcome::TooCoarse;
        beyond_ = certain ? 0.0 : kBeyond;
        for (slab_ = 0; slab_ + 1 < count_[0]; ++slab_) {
            set_layer(slab_ + 1, layer_[1]);
            const std::size_t first = mesh_.triangles.size();
            add_cells();
            add_faces();
            if (mesh_.triangles.size() > max_triangles) return Outcome::TooMany;
            if (!certain && !are_near(first)) return Outcome::TooCoarse;
            std::swap(layer_[0], layer_[1]);
            std::swap(cells_[0], cells_[1]);
            std::swap(crossings_[0], crossings_[1]);
            cells_[1].clear();
            crossings_[1].clear();
        }
        return Outcome::Made;
    }

  private:
    [[nodiscard]] Vec3 node(std::uint64_t i, std::uint64_t j, std::uint64_t k) const {
        return origin_ + cell_ * Vec3{double(i), double(j), double(k)};
    }
    [[nodiscard]] std::uint64_t place(std::uint64_t j, std::uint64_t k) const {
        return j * count_[2] + k;
    }

    /// Marks the lattice points of a layer that are inside.
    void set_layer(std::uint64_t i, std::vector<std::uint8_t>& layer) {
        std::fill(layer.begin(), layer.end(), std::uint8_t{0});
        for (std::uint64_t j = 0; j < count_[1]; ++j) {
            for (const Interval& span : line_.spans(node(i, j, 0), {0, 0, 1})) {
                for (std::uint64_t k = point_after(span.lo, 2); k < point_after(span.hi, 2); ++k) {
                    layer[j * count_[2] + k] = 1;
                }
            }
        }
    }
    /// The first lattice point of a line along an axis at or after `t`.
    [[nodiscard]] std::uint64_t point_after(double t, std::size_t axis) const {
        const auto count = static_cast<double>(count_[axis]);
        return static_cast<std::uint64_t>(std::clamp(std::ceil(t / cell_), 0.0, count));
    }

    /// False if a part of the solid, or a gap in it, that is thicker than the tolerance lies
    /// between two lattice points.
    bool sees_all() {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            Vec3 along;
            along[static_cast<int>(axis)] = 1.0;
            std::array<std::uint64_t, 3> at{};
            for (at[u] = 0; at[u] < count_[u]; ++at[u]) {
                for (at[v] = 0; at[v] < count_[v]; ++at[v]) {
                    if (!sees_line(node(at[0], at[1], at[2]), along, axis)) return false;
                }
            }
        }
        return true;
    }
    bool sees_line(const Vec3& from, const Vec3& along, std::size_t axis) {
        ends_.clear();
        for (const Interval& span : line_.spans(from, along)) {
            ends_.push_back(span.lo);
            ends_.push_back(span.hi);
        }
        for (std::size_t k = 0; k + 1 < ends_.size(); ++k) {
            const Interval part{ends_[k], ends_[k + 1]};
            const bool seen = point_after(part.lo, axis) < point_after(part.hi, axis);
            if (!seen && !is_thin(from, along, part)) return false;
        }
        return true;
    }
    /// True if the surface is within half the tolerance of the middle of a part of a line.
    bool is_thin(const Vec3& from, const Vec3& along, const Interval& part) {
        const double limit = 0.5 * tolerance_;
        if (0.5 * (part.hi - part.lo) <= limit) return true;
        const Vec3 middle = from + 0.5 * (part.lo + part.hi) * along;
        const Vec3 u = perpendicular(along), v = cross(along, u);
        const double c = std::sqrt(0.5);
        for (const Vec3& aside : {u, v, c * (u + v), c * (u - v)}) {
            if (line_.distance(middle, aside, limit) <= limit) return true;
        }
        return false;
    }

    // ---- Crossings.
    /// Number of a node: `slab_` or `slab_` + 1, j, k.
    using Node = std::array<std::uint64_t, 3>;

    [[nodiscard]] bool is_in(const Node& n) const {
        return layer_[n[0] - slab_][place(n[1], n[2])] != 0;
    }
    /// The crossing on the edge from a node along an axis, one end of which is inside.
    const Crossing& crossing(const Node& from, std::size_t axis) {
        auto& known = crossings_[from[0] - slab_];
        const auto [found, is_new] = known.try_emplace(place(from[1], from[2]) * 3 + axis);
        if (is_new) found->second = find_crossing(from, axis);
        return found->second;
    }
    Crossing find_crossing(const Node& from, std::size_t axis) {
        Vec3 inner = node(from[0], from[1], from[2]);
        Vec3 outer = inner;
        outer[static_cast<int>(axis)] += cell_;
        if (!is_in(from)) std::swap(inner, outer);
        const Vec3 along = outer - inner;
        const bool with_uvs = coordinates_.has_value();
        const auto& found = line_.cross(inner, along, 0.0, 1.0, with_uvs);
        for (std::size_t k = 0; k < found.size(); ++k) {
            const SurfacePoint& p = found[k];
            if (!(dot(p.normal, along) > 0.0)) continue;
            Crossing met{p.point, p.normal, static_cast<std::uint32_t>(p.material), {}};
            if (with_uvs) met.place = coordinates_->place(line_.hit(k));
            return met;
        }
        // Down to rounding of the surface.
        for (int round = 0; round < 40; ++round) {
            const Vec3 middle = 0.5 * (inner + outer);
            (line_.inside(middle) ? inner : outer) = middle;
        }
        return {inner, normalize(along), 0, {}};
    }

    // ---- A vertex for each cell that the surface passes through.
    void add_cells() {
        for (std::uint64_t j = 0; j + 1 < count_[1]; ++j) {
            for (std::uint64_t k = 0; k + 1 < count_[2]; ++k) {
                const std::uint64_t at = place(j, k), n = count_[2];
                int sum = 0;
                for (const auto& layer : layer_) {
                    sum += layer[at] + layer[at + 1] + layer[at + n] + layer[at + n + 1];
                }
                if (sum != 0 && sum != 8) add_cell({slab_, j, k});
            }
        }
    }
    void add_cell(const Node& at) {
        cell_crossings_.clear();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (std::uint64_t side = 0; side < 4; ++side) {
                Node from = at;
                from[u] += side & 1;
                from[v] += side >> 1;
                Node to = from;
                ++to[axis];
                if (is_in(from) != is_in(to)) cell_crossings_.push_back(crossing(from, axis));
            }
        }
        const double beyond = beyond_ * cell_, size = cell_ + beyond;
        const Vec3 lo = node(at[0], at[1], at[2]);
        const Vec3 point = feature_point(cell_crossings_, lo - Vec3{beyond, beyond, beyond},
                                         lo + Vec3{size, size, size});
        Vec3 sum;
        for (const Crossing& c : cell_crossings_) sum = sum + c.normal;
        const Vec3 normal = unit_or(sum, cell_crossings_[0].normal);
        const bool smooth =
            std::all_of(cell_crossings_.begin(), cell_crossings_.end(),
                        [&](const Crossing& c) { return dot(c.normal, normal) > kSmooth; });
        cells_[1].emplace(place(at[1], at[2]), mesh_.positions.size());
        add_vertex(point, normal, cell_crossings_[0].material);
        is_edge_.push_back(!smooth);
    }
    void add_vertex(const Vec3& point, const Vec3& normal, std::uint32_t material) {
        mesh_.positions.push_back(point);
        mesh_.normals.push_back(normal);
        mesh_.uvs.push_back({0, 0});
        mesh_.vertex_materials.push_back(material);
    }

    // ---- A quadrangle around each edge that the surface crosses.
    void add_faces() {
        for (std::uint64_t j = 0; j + 1 < count_[1]; ++j) {
            for (std::uint64_t k = 0; k + 1 < count_[2]; ++k) {
                const Node at{slab_, j, k};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    // Edges on the border of the lattice are outside the solid.
                    if (at[(axis + 1) % 3] == 0 || at[(axis + 2) % 3] == 0) continue;
                    Node to = at;
                    ++to[axis];
                    if (is_in(at) != is_in(to)) add_face(at, axis);
                }
            }
        }
    }
    void add_face(const Node& at, std::size_t axis) {
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        const Crossing& met = crossing(at, axis);
        std::array<std::uint32_t, 4> corners{};
        for (std::size_t side = 0; side < 4; ++side) {
            Node cell = at;  // visits the cells around the axis, right-handed
            cell[u] -= side == 0 || side == 3 ? 1u : 0u;
            cell[v] -= side < 2 ? 1u : 0u;
            corners[side] = corner(cells_[1 - (slab_ - cell[0])].at(place(cell[1], cell[2])), met);
        }
        if (!is_in(at)) std::swap(corners[1], corners[3]);
        const bool other = badness(corners, 1, met.normal) < badness(corners, 0, met.normal);
        const std::size_t s = other ? 1 : 0;
        add_triangle({corners[s], corners[s + 1], corners[s + 2]});
        add_triangle({corners[s], corners[s + 2], corners[(s + 3) % 4]});
    }
    void add_triangle(const std::array<std::uint32_t, 3>& t) {
        const auto& p = mesh_.positions;
        // A triangle with two equal corners has no area and is left out.
        if (p[t[0]] == p[t[1]] || p[t[1]] == p[t[2]] || p[t[2]] == p[t[0]]) return;
        mesh_.triangles.push_back(t);
    }
    /// Deviation of the two triangles beside a diagonal from the surface normal: the negated least
    /// cosine.
    [[nodiscard]] double badness(const std::array<std::uint32_t, 4>& c, std::size_t first,
                                 const Vec3& normal) const {
        const auto p = [&](std::size_t k) { return mesh_.positions[c[(first + k) % 4]]; };
        const Vec3 one = cross(p(1) - p(0), p(2) - p(0)), two = cross(p(2) - p(0), p(3) - p(0));
        return -std::min(dot(unit_or(one, normal), normal), dot(unit_or(two, normal), normal));
    }
    /// The vertex of a cell for a face: a copy if the surface has an edge, another material or
    /// other texture coordinates there.
    std::uint32_t corner(std::uint64_t vertex, const Crossing& met) {
        const auto own = static_cast<std::uint32_t>(vertex);
        const bool edge = is_edge_[own];
        const bool fits = !edge && mesh_.vertex_materials[own] == met.material;
        if (!coordinates_) return fits ? own : copy(own, met);
        const Vec2 uv = coordinates_->uv(mesh_.positions[own], met.point, met.place);
        if (!fits) {
            const std::uint32_t next = copy(own, met);
            mesh_.uvs[next] = uv;
            return next;
        }
        return coordinates_->vertex(own, met.place, uv, mesh_, [&] { return copy(own, met); });
    }
    std::uint32_t copy(std::uint32_t own, const Crossing& met) {
        const bool edge = is_edge_[own];
        const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
        const Vec3 point = mesh_.positions[own];
        add_vertex(point, edge ? met.normal : mesh_.normals[own], met.material);
        is_edge_.push_back(edge);
        return next;
    }

    /// True if the surface is near all triangles from index `first` on.
    bool are_near(std::size_t first) {
        const double limit = 0.5 * tolerance_;
        for (std::size_t k = first; k < mesh_.triangles.size(); ++k) {
            const auto& t = mesh_.triangles[k];
            const Vec3 a = mesh_.positions[t[0]], b = mesh_.positions[t[1]],
                       c = mesh_.positions[t[2]];
            const Vec3 face = unit_or(cross(b - a, c - a), mesh_.normals[t[0]]);
            for (const Vec3& p :
                 {a, b, c, (a + b + c) / 3, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) {
                if (!is_near(p, face, limit)) return false;
            }
        }
        return true;
    }
    /// Tests along the normal and seven other directions: near an edge the normal may miss the
    /// surface.
    bool is_near(const Vec3& p, const Vec3& face, double limit) {
        if (line_.distance(p, face, limit) <= limit) return true;
        const double c = std::sqrt(1.0 / 3.0);
        for (const Vec3& along : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{c, c, c},
                                  Vec3{-c, c, c}, Vec3{c, -c, c}, Vec3{c, c, -c}}) {
            if (line_.distance(p, along, limit) <= limit) return true;
        }
        return false;
    }

    /// Cosine of the largest angle of normals in a cell without an edge.
    static constexpr double kSmooth = 0.8;

    /// How far from its cell a vertex may be, in cells, where triangles are tested: an edge of the
    /// surface beside a cell is met.
    static constexpr double kBeyond = 0.5;

    SurfaceLine line_;
    double cell_, tolerance_, beyond_ = 0;
    TriangleMesh& mesh_;
    std::optional<SolidCoordinates> coordinates_;
    Vec3 origin_;
    std::array<std::uint64_t, 3> count_{};
    std::uint64_t slab_ = 0;
    std::vector<double> ends_;
    std::vector<Crossing> cell_crossings_;
    std::vector<bool> is_edge_;                                  ///< [vertex]
    std::vector<std::uint8_t> layer_[2];                         ///< nodes at slab_ and slab_ + 1
    std::unordered_map<std::uint64_t, Crossing> crossings_[2];   ///< on edges from these nodes
    std::unordered_map<std::uint64_t, std::uint64_t> cells_[2];  ///< previous slab, this slab
};

}  // namespace

bool make_solid_triangles(const IsolatedSolid& solid, double tolerance, std::uint64_t max_triangles,
                          TriangleMesh& mesh, bool with_uvs) {
    mesh = TriangleMesh{};
    const Box3 box = solid.box();
    if (box.empty()) return true;
    constexpr double kFirstCells = 24;
    // Of the tolerance half is for the lattice and half for the merging.
    const double smallest = 0.5 * tolerance / std::sqrt(3.0) * (1.0 - 1e-9);
    double cell = std::max(max_component(box.size()) / kFirstCells, smallest);
    for (;;) {
        const bool certain = cell <= smallest;
        // A surface has at least as many triangles as its largest projection.
        const Vec3 cells = box.size() / cell;
        const double projected =
            std::max({cells.x * cells.y, cells.y * cells.z, cells.z * cells.x});
        if (projected > 4.0 * static_cast<double>(max_triangles)) return false;
        using Outcome = Lattice::Outcome;
        const Outcome outcome =
            Lattice(solid, cell, tolerance, with_uvs, mesh).make(certain, max_triangles);
        if (outcome == Outcome::TooMany) return false;
        if (outcome == Outcome::Made) break;
        mesh = TriangleMesh{};
        cell = std::max(0.5 * cell, smallest);
    }
    constexpr double kCoordinates = 1.0 / 512;
    collapse_edges(mesh, 0.5 * tolerance, kCoordinates);
    return true;
}

}  // namespace alhazen
