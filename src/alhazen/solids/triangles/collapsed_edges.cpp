#include "alhazen/solids/triangles/collapsed_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "alhazen/base/interruption.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
/// Most triangles around a vertex.
constexpr std::size_t kMostAround = 40;
/// Least cosine between normals that a surface without an edge has at a vertex or in a triangle.
constexpr double kSmooth = 0.8;
/// Least width of a triangle over its length, unless it replaces a narrower one.
constexpr double kLeastWidth = 1e-3;

/// Least cosine between the direction of projection and the normal of a triangle.
constexpr double kLeastCosine = 0.05;
/// Share of the bound below which twice the heights of a star stand for its distance.
constexpr double kFlat = 0.02;

double cross_2d(const Vec2& a, const Vec2& b) {
    return a.x * b.y - a.y * b.x;
}
double largest(const Vec2& v) {
    return std::max(std::abs(v.x), std::abs(v.y));
}

/// Twice the area over the squared length of the longest edge.
double width_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest =
        std::max({length_squared(b - a), length_squared(c - b), length_squared(a - c)});
    return longest > 0.0 ? length(cross(b - a, c - a)) / longest : 0.0;
}

struct Triangle {
    std::array<std::uint32_t, 3> points, corners;  ///< position, and vertex of the mesh
    double off = 0;                                ///< bound of the distance to the first mesh
    double off_uv = 0;                             ///< the same of texture coordinates
};

/// The triangles around a position: triangle k is (position, ring[k], ring[k + 1]).
struct Star {
    struct Spoke {
        std::uint32_t point;              ///< ring[k]
        std::uint32_t triangle;           ///< triangle k
        std::uint32_t own, here, beyond;  ///< its vertices: at the position, ring[k], ring[k + 1]
        bool crease;                      ///< normals, materials or coordinates differ across it
        Vec3 offset;                      ///< from the position
        Vec2 flat;                        ///< projected
        double height;                    ///< above the plane of projection
    };
    std::vector<Spoke> spokes;
    std::uint32_t position = 0;
    int creases = 0;
    double off = 0, off_uv = 0;       ///< the largest of the triangles
    double width = 1, alignment = 1;  ///< the least of the triangles, and of cosines of corners
    double tallest = 0;               ///< the largest size of a height
    double sag = 0;                   ///< the least size of a height, all on one side; else 0

    [[nodiscard]] std::size_t size() const { return spokes.size(); }
    [[nodiscard]] const Spoke& operator[](std::size_t k) const {
        return spokes[k < spokes.size() ? k : k - spokes.size()];
    }
};

/// A collapse along a spoke.
struct Collapse {
    std::size_t spoke = 0;
    double off = 0, off_uv = 0;
    double width = 0;                    ///< of the narrowest new triangle
    std::vector<std::uint32_t> corners;  ///< the vertex of each new triangle at the end
};

class EdgeCollapser {
  public:
    EdgeCollapser(TriangleMesh& mesh, std::vector<std::uint32_t> points, double coordinates)
        : mesh_(mesh), most_uv_(coordinates), point_of_(std::move(points)) {
        heads_.assign(mesh.positions.size(), kNone);
        marks_.assign(mesh.positions.size(), 0);
        busy_.assign(mesh.positions.size(), 0);
        has_uvs_ = std::any_of(mesh.uvs.begin(), mesh.uvs.end(),
                               [](const Vec2& uv) { return uv.x != 0.0 || uv.y != 0.0; });
        waits_.assign(mesh.positions.size(), 0);
        needs_.assign(mesh.positions.size(), 0.0);
        next_.assign(3 * mesh.triangles.size(), kNone);
        triangles_.reserve(mesh.triangles.size());
        for (const auto& t : mesh.triangles) {
            const auto number = static_cast<std::uint32_t>(triangles_.size());
            triangles_.push_back({{point_of_[t[0]], point_of_[t[1]], point_of_[t[2]]}, t});
            for (std::uint32_t k = 0; k < 3; ++k) link(3 * number + k);
        }
    }

    /// Collapses edges without length, which keep every point and the vertices of triangles.
    void drop_empty() {
        for (std::uint32_t p = 0; p < heads_.size(); ++p) {
            for (std::uint32_t c = heads_[p]; c != kNone; c = next_[c]) {
                const std::uint32_t q = triangles_[c / 3].points[(c % 3 + 1) % 3];
                if (at(p) == at(q) && drop_empty(p, q)) break;
            }
        }
    }

    /// Collapses edges until none is left that keeps the bound.
    void run(double most) {
        most_ = most;
        for (std::uint32_t p = 0; p < heads_.size(); ++p) wait(p);
        while (!waiting_.empty()) {
            std::swap(waiting_, trying_);
            ++pass_;
            for (const std::uint32_t p : trying_) {
                waits_[p] = 0;
                if (heads_[p] == kNone || needs_[p] > most_) continue;
                interruption_point();
                needs_[p] = kInfinity;
                if (!find_star(p)) continue;
                // Neighbours of a collapse wait for the next pass: triangles grow evenly.
                if (is_busy()) {
                    needs_[p] = 0;
                    wait(p);
                } else if (find_collapse()) {
                    collapse();
                }
            }
            trying_.clear();
        }
    }

    /// Replaces the mesh by what is left.
    void finish() {
        std::vector<std::uint32_t> number(mesh_.positions.size(), kNone);
        mesh_.triangles.clear();
        for (const Triangle& t : triangles_) {
            if (t.points[0] == kNone) continue;
            mesh_.triangles.push_back(t.corners);
            for (const std::uint32_t corner : t.corners) number[corner] = 0;
        }
        std::uint32_t count = 0;
        for (std::uint32_t v = 0; v < number.size(); ++v) {
            if (number[v] == kNone) continue;
            mesh_.positions[count] = mesh_.positions[v];
            mesh_.normals[count] = mesh_.normals[v];
            mesh_.uvs[count] = mesh_.uvs[v];
            mesh_.vertex_materials[count] = mesh_.vertex_materials[v];
            number[v] = count++;
        }
        mesh_.positions.resize(count);
        mesh_.normals.resize(count);
        mesh_.uvs.resize(count);
        mesh_.vertex_materials.resize(count);
        for (auto& t : mesh_.triangles) {
            for (std::uint32_t& corner : t) corner = number[corner];
        }
    }

  private:
    /// Moves a position to an equal one beside it, if that keeps the topology.
    bool drop_empty(std::uint32_t position, std::uint32_t end) {
        if (!find_star(position)) return false;
        std::size_t spoke = 0;
        while (star_[spoke].point != end) ++spoke;
        if (!keeps_topology(spoke)) return false;
        best_ = {spoke, 0, 0, 1, {}};
        for (std::size_t k = spoke + 1; k + 1 < spoke + star_.size(); ++k) {
            best_.corners.push_back(star_[k].own);
        }
        collapse();
        return true;
    }

    // ---- Corners of triangles, 3 * triangle + k, in a list for each position.
    void link(std::uint32_t corner) {
        std::uint32_t& head = heads_[triangles_[corner / 3].points[corner % 3]];
        next_[corner] = head;
        head = corner;
    }
    void unlink(std::uint32_t corner) {
        std::uint32_t* at = &heads_[triangles_[corner / 3].points[corner % 3]];
        while (*at != corner) at = &next_[*at];
        *at = next_[corner];
    }
    [[nodiscard]] const Vec3& at(std::uint32_t point) const { return mesh_.positions[point]; }

    /// Lets a position be tried.
    void wait(std::uint32_t position) {
        if (waits_[position] != 0 || heads_[position] == kNone) return;
        waits_[position] = 1;
        waiting_.push_back(position);
    }

    // ---- The star of a position.
    /// False if it is no disc, or too large.
    bool find_star(std::uint32_t position) {
        star_.spokes.clear();
        star_.position = position;
        for (std::uint32_t c = heads_[position]; c != kNone; c = next_[c]) {
            if (star_.size() == kMostAround) return false;
            const Triangle& t = triangles_[c / 3];
            const std::uint32_t b = (c % 3 + 1) % 3, e = (c % 3 + 2) % 3;
            star_.spokes.push_back({t.points[b],
                                    c / 3,
                                    t.corners[c % 3],
                                    t.corners[b],
                                    t.corners[e],
                                    false,
                                    at(t.points[b]) - at(position),
                                    {},
                                    0});
        }
        return is_ring();
    }
    bool is_ring() {
        auto& s = star_.spokes;
        for (std::size_t k = 0; k + 1 < s.size(); ++k) {
            const std::uint32_t follows = point_of_[s[k].beyond];
            std::size_t found = k + 1;
            while (found < s.size() && s[found].point != follows) ++found;
            if (found == s.size()) return false;
            std::swap(s[k + 1], s[found]);
        }
        if (s.size() < 3 || point_of_[s.back().beyond] != s[0].point) return false;
        ++mark_;
        for (const Star::Spoke& spoke : s) {
            if (marks_[spoke.point] == mark_) return false;
            marks_[spoke.point] = mark_;
        }
        return true;
    }
    /// True if a position of the star was part of a collapse of this pass.
    [[nodiscard]] bool is_busy() const {
        return busy_[star_.position] == pass_ ||
               std::any_of(star_.spokes.begin(), star_.spokes.end(),
                           [&](const Star::Spoke& s) { return busy_[s.point] == pass_; });
    }
    /// True if two vertices of one position are of one smooth surface.
    [[nodiscard]] bool are_alike(std::uint32_t a, std::uint32_t b) const {
        if (a == b) return true;
        return mesh_.vertex_materials[a] == mesh_.vertex_materials[b] &&
               dot(mesh_.normals[a], mesh_.normals[b]) > kSmooth &&
               largest(mesh_.uvs[a] - mesh_.uvs[b]) <= most_uv_;
    }
    /// Measures the star and projects it. False if its triangles do not all face one side.
    bool prepare_star() {
        star_.off = star_.off_uv = 0;
        star_.width = star_.alignment = 1;
        star_.creases = 0;
        std::array<Vec3, kMostAround> normals;
        Vec3 sum;
        for (std::size_t k = 0; k < star_.size(); ++k) {
            Star::Spoke& s = star_.spokes[k];
            s.crease = !are_alike(s.own, star_[k + star_.size() - 1].own);
            star_.creases += s.crease;
            const Triangle& t = triangles_[s.triangle];
            star_.off = std::max(star_.off, t.off);
            star_.off_uv = std::max(star_.off_uv, t.off_uv);
            star_.width = std::min(star_.width, width_of({}, s.offset, star_[k + 1].offset));
            const Vec3 normal = cross(s.offset, star_[k + 1].offset);
            normals[k] = unit_or(normal, {});
            for (const std::uint32_t corner : {s.own, s.here, s.beyond}) {
                star_.alignment = std::min(star_.alignment, dot(normals[k], mesh_.normals[corner]));
            }
            sum += normals[k];
        }
        return project(sum, normals);
    }
    /// Projects along a direction that all triangles face, found by the rule of the perceptron.
    bool project(Vec3 along, const std::array<Vec3, kMostAround>& normals) {
        constexpr int kRounds = 20;
        for (int round = 0;; ++round) {
            along = unit_or(along, {0, 0, 1});
            bool all = true;
            for (std::size_t k = 0; k < star_.size(); ++k) {
                if (dot(along, normals[k]) >= kLeastCosine) continue;
                along += normals[k];
                all = false;
            }
            if (all) break;
            if (round == kRounds) return false;
        }
        const Vec3 x = perpendicular(along), y = cross(along, x);
        star_.tallest = 0;
        double lowest = kInfinity, highest = -kInfinity;
        for (Star::Spoke& s : star_.spokes) {
            s.flat = {dot(x, s.offset), dot(y, s.offset)};
            s.height = dot(along, s.offset);
            star_.tallest = std::max(star_.tallest, std::abs(s.height));
            lowest = std::min(lowest, s.height);
            highest = std::max(highest, s.height);
        }
        star_.sag = std::max({lowest, -highest, 0.0});
        return true;
    }

    // ---- Which collapse is best.
    /// Finds the collapse of the star's position with the least bound, of flat stars that with the
    /// widest triangles. False if there is none.
    bool find_collapse() {
        if (!prepare_star() || (star_.creases != 0 && star_.creases != 2)) return false;
        double& needs = needs_[star_.position];
        // The position is over or under triangles between corners of the ring.
        const double least = star_.off + star_.sag;
        if (least > most_) {
            needs = least;
            return false;
        }
        bool any = false;
        for (std::size_t k = 0; k < star_.size(); ++k) {
            if (star_.creases != 0 && !star_[k].crease) continue;
            if (!keeps_topology(k)) {
                // That may change while the star does not.
                needs = 0;
                continue;
            }
            if (!measure(k)) continue;
            constexpr double kEqual = 0.05;
            const bool equal = any && std::abs(tried_collapse_.off - best_.off) <= kEqual * most_;
            if (any &&
                (equal ? tried_collapse_.width <= best_.width : tried_collapse_.off >= best_.off)) {
                continue;
            }
            std::swap(best_, tried_collapse_);
            any = true;
        }
        return any;
    }
    /// The link condition: both ends of the edge share two neighbours alone.
    bool keeps_topology(std::size_t spoke) {
        ++mark_;
        for (const Star::Spoke& s : star_.spokes) marks_[s.point] = mark_;
        std::size_t shared = 0, around = 0;
        for (std::uint32_t c = heads_[star_[spoke].point]; c != kNone; c = next_[c]) {
            const Triangle& t = triangles_[c / 3];
            ++around;
            for (const std::uint32_t p : t.points) {
                if (marks_[p] != mark_ || p == star_[spoke].point) continue;
                marks_[p] = 0;
                ++shared;
            }
        }
        if (shared != 2 || around + star_.size() > kMostAround + 4) return false;
        return star_.size() > 3 || !is_triangle(star_[0].point, star_[1].point, star_[2].point);
    }
    [[nodiscard]] bool is_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t e) const {
        for (std::uint32_t c = heads_[a]; c != kNone; c = next_[c]) {
            const auto& p = triangles_[c / 3].points;
            const auto has = [&](std::uint32_t q) { return p[0] == q || p[1] == q || p[2] == q; };
            if (has(b) && has(e)) return true;
        }
        return false;
    }
    /// Sets `tried_collapse_`. False if a triangle turns over or a bound is exceeded.
    bool measure(std::size_t spoke) {
        Collapse& c = tried_collapse_;
        c.spoke = spoke;
        c.corners.clear();
        c.width = 1;
        const std::size_t n = star_.size();
        const Star::Spoke& end = star_[spoke];
        const std::uint32_t sides[2] = {end.here, star_[spoke + n - 1].beyond};
        std::size_t side = 0;
        for (std::size_t k = spoke + 1; k + 1 < spoke + n; ++k) {
            const Star::Spoke &s = star_[k], &t = star_[k + 1];
            if (s.crease) side = 1;
            const Vec3 twice = cross(s.offset - end.offset, t.offset - end.offset);
            const double seen = cross_2d(s.flat - end.flat, t.flat - end.flat);
            if (!(seen > kLeastCosine * length(twice))) return false;
            const Vec3 normal = unit_or(twice, {});
            std::uint32_t corner = sides[side];
            if (star_.creases == 0 &&
                dot(normal, mesh_.normals[sides[1]]) > dot(normal, mesh_.normals[sides[0]])) {
                corner = sides[1];
            }
            if (mesh_.vertex_materials[corner] != mesh_.vertex_materials[s.own]) return false;
            c.corners.push_back(corner);
            for (const std::uint32_t v : {corner, s.here, s.beyond}) {
                const double cosine = dot(normal, mesh_.normals[v]);
                if (cosine < std::min(kSmooth, std::max(star_.alignment, 0.0))) return false;
            }
            c.width = std::min(c.width, width_of(end.offset, s.offset, t.offset));
        }
        constexpr double kDegenerate = 1e-9;
        if (c.width < std::max(kDegenerate, std::min(kLeastWidth, star_.width))) return false;
        // Coordinates that jump at the end have no one value there.
        if (star_.creases == 0 && largest(mesh_.uvs[sides[0]] - mesh_.uvs[sides[1]]) > most_uv_) {
            return false;
        }
        return measure_distance(spoke);
    }
    /// Sets the bounds of `tried_collapse_`. False if one is exceeded.
    bool measure_distance(std::size_t spoke) {
        const std::size_t other = other_crease(spoke);
        double off = 2.0 * star_.tallest, off_uv = 0;
        if (has_uvs_ || off > kFlat * most_) measure_crossings(spoke, other, off, off_uv);
        if (star_.creases != 0) measure_crease(spoke, other, off, off_uv);
        Collapse& c = tried_collapse_;
        c.off = star_.off + off;
        c.off_uv = star_.off_uv + off_uv;
        if (!(c.off_uv <= most_uv_)) return false;
        if (c.off <= most_) return true;
        needs_[star_.position] = std::min(needs_[star_.position], c.off);
        return false;
    }
    /// Where the projection of the old edges to the ring crosses that of the new ones, and at the
    /// position itself.
    void measure_crossings(std::size_t spoke, std::size_t other, double& off, double& off_uv) {
        const std::vector<std::uint32_t>& corners = tried_collapse_.corners;
        const std::size_t n = star_.size();
        const Star::Spoke& end = star_[spoke];
        off = 0;
        double deepest = -kInfinity, off_here = 0, off_uv_here = 0;
        for (std::size_t k = spoke + 1; k + 1 < spoke + n; ++k) {
            // The new triangle that the position is in.
            const Star::Spoke &s = star_[k], &t = star_[k + 1];
            const Vec2 new_uv = mesh_.uvs[corners[k - spoke - 1]];
            const double area = cross_2d(s.flat - end.flat, t.flat - end.flat);
            const double a = cross_2d(s.flat, t.flat) / area, b = cross_2d(t.flat, end.flat) / area;
            const double e = cross_2d(end.flat, s.flat) / area;
            if (const double least = std::min({a, b, e}); least > deepest) {
                deepest = least;
                off_here = std::abs(a * end.height + b * s.height + e * t.height);
                const Vec2 uv = a * new_uv + b * mesh_.uvs[s.here] + e * mesh_.uvs[s.beyond];
                off_uv_here = largest(uv - mesh_.uvs[s.own]);
            }
            if (k == spoke + 1) continue;
            // The new edge from the end to ring[k].
            const Vec2 along = s.flat - end.flat;
            for (std::size_t m = spoke + 1; m < spoke + n; ++m) {
                const Star::Spoke& old = star_[m];
                const double det = cross_2d(old.flat, along);
                if (m == k || det == 0.0) continue;
                const double u = cross_2d(end.flat, along) / det;
                const double w = cross_2d(end.flat, old.flat) / det;
                if (!(u >= 0.0 && u <= 1.0 && w >= 0.0 && w <= 1.0)) continue;
                const double height = (1 - w) * end.height + w * s.height;
                off = std::max(off, std::abs(u * old.height - height));
                // Coordinates are compared on one side of the creases.
                if (k == other || m == other || (k < other) != (m < other)) continue;
                const Vec2 uv = (1 - w) * new_uv + w * mesh_.uvs[s.here];
                const Vec2 before = (1 - u) * mesh_.uvs[old.own] + u * mesh_.uvs[old.here];
                off_uv = std::max(off_uv, largest(uv - before));
            }
        }
        off = std::max(off, off_here);
        off_uv = std::max(off_uv, off_uv_here);
    }
    /// The spoke of the other crease; past all if there is none.
    [[nodiscard]] std::size_t other_crease(std::size_t spoke) const {
        std::size_t other = spoke + 1;
        while (other < spoke + star_.size() && !star_[other].crease) ++other;
        return other;
    }
    /// At the point of the new edge between both creases that is nearest to the position.
    void measure_crease(std::size_t spoke, std::size_t other, double& off, double& off_uv) const {
        const std::size_t n = star_.size();
        const Star::Spoke &end = star_[spoke], &beyond = star_[other];
        const Vec3 from = end.offset, along = beyond.offset - from;
        const double t = std::clamp(-dot(from, along) / length_squared(along), 0.0, 1.0);
        off = std::max(off, length(from + t * along));
        const auto compare = [&](std::uint32_t first, std::uint32_t last, std::uint32_t own) {
            const Vec2 uv = (1 - t) * mesh_.uvs[first] + t * mesh_.uvs[last];
            off_uv = std::max(off_uv, largest(uv - mesh_.uvs[own]));
        };
        compare(end.here, star_[other - 1].beyond, star_[other - 1].own);
        compare(star_[spoke + n - 1].beyond, beyond.here, beyond.own);
    }

    void collapse() {
        const std::size_t n = star_.size();
        const std::uint32_t end = star_[best_.spoke].point;
        for (const std::size_t k : {best_.spoke, best_.spoke + n - 1}) {
            const std::uint32_t t = star_[k].triangle;
            for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) unlink(c);
            triangles_[t].points[0] = kNone;
        }
        for (std::size_t k = best_.spoke + 1; k + 1 < best_.spoke + n; ++k) {
            Triangle& t = triangles_[star_[k].triangle];
            std::uint32_t corner = 0;
            while (t.points[corner] != star_.position) ++corner;
            unlink(3 * star_[k].triangle + corner);
            t.points[corner] = end;
            t.corners[corner] = best_.corners[k - best_.spoke - 1];
            t.off = best_.off;
            t.off_uv = best_.off_uv;
            link(3 * star_[k].triangle + corner);
        }
        for (const Star::Spoke& s : star_.spokes) busy_[s.point] = pass_;
        // The end has new neighbours, and they have new triangles.
        for (std::uint32_t c = heads_[end]; c != kNone; c = next_[c]) {
            for (const std::uint32_t p : triangles_[c / 3].points) {
                needs_[p] = 0;
                wait(p);
            }
        }
    }

    TriangleMesh& mesh_;
    double most_ = 0, most_uv_;
    bool has_uvs_ = false;
    std::vector<std::uint32_t> point_of_;  ///< [vertex] the first vertex at its point
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> heads_;  ///< [position] its first corner
    std::vector<std::uint32_t> next_;   ///< [corner]
    std::vector<std::uint32_t> marks_;  ///< [position]
    std::vector<std::uint32_t> busy_;   ///< [position] the last pass in which its triangles changed
    std::vector<std::uint8_t> waits_;   ///< [position] is to be tried
    /// [position] While its star is as it is, no collapse keeps a bound below this.
    std::vector<double> needs_;
    std::vector<std::uint32_t> waiting_, trying_;  ///< positions, in the next pass and in this one
    std::uint32_t mark_ = 0, pass_ = 0;
    Star star_;
    Collapse best_, tried_collapse_;
};

}  // namespace

void collapse_edges(TriangleMesh& mesh, std::vector<std::uint32_t> points, double distance,
                    double coordinates) {
    if (mesh.triangles.empty()) return;
    EdgeCollapser collapser(mesh, std::move(points), coordinates);
    collapser.drop_empty();
    // What is flat first, then in steps, so that the bound is used evenly.
    for (const double share : {1e-6, 1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0}) {
        collapser.run(share * distance);
    }
    collapser.finish();
}

}  // namespace alhazen
