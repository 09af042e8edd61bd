#include "alhazen/shapes/meshes/height_field.h"

#include <algorithm>

#include "alhazen/base/number_text.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

namespace {

/// Keeps the numbers of all triangles within 32 bits.
constexpr std::uint64_t kMaxSamples = std::uint64_t{1} << 29;

/// Traverses the squares of the pyramid that the ray may cross, nearest first.
class HeightFieldWalk {
  public:
    HeightFieldWalk(const HeightField& field, const Ray& ray, ShapeHits& hits)
        : field_(field),
          ray_(ray),
          hits_(hits),
          line_{ray.origin, ray.direction, -kInfinity, kInfinity},
          shear_(ray.direction),
          top_level_(static_cast<std::uint32_t>(field.pyramid->levels.size())),
          nearest_(ray.t_max) {
        const Vec3 reach{std::max(std::abs(field.bounds.lo.x), std::abs(field.bounds.hi.x)),
                         std::max(std::abs(field.bounds.lo.y), std::abs(field.bounds.hi.y)),
                         std::max(std::abs(field.bounds.lo.z), std::abs(field.bounds.hi.z))};
        // Error of a point at t in the triangle test (geometry/watertight_triangle.h).
        pad_ = 0x1p-36 * (max_component(abs(ray.origin)) + max_component(reach));
        within_ = slabs(field.bounds, 0.0);
    }

    /// Returns false if the order of the crossings requires all crossings of the line.
    bool run(bool only_first) {
        only_first_ = only_first;
        visit(top_level_, 0, 0, false);
        visit(top_level_, 0, 0, true);
        std::sort(hits_.begin(), hits_.end(), [](const ShapeHit& a, const ShapeHit& b) {
            return a.t != b.t ? a.t < b.t : a.part < b.part;
        });
        for (std::size_t i = 1; i < hits_.size(); ++i) {
            if (hits_[i].t == hits_[i - 1].t) return false;
        }
        return true;
    }

    /// Makes crossings at equal t alternate between entry and exit: where the ray passes an edge or
    /// a vertex, or where t is rounded to the same value.
    void alternate() {
        bool inside = false;
        for (std::size_t i = 0; i < hits_.size(); ++i, inside = !inside) {
            for (std::size_t k = i; k < hits_.size() && hits_[k].t == hits_[i].t; ++k) {
                if (enters(hits_[k].part) == inside) continue;
                std::swap(hits_[i], hits_[k]);
                break;
            }
        }
    }

  private:
    [[nodiscard]] std::uint32_t columns(std::uint32_t level) const {
        return level == 0 ? field_.columns - 1 : field_.pyramid->levels[level - 1].columns;
    }
    [[nodiscard]] std::uint32_t rows(std::uint32_t level) const {
        return level == 0 ? field_.rows - 1 : field_.pyramid->levels[level - 1].rows;
    }

    /// The square's box; `bottom`: only that of its bottom.
    [[nodiscard]] Box3 box(std::uint32_t level, std::uint32_t i, std::uint32_t j,
                           bool bottom) const {
        const std::uint32_t i0 = i << level, j0 = j << level;
        const std::uint32_t i1 = std::min((i + 1) << level, field_.columns - 1);
        const std::uint32_t j1 = std::min((j + 1) << level, field_.rows - 1);
        const Vec3 a = field_.vertex(i0, j0, true), b = field_.vertex(i1, j1, true);
        Box3 box{{a.x, a.y, field_.base}, {b.x, b.y, field_.base}};
        if (bottom) return box;
        double lowest, highest;
        if (level == 0) {
            const auto [least, most] = std::minmax({field_.height(i0, j0), field_.height(i1, j0),
                                                    field_.height(i0, j1), field_.height(i1, j1)});
            lowest = double{least};
            highest = double{most};
        } else {
            const HeightPyramid::Level& l = field_.pyramid->levels[level - 1];
            lowest = double{l.lowest[std::size_t{j} * l.columns + i]};
            highest = double{l.highest[std::size_t{j} * l.columns + i]};
        }
        // Squares at the border include the sides.
        const bool border = i0 == 0 || j0 == 0 || i1 == field_.columns - 1 || j1 == field_.rows - 1;
        if (!border) box.lo.z = lowest;
        box.hi.z = highest;
        return box;
    }

    /// The range of the line in the box grown by `pad`.
    [[nodiscard]] Interval slabs(const Box3& box, double pad) const {
        Interval t{-kInfinity, kInfinity};
        for (int k = 0; k < 3; ++k) {
            const double lo = box.lo[k] - pad - ray_.origin[k];
            const double hi = box.hi[k] + pad - ray_.origin[k];
            const double d = ray_.direction[k];
            if (d == 0.0) {
                if (lo > 0.0 || hi < 0.0) return {};
                continue;
            }
            const double a = lo / d, b = hi / d;
            t.lo = std::max(t.lo, std::min(a, b));
            t.hi = std::min(t.hi, std::max(a, b));
        }
        return t;
    }

    [[nodiscard]] bool may_pass(const Box3& box) const {
        const Interval t = slabs(box, pad_);
        const double enter = std::max(ray_.t_min, t.lo), leave = std::min(nearest_, t.hi);
        // Margin for the rounding of these two.
        return !(enter > leave + 0x1p-50 * (std::abs(enter) + std::abs(leave)));
    }

    void visit(std::uint32_t level, std::uint32_t i, std::uint32_t j, bool bottom) {
        if (i >= columns(level) || j >= rows(level) || !may_pass(box(level, i, j, bottom))) return;
        if (level == 0) return bottom ? intersect_bottom(i, j) : intersect_top(i, j);
        const std::uint32_t near_i = ray_.direction.x < 0.0, near_j = ray_.direction.y < 0.0;
        for (std::uint32_t k = 0; k < 4; ++k) {
            visit(level - 1, 2 * i + ((k & 1) ^ near_i), 2 * j + ((k >> 1) ^ near_j), bottom);
        }
    }

    void meet(std::uint32_t part) {
        const auto [a, b, c] = field_.triangle(part);
        ShapeHit hit;
        if (!intersect_triangle(line_, shear_, a, b, c, hit)) return;
        hit.part = part;
        // For a ray nearly in the triangle's plane t is mostly rounding; this keeps it in the box.
        if (within_.lo <= within_.hi) {
            hit.t = std::max(within_.lo, std::min(hit.t, within_.hi));
        }
        if (!ray_.covers(hit.t)) return;
        hits_.push_back(hit);
        if (only_first_) nearest_ = std::min(nearest_, hit.t);
    }
    void intersect_bottom(std::uint32_t i, std::uint32_t j) {
        const std::uint32_t first = 2 * (field_.cells() + j * (field_.columns - 1) + i);
        meet(first);
        meet(first + 1);
    }
    void intersect_top(std::uint32_t i, std::uint32_t j) {
        const std::uint32_t columns = field_.columns - 1, rows = field_.rows - 1;
        const std::uint32_t first = 2 * (j * columns + i);
        meet(first);
        meet(first + 1);
        const auto side = [&](std::uint32_t place) {
            meet(4 * field_.cells() + 2 * place);
            meet(4 * field_.cells() + 2 * place + 1);
        };
        if (j == 0) side(i);
        if (j == rows - 1) side(columns + i);
        if (i == 0) side(2 * columns + j);
        if (i == columns - 1) side(2 * columns + rows + j);
    }

    [[nodiscard]] bool enters(std::uint32_t part) const {
        const auto [a, b, c] = field_.triangle(part);
        return dot(accurate_cross(b - a, c - a), ray_.direction) < 0.0;
    }

    const HeightField& field_;
    const Ray& ray_;
    ShapeHits& hits_;
    const Ray line_;
    Interval within_{};  ///< range of the line in the bounds
    const RayShear shear_;
    std::uint32_t top_level_;
    double nearest_;
    double pad_ = 0;
    bool only_first_ = false;
};

HeightPyramid::Level next_level(const HeightField& field, const HeightPyramid& below) {
    const bool first = below.levels.empty();
    const std::uint32_t columns = first ? field.columns - 1 : below.levels.back().columns;
    const std::uint32_t rows = first ? field.rows - 1 : below.levels.back().rows;
    HeightPyramid::Level level;
    level.columns = (columns + 1) / 2;
    level.rows = (rows + 1) / 2;
    for (std::uint32_t j = 0; j < level.rows; ++j) {
        for (std::uint32_t i = 0; i < level.columns; ++i) {
            float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
            // The end in corners for cells (`first`), else in squares.
            const std::uint32_t end_i = std::min(2 * i + (first ? 3 : 2), columns + first);
            const std::uint32_t end_j = std::min(2 * j + (first ? 3 : 2), rows + first);
            for (std::uint32_t y = 2 * j; y < end_j; ++y) {
                for (std::uint32_t x = 2 * i; x < end_i; ++x) {
                    const std::size_t at = std::size_t{y} * columns + x;
                    lowest = std::min(lowest,
                                      first ? field.height(x, y) : below.levels.back().lowest[at]);
                    highest = std::max(
                        highest, first ? field.height(x, y) : below.levels.back().highest[at]);
                }
            }
            level.lowest.push_back(lowest);
            level.highest.push_back(highest);
        }
    }
    return level;
}

}  // namespace

Vec3 HeightField::vertex(std::uint32_t column, std::uint32_t row, bool at_base) const {
    // The last samples lie exactly at the end.
    const auto place = [](double from, double to, std::uint32_t i, std::uint32_t count) {
        return i + 1 == count ? to : from + (to - from) * i / (count - 1);
    };
    return {place(lo.x, hi.x, column, columns), place(lo.y, hi.y, row, rows),
            at_base ? base : double{height(column, row)}};
}

std::array<Vec3, 3> HeightField::triangle(std::uint32_t part) const {
    const std::uint32_t across = columns - 1, up = rows - 1, k = part & 1;
    if (part < 4 * cells()) {
        const bool bottom = part >= 2 * cells();
        const std::uint32_t cell = (bottom ? part - 2 * cells() : part) / 2;
        const std::uint32_t i = cell % across, j = cell / across;
        const Vec3 a = vertex(i, j, bottom), c = vertex(i + 1, j + 1, bottom);
        const Vec3 b = k == 0 ? vertex(i + 1, j, bottom) : vertex(i, j + 1, bottom);
        // Reversed at the bottom.
        if ((k == 0) != bottom) return {a, b, c};
        return {a, c, b};
    }
    std::uint32_t place = (part - 4 * cells()) / 2;
    std::uint32_t i0, j0, i1, j1;
    bool turned = false;
    if (place < 2 * across) {
        turned = place >= across;
        i0 = turned ? place - across : place;
        i1 = i0 + 1;
        j0 = j1 = turned ? up : 0;
    } else {
        place -= 2 * across;
        turned = place < up;
        j0 = turned ? place : place - up;
        j1 = j0 + 1;
        i0 = i1 = turned ? 0 : across;
    }
    if (turned) {
        std::swap(i0, i1);
        std::swap(j0, j1);
    }
    // In the order seen from outside, beginning at the lower left.
    const Vec3 left = vertex(i0, j0, true), right_top = vertex(i1, j1);
    if (k == 0) return {left, vertex(i1, j1, true), right_top};
    return {left, right_top, vertex(i0, j0)};
}

void HeightField::prepare() {
    auto made = std::make_shared<HeightPyramid>();
    float highest = -std::numeric_limits<float>::infinity();
    for (const float h : *heights) highest = std::max(highest, h);
    while (made->levels.empty() || made->levels.back().columns > 1 ||
           made->levels.back().rows > 1) {
        made->levels.push_back(next_level(*this, *made));
    }
    pyramid = std::move(made);
    bounds = {{lo.x, lo.y, base}, {hi.x, hi.y, double{highest}}};
}

void HeightField::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.point("lo", {lo.x, lo.y, base});
    checks.point("hi", {hi.x, hi.y, 0.0});
    if (!(lo.x < hi.x && lo.y < hi.y)) checks.fail("lo must be less than hi along x and y");
    if (columns < 2 || rows < 2) return checks.fail("at least 2 x 2 heights must be given");
    const std::uint64_t samples = std::uint64_t{columns} * rows;
    if (samples > kMaxSamples) return checks.fail("more than 2^29 heights");
    if (heights == nullptr || heights->size() != samples) {
        return checks.fail("expected " + std::to_string(columns) + " x " + std::to_string(rows) +
                           " heights, found " +
                           std::to_string(heights == nullptr ? 0 : heights->size()));
    }
    for (const float h : *heights) {
        // The negation covers NaN.
        if (!(double{h} > base && h <= std::numeric_limits<float>::max())) {
            return checks.fail("every height must be a number above the base, which is " +
                               shortest(base) + "; found " + shortest(double{h}));
        }
    }
}

Interval HeightField::extent(const Vec3& axis) const {
    const Interval range = alhazen::extent(bounds, axis);
    const Vec3 reach{std::max(std::abs(bounds.lo.x), std::abs(bounds.hi.x)),
                     std::max(std::abs(bounds.lo.y), std::abs(bounds.hi.y)),
                     std::max(std::abs(bounds.lo.z), std::abs(bounds.hi.z))};
    const double pad = gamma_bound(8) * dot(abs(axis), reach);
    return {range.lo - pad, range.hi + pad};
}

void HeightField::intersect(const Ray& ray, ShapeHits& hits) const {
    // The triangle test multiplies three numbers of the ray.
    const int exponent = std::ilogb(max_component(abs(ray.direction)));
    const double scale = std::abs(exponent) > 100 ? std::ldexp(1.0, -exponent / 2) : 1.0;
    const Ray whole{ray.origin, scale * (scale * ray.direction), -kInfinity, kInfinity};
    Ray part = whole;
    part.t_min = ray.t_min / scale / scale;
    part.t_max = ray.t_max / scale / scale;
    ShapeHits found;
    if (!HeightFieldWalk(*this, part, found).run(hits.wanted() == 1)) {
        found.clear();
        HeightFieldWalk walk(*this, whole, found);
        walk.run(false);
        walk.alternate();
    }
    for (const ShapeHit& hit : found) {
        if (!std::isfinite(scale * (scale * hit.t))) return;
    }
    for (ShapeHit hit : found) {
        if (!part.covers(hit.t)) continue;
        hit.t = scale * (scale * hit.t);
        hits.push_back(hit);
        if (hits.enough()) return;
    }
}

ShapeSurface HeightField::surface(const Ray&, const ShapeHit& hit) const {
    const auto [p0, p1, p2] = triangle(hit.part);
    const double rest = 1.0 - hit.u, w = rest - hit.v;
    ShapeSurface surface;
    const Vec3 p = w * p0 + hit.u * p1 + hit.v * p2;
    for (int k = 0; k < 3; ++k) {
        surface.point[k] = std::clamp(p[k], bounds.lo[k], bounds.hi[k]);
    }
    // Error bound as for a triangle of a mesh.
    surface.error = gamma_bound(7) * (std::abs(w) * abs(p0) + std::abs(hit.u) * abs(p1) +
                                      std::abs(hit.v) * abs(p2)) +
                    gamma_bound(2) * std::abs(rest) * abs(p0);
    const Vec3 n = unit_or(accurate_cross(p1 - p0, p2 - p0), {0, 0, 1});
    surface.normal = surface.shading_normal = n;
    const double x = (surface.point.x - lo.x) / (hi.x - lo.x);
    const double y = (surface.point.y - lo.y) / (hi.y - lo.y);
    if (hit.part < 4 * cells()) {
        surface.uv = {x, y};
        surface.dpdu = (hi.x - lo.x) * Vec3{1.0, 0.0, -n.x / n.z};
        surface.dpdv = (hi.y - lo.y) * Vec3{0.0, 1.0, -n.y / n.z};
        return surface;
    }
    const bool along_x = n.x == 0.0;
    surface.uv = {along_x ? x : y, (surface.point.z - base) / (bounds.hi.z - base)};
    surface.dpdu = along_x ? Vec3{hi.x - lo.x, 0.0, 0.0} : Vec3{0.0, hi.y - lo.y, 0.0};
    surface.dpdv = {0.0, 0.0, bounds.hi.z - base};
    return surface;
}

}  // namespace alhazen
