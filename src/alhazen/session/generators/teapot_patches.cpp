#include "alhazen/session/generators/teapot_patches.h"

namespace alhazen {

namespace {

/// Point of a profile: distance from the axis; distance of the inner control points of a quarter
/// turn from the nearer coordinate plane; height.
struct ProfilePoint {
    double radius, inner, z;
};
using TeapotProfile = std::array<ProfilePoint, 4>;

constexpr TeapotProfile kRim{
    {{1.4, 0.784, 2.4}, {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125}, {1.5, 0.84, 2.4}}};
constexpr TeapotProfile kShoulder{
    {{1.5, 0.84, 2.4}, {1.75, 0.98, 1.875}, {2.0, 1.12, 1.35}, {2.0, 1.12, 0.9}}};
constexpr TeapotProfile kBelly{
    {{2.0, 1.12, 0.9}, {2.0, 1.12, 0.45}, {1.5, 0.84, 0.225}, {1.5, 0.84, 0.15}}};
constexpr TeapotProfile kKnob{{{0, 0, 3.15}, {0.8, 0.45, 3.15}, {0, 0, 2.85}, {0.2, 0.112, 2.7}}};
constexpr TeapotProfile kLid{
    {{0.2, 0.112, 2.7}, {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4}}};
constexpr TeapotProfile kBottom{
    {{0, 0, 0}, {1.425, 0.798, 0}, {1.5, 0.84, 0.075}, {1.5, 0.84, 0.15}}};

/// Row of handle or spout: two points of the outline in the plane y = 0, and the extent of the
/// surface perpendicular to that plane.
struct HalfRow {
    double x0, z0, x1, z1, width;
};
using Half = std::array<HalfRow, 4>;

constexpr Half kUpperHandle{{{-1.6, 2.025, -1.5, 2.25, 0.3},
                             {-2.3, 2.025, -2.5, 2.25, 0.3},
                             {-2.7, 2.025, -3.0, 2.25, 0.3},
                             {-2.7, 1.8, -3.0, 1.8, 0.3}}};
constexpr Half kLowerHandle{{{-2.7, 1.8, -3.0, 1.8, 0.3},
                             {-2.7, 1.575, -3.0, 1.35, 0.3},
                             {-2.5, 1.125, -2.65, 0.9375, 0.3},
                             {-2.0, 0.9, -1.9, 0.6, 0.3}}};
constexpr Half kLowerSpout{{{1.7, 1.425, 1.7, 0.6, 0.66},
                            {2.6, 1.425, 3.1, 0.825, 0.66},
                            {2.3, 2.1, 2.4, 2.025, 0.25},
                            {2.7, 2.4, 3.3, 2.4, 0.25}}};
constexpr Half kUpperSpout{{{2.7, 2.4, 3.3, 2.4, 0.25},
                            {2.8, 2.475, 3.525, 2.49375, 0.25},
                            {2.9, 2.475, 3.45, 2.5125, 0.15},
                            {2.8, 2.4, 3.2, 2.4, 0.15}}};

/// Adds four quarters, the first from +x towards -y (`sense` -1) or +y (`sense` 1).
void add_turned(const TeapotProfile& profile, double sense, std::vector<TeapotPatch>& patches) {
    for (int quarter = 0; quarter < 4; ++quarter) {
        TeapotPatch patch;
        for (std::size_t i = 0; i < 4; ++i) {
            const ProfilePoint& p = profile[i];
            const Vec2 row[] = {
                {p.radius, 0}, {p.radius, p.inner}, {p.inner, p.radius}, {0, p.radius}};
            for (std::size_t j = 0; j < 4; ++j) {
                Vec2 q = row[j];
                for (int k = 0; k < quarter; ++k) q = {-q.y, q.x};
                patch[i][j] = {q.x + 0.0, sense * q.y + 0.0, p.z};  // + 0.0: no -0
            }
        }
        patches.push_back(patch);
    }
}

/// Adds the half at negative y, then its mirror image, traversed in the opposite direction.
void add_halves(const Half& half, std::vector<TeapotPatch>& patches) {
    TeapotPatch near_half, far_half;
    for (std::size_t i = 0; i < 4; ++i) {
        const HalfRow& r = half[i];
        near_half[i] = {
            {{r.x0, 0, r.z0}, {r.x0, -r.width, r.z0}, {r.x1, -r.width, r.z1}, {r.x1, 0, r.z1}}};
        far_half[i] = {
            {{r.x1, 0, r.z1}, {r.x1, r.width, r.z1}, {r.x0, r.width, r.z0}, {r.x0, 0, r.z0}}};
    }
    patches.push_back(near_half);
    patches.push_back(far_half);
}

using Weights = std::array<double, 4>;
using Square = std::array<Weights, 4>;

/// Converts Bezier control points to coefficients of t^3, t^2, t, 1.
constexpr Square kPowerFromBezier{{{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}};

Square times(const Square& a, const Square& b) {
    Square c{};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
        }
    }
    return c;
}

/// Power-basis coefficients of one coordinate.
Square coefficients(const TeapotPatch& patch, int axis) {
    Square points;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) points[i][j] = patch[i][j][axis];
    }
    return times(times(kPowerFromBezier, points), kPowerFromBezier);  // symmetric
}

/// The order of summation matters: published coordinates lie half way between two decimals.
double bilinear(const Weights& u, const Square& c, const Weights& v) {
    double sum = 0;
    for (std::size_t j = 0; j < 4; ++j) {
        double column = 0;
        for (std::size_t i = 0; i < 4; ++i) column += u[i] * c[i][j];
        sum += column * v[j];
    }
    return sum;
}

Weights powers(double t) {
    return {t * t * t, t * t, t, 1};
}
Weights derivatives(double t) {
    return {3 * t * t, 2 * t, 1, 0};
}

}  // namespace

std::vector<TeapotPatch> teapot_patches() {
    std::vector<TeapotPatch> patches;
    for (const TeapotProfile& profile : {kRim, kShoulder, kBelly}) add_turned(profile, -1, patches);
    for (const Half& half : {kUpperHandle, kLowerHandle, kLowerSpout, kUpperSpout}) {
        add_halves(half, patches);
    }
    for (const TeapotProfile& profile : {kKnob, kLid}) add_turned(profile, -1, patches);
    add_turned(kBottom, 1, patches);
    return patches;
}

PatchGrid evaluate(const TeapotPatch& patch, int cells) {
    const std::array<Square, 3> c{coefficients(patch, 0), coefficients(patch, 1),
                                  coefficients(patch, 2)};
    const auto at = [&](const Weights& u, const Weights& v) {
        return Vec3{bilinear(u, c[0], v), bilinear(u, c[1], v), bilinear(u, c[2], v)};
    };
    PatchGrid grid;
    grid.side = cells;
    for (int i = 0; i <= cells; ++i) {
        for (int j = 0; j <= cells; ++j) {
            const double u = static_cast<double>(i) / cells, v = static_cast<double>(j) / cells;
            const Vec3 point = at(powers(u), powers(v));
            Vec3 normal = cross(at(powers(u), derivatives(v)), at(derivatives(u), powers(v)));
            const double size = length(normal);
            constexpr double kNone = 1e-9;
            // Degenerate points: the top of the knob and the centre of the bottom.
            normal = size > kNone ? normal / size : Vec3{0, 0, point.z > 1 ? 1.0 : -1.0};
            grid.points.push_back(point);
            grid.normals.push_back(normal);
        }
    }
    return grid;
}

}  // namespace alhazen
