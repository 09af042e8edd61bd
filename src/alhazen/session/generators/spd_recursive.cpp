// Databases built by recursion: balls, jacks, mount, tetra, tree.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "alhazen/math/affine.h"
#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"
#include "alhazen/session/generators/spd.h"

namespace alhazen {

namespace {

Affine rotation(const Vec3& axis, double degrees) {
    return Affine::rotate(axis, degrees * kRadiansPerDegree);
}

// balls

/// Directions of the nine children of a ball whose own direction from its parent is +z: three
/// groups a third of a turn apart, each of one child that leans out by the angle of the
/// octahedron's edges and two in the equator.
std::array<Vec3, 9> ball_directions() {
    std::array<Vec3, 9> directions;
    for (std::size_t set = 0; set < 3; ++set) {
        const double turn = 2.0 * kPi / 3.0 * static_cast<double>(set);
        const double lean = std::sqrt(1.0 / 3.0);
        directions[3 * set] = {lean * std::cos(kPi / 4 + turn), lean * std::sin(kPi / 4 + turn),
                               2.0 / std::sqrt(6.0)};
        const double left = kPi / 12 + turn, right = 5 * kPi / 12 + turn;
        directions[3 * set + 1] = {std::cos(left), std::sin(left), 0};
        directions[3 * set + 2] = {std::cos(right), std::sin(right), 0};
    }
    return directions;
}

struct Ball {
    Vec3 center;
    Vec3 direction;  ///< from the parent, unit
    double radius;
    int place;  ///< index among its siblings, 0 to 8
};

class BallWriter {
  public:
    explicit BallWriter(NffText& out) : out_(out) {}

    /// `parent_place`: index of the parent among its siblings, -1 for the first ball.
    void write(const Ball& ball, int parent_place, std::uint64_t levels) {
        out_.sphere(ball.center, ball.radius);
        if (levels == 0) return;
        const double h = std::hypot(ball.direction.x, ball.direction.y);
        for (int place = 0; place < 9; ++place) {
            const Vec3& w = directions_[static_cast<std::size_t>(place)];
            Vec3 direction;
            if (h > 1e-9) {  // shortest rotation from +z
                const Vec3 axis{-ball.direction.y / h, ball.direction.x / h, 0};
                const double c = ball.direction.z;
                direction = c * w + h * cross(axis, w) + (dot(axis, w) * (1 - c)) * axis;
            } else if (ball.direction.z > 0) {
                direction = w;
            } else {
                // All half turns are equally short; turn about y. Exception: where the sixth of the
                // first nine has such a ball, the published file mirrors its children through the
                // centre (the original's rotation axis evaluated to zero there).
                const bool mirrored = depth_ == 2 && parent_place == 5;
                direction = mirrored ? -w : Vec3{-w.x, w.y, -w.z};
            }
            ++depth_;
            write({ball.center + (ball.radius * 4 / 3) * direction, direction, ball.radius / 3,
                   place},
                  ball.place, levels - 1);
            --depth_;
        }
    }

  private:
    NffText& out_;
    std::array<Vec3, 9> directions_ = ball_directions();
    int depth_ = 0;
};

// jacks

void write_jack(const Affine& world_from_jack, double size, std::uint64_t levels, NffText& out) {
    constexpr double kArm = 0.75, kRod = 0.075, kKnob = 0.15;
    std::array<Vec3, 3> ends;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 end{};
        end[axis] = -kArm;  // the published file begins at this side
        ends[static_cast<std::size_t>(axis)] = world_from_jack.vector(end);
    }
    const Vec3 center = world_from_jack.translation;
    for (const Vec3& e : ends) out.cone(center + e, kRod * size, center - e, kRod * size);
    for (const Vec3& e : ends) out.sphere(center - e, kKnob * size);
    for (const Vec3& e : ends) out.sphere(center + e, kKnob * size);
    if (levels == 1) return;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 offset{(corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                          (corner & 4) != 0 ? 0.5 : -0.5};
        const Affine small =
            world_from_jack * Affine::translate(kArm * offset) * Affine::scale({0.5, 0.5, 0.5});
        write_jack(small, size / 2, levels - 1, out);
    }
}

// mount

/// Heights on a lattice of (2^n + 1)^2 points by midpoint displacement.
class Mountain {
  public:
    explicit Mountain(std::uint64_t n) : cells_(std::int64_t{1} << n) {
        heights_.resize(static_cast<std::size_t>((cells_ + 1) * (cells_ + 1)));
        double reach = kFirstReach;
        for (std::int64_t step = cells_; step > 1; step /= 2) {
            divide(step, reach);
            reach *= kShrink;
        }
    }
    [[nodiscard]] Vec3 point(std::int64_t x, std::int64_t y) const {
        const auto place = [&](std::int64_t i) {
            return -1.0 + 2.0 * static_cast<double>(i) / static_cast<double>(cells_);
        };
        return {place(x), place(y), at(x, y)};
    }
    [[nodiscard]] std::int64_t cells() const { return cells_; }

  private:
    static constexpr double kFirstReach = 0.55;
    static constexpr double kShrink = 0.54;  ///< 2^-H with H = 0.89: fractal dimension 2.11

    [[nodiscard]] double at(std::int64_t x, std::int64_t y) const {
        return heights_[static_cast<std::size_t>(y * (cells_ + 1) + x)];
    }
    void set(std::int64_t x, std::int64_t y, double mean, double reach) {
        const double noise = 2.0 * random_at(3, static_cast<std::uint64_t>(x * 65536 / cells_),
                                             static_cast<std::uint64_t>(y * 65536 / cells_), 0) -
                             1.0;
        heights_[static_cast<std::size_t>(y * (cells_ + 1) + x)] = mean + reach * noise;
    }
    /// Sets the heights at the midpoints of edges, then of squares, of side `step`.
    void divide(std::int64_t step, double reach) {
        const std::int64_t half = step / 2;
        for (std::int64_t y = 0; y <= cells_; y += step) {
            for (std::int64_t x = half; x < cells_; x += step) {
                set(x, y, 0.5 * (at(x - half, y) + at(x + half, y)), reach);
            }
        }
        for (std::int64_t y = half; y < cells_; y += step) {
            for (std::int64_t x = 0; x <= cells_; x += step) {
                set(x, y, 0.5 * (at(x, y - half) + at(x, y + half)), reach);
            }
        }
        for (std::int64_t y = half; y < cells_; y += step) {
            for (std::int64_t x = half; x < cells_; x += step) {
                set(x, y,
                    0.25 * (at(x - half, y) + at(x + half, y) + at(x, y - half) + at(x, y + half)),
                    reach);
            }
        }
    }

    std::int64_t cells_;
    std::vector<double> heights_;
};

/// Writes the square from (x, y) by quarters, in the order of the published file.
void write_square(const Mountain& m, std::int64_t x, std::int64_t y, std::int64_t side,
                  NffText& out) {
    if (side > 1) {
        const std::int64_t h = side / 2;
        write_square(m, x, y, h, out);
        write_square(m, x + h, y, h, out);
        write_square(m, x + h, y + h, h, out);
        write_square(m, x, y + h, h, out);
        return;
    }
    const Vec3 a = m.point(x, y), b = m.point(x + 1, y), c = m.point(x + 1, y + 1),
               d = m.point(x, y + 1);
    out.polygon(std::array{a, b, c});
    out.polygon(std::array{c, d, a});
}

// tetra

constexpr Vec3 kTetraCorners[] = {{-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {1, 1, 1}};

void write_tetrahedron(const Vec3& center, double size, std::uint64_t levels, NffText& out) {
    if (levels > 1) {
        for (const Vec3& corner : kTetraCorners) {
            write_tetrahedron(center + (size / 2) * corner, size / 2, levels - 1, out);
        }
        return;
    }
    static constexpr int kFaces[4][3] = {{0, 1, 2}, {3, 2, 1}, {2, 3, 0}, {1, 0, 3}};
    for (const auto& face : kFaces) {
        std::array<Vec3, 3> triangle;
        for (std::size_t i = 0; i < 3; ++i) triangle[i] = center + size * kTetraCorners[face[i]];
        out.polygon(triangle);
    }
}

// tree

struct Branching {
    Affine parent_from_branch;
    double length;  ///< relative to the parent's
};

void write_branch(const Vec3& base, const Affine& frame, double length, double radius,
                  std::uint64_t levels, NffText& out) {
    static const std::array<Branching, 2> kBranches{
        {{rotation({0, 0, 1}, 90) * rotation({1, 0, 0}, 40), 0.65},
         {rotation({0, 0, 1}, 230) * rotation({1, 0, 0}, 25), 0.70}}};
    constexpr double kTaper = 0.67;
    const Vec3 end = base + length * frame.vector({0, 0, 1});
    out.cone(base, radius, end, kTaper * radius);
    out.sphere(end, kTaper * radius);
    if (levels == 0) return;
    for (const Branching& branch : kBranches) {
        write_branch(end, frame * branch.parent_from_branch, branch.length * length,
                     kTaper * radius, levels - 1, out);
    }
}

}  // namespace

void write_balls(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view({.from = {2.1, 1.3, 1.7}, .at = {0, 0, 0}, .up = {0, 0, 1}, .hither = 0.01});
    for (const Vec3& light : {Vec3{4, 3, 2}, Vec3{1, -4, 4}, Vec3{-3, 1, 5}}) out.light(light);
    out.fill({.color = {1, 0.75, 0.33}, .diffuse = 0.8, .shininess = kDull, .index = 1});
    out.polygon(
        std::array<Vec3, 4>{{{12, 12, -0.5}, {-12, 12, -0.5}, {-12, -12, -0.5}, {12, -12, -0.5}}});
    out.fill(
        {.color = {1, 0.9, 0.7}, .diffuse = 0.5, .specular = 0.5, .shininess = 3.0827, .index = 1});
    BallWriter(out).write({{0, 0, 0}, {0, 0, 1}, 0.5, -1}, -1, n);
}

void write_jacks(std::uint64_t n, NffText& out) {
    out.background({0.2, 0.05, 0.2});
    out.view({.from = {0, 0, -8},
              .at = {0, 0, 0},
              .up = {0, 1, 0},
              .angle_deg = 25,
              .hither = 0.001,
              .resolution = 256});
    out.light({-10, 3, -20});
    out.fill({.color = {0.737, 0.561, 0.561},
              .diffuse = 0.7,
              .specular = 0.7,
              .shininess = 11.1434,
              .index = 1});
    write_jack(rotation({1, 0, 0}, -30) * rotation({0, 1, 0}, -20), 1, n, out);
}

void write_mount(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view({.from = {-1.6, 1.6, 1.7}, .at = {0, 0, 0}, .up = {0, 0, 1}, .hither = 0.01});
    out.light({-100, -100, 100});
    out.fill({.color = {1, 1, 1},
              .diffuse = 0.1,
              .specular = 0.1,
              .shininess = 101.148,
              .transmission = 0.9,
              .index = 1.5});
    // Four touching spheres around (-0.8, 0.8, 1).
    constexpr double kRadius = 0.17, kEdge = 2 * kRadius;
    const double above = kEdge * std::sqrt(6.0) / 4, below = above / 3;
    const Vec3 middle{-0.8, 0.8, 1};
    out.sphere(middle + Vec3{0, 0, above}, kRadius);
    for (const double degrees : {-45.0, 75.0, 195.0}) {
        const double a = degrees * kRadiansPerDegree, r = kEdge / std::sqrt(3.0);
        out.sphere(middle + Vec3{r * std::cos(a), r * std::sin(a), -below}, kRadius);
    }
    out.fill({.color = {0.5, 0.45, 0.35}, .diffuse = 1, .shininess = kDull});
    const Mountain mountain(n);
    write_square(mountain, 0, 0, mountain.cells(), out);
}

void write_tetra(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view({.from = {1.02285, -3.17715, -2.17451},
              .at = {-0.004103, -0.004103, 0.216539},
              .up = {-0.816497, -0.816497, 0.816497}});
    out.light({2, -18, -5});
    out.fill({.color = {1, 0.2, 0.2}, .diffuse = 1, .shininess = kDull});
    write_tetrahedron({0, 0, 0}, 1, n, out);
}

void write_tree(std::uint64_t n, NffText& out) {
    out.background(kSky);
    out.view({.from = {4.5, 0.4, 2}, .at = {0, 0, 1.5}, .up = {0, 0, 1}});
    constexpr Vec3 kLights[] = {{-5, 5, 50},   {30, -30, 30}, {-40, -30, 20}, {10, 30, 40},
                                {-30, 40, 10}, {50, 25, 20},  {-10, -60, 30}};
    for (const Vec3& light : kLights) out.light(light);
    out.fill({.color = {0.2, 0.7, 0.2}, .diffuse = 1, .shininess = kDull});
    out.polygon(std::array<Vec3, 4>{{{50, 50, 0}, {-50, 50, 0}, {-50, -50, 0}, {50, -50, 0}}});
    out.fill({.color = {0.55, 0.4, 0.2}, .diffuse = 1, .shininess = kDull});
    write_branch({0, 0, 0}, Affine{}, 1, 0.15, n, out);
}

}  // namespace alhazen
