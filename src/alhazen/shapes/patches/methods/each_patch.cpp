#include "alhazen/shapes/patches/methods/each_patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/shapes/patches/patch_value.h"

namespace alhazen {
namespace {

PatchLine planes_of(const Ray& ray) {
    PatchLine line;
    const double size = length(ray.direction);
    line.direction = ray.direction / size;
    line.per_length = 1.0 / size;
    line.origin = ray.origin;
    line.axis_x = perpendicular(line.direction);
    line.axis_y = cross(line.direction, line.axis_x);
    return line;
}

/// One row of control points over [a, b], by de Casteljau's algorithm at both ends.
void cut_row(PlanePoint* row, int degree, double a, double b) {
    PlanePoint low[kMaxPatchOrder];
    for (int level = 0; level <= degree; ++level) {
        low[level] = row[0];
        for (int k = 0; k < degree - level; ++k) row[k] = (1.0 - b) * row[k] + b * row[k + 1];
    }
    const double at = b > 0.0 ? a / b : 0.0;
    // The last of each level are the control points of the upper part, from its end.
    for (int level = 0; level <= degree; ++level) {
        row[degree - level] = low[degree - level];
        for (int k = 0; k < degree - level; ++k) low[k] = (1.0 - at) * low[k] + at * low[k + 1];
    }
}

}  // namespace

PatchQuestion::PatchQuestion(const Ray& ray_, std::vector<PatchCrossing>& out,
                             PatchMethodCounts& counts_)
    : ray(ray_), counts(counts_), line(planes_of(ray_)), out_(out) {}

void PatchQuestion::report(const BezierNet& net, std::uint32_t patch, double u, double v) {
    const Vec3 offset = patch_value(net, u, v).point - line.origin;
    const double t = dot(offset, line.direction) * line.per_length;
    if (ray.covers(t)) out_.push_back({t, u, v, patch});
}

EachPatchMethod::EachPatchMethod(std::span<const BezierNet> nets)
    : nets_(nets.begin(), nets.end()) {
    for (const BezierNet& net : nets_) {
        boxes_.push_back(control_box(net));
        box_.include(boxes_.back());
    }
}

void EachPatchMethod::crossings(const Ray& ray, std::vector<PatchCrossing>& out,
                                PatchMethodCounts& counts) {
    PatchQuestion question(ray, out, counts);
    ++counts.rays;
    const double margin = 1e-12 * (max_component(box_.size()) + length(ray.origin));
    for (std::size_t k = 0; k < nets_.size(); ++k) {
        if (!line_meets(boxes_[k], margin, ray)) continue;
        ++counts.patches;
        meet(nets_[k], static_cast<std::uint32_t>(k), question);
    }
}

bool line_meets(const Box3& box, double margin, const Ray& ray) {
    double enter = -kInfinity, leave = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = box.lo[axis] - margin - ray.origin[axis];
        const double hi = box.hi[axis] + margin - ray.origin[axis];
        const double d = ray.direction[axis];
        if (d == 0.0) {
            if (lo > 0.0 || hi < 0.0) return false;
            continue;
        }
        const double a = lo / d, b = hi / d;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

PlaneValue plane_value(const PlaneNet& net, double u, double v) {
    double bu[kMaxPatchOrder], du[kMaxPatchOrder], bv[kMaxPatchOrder], dv[kMaxPatchOrder];
    bernstein_values(net.degree_u, u, bu, du);
    bernstein_values(net.degree_v, v, bv, dv);
    PlaneValue out{{0, 0}, {0, 0}, {0, 0}};
    std::size_t k = 0;
    for (int i = 0; i <= net.degree_u; ++i) {
        PlanePoint f{0, 0}, f_v{0, 0};
        for (int j = 0; j <= net.degree_v; ++j, ++k) {
            f = f + bv[j] * net.at[k];
            f_v = f_v + dv[j] * net.at[k];
        }
        out.f = out.f + bu[i] * f;
        out.f_u = out.f_u + du[i] * f;
        out.f_v = out.f_v + bu[i] * f_v;
    }
    return out;
}

PlaneNet part_of(const PlaneNet& net, const PatchCell& cell) {
    PlaneNet out = net;
    const int n = net.degree_u, m = net.degree_v;
    const auto index = [&](int i, int j) { return static_cast<std::size_t>(i * (m + 1) + j); };
    PlanePoint row[kMaxPatchOrder];
    if (cell.v0 > 0.0 || cell.v1 < 1.0) {
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; j <= m; ++j) row[j] = out.at[index(i, j)];
            cut_row(row, m, cell.v0, cell.v1);
            for (int j = 0; j <= m; ++j) out.at[index(i, j)] = row[j];
        }
    }
    if (cell.u0 > 0.0 || cell.u1 < 1.0) {
        for (int j = 0; j <= m; ++j) {
            for (int i = 0; i <= n; ++i) row[i] = out.at[index(i, j)];
            cut_row(row, n, cell.u0, cell.u1);
            for (int i = 0; i <= n; ++i) out.at[index(i, j)] = row[i];
        }
    }
    return out;
}

double PlaneRange::size() const {
    return std::max({std::abs(lo_x), std::abs(hi_x), std::abs(lo_y), std::abs(hi_y)});
}

PlaneRange range_of(const PlaneNet& net) {
    PlaneRange range{kInfinity, -kInfinity, kInfinity, -kInfinity};
    for (std::size_t k = 0; k < static_cast<std::size_t>(net.count()); ++k) {
        range.lo_x = std::min(range.lo_x, net.at[k].x);
        range.hi_x = std::max(range.hi_x, net.at[k].x);
        range.lo_y = std::min(range.lo_y, net.at[k].y);
        range.hi_y = std::max(range.hi_y, net.at[k].y);
    }
    return range;
}

bool is_new_root(std::vector<std::pair<double, double>>& roots, double u, double v, double same) {
    for (const auto& [a, b] : roots) {
        if (std::abs(a - u) <= same && std::abs(b - v) <= same) return false;
    }
    roots.emplace_back(u, v);
    return true;
}

std::span<const PatchMethodEntry> patch_methods() {
    static constexpr std::array kMethods{
        PatchMethodEntry{"subdivision", "boxes", &make_subdivision},
        PatchMethodEntry{"kajiya", "steps of Laguerre's method", &make_kajiya},
        PatchMethodEntry{"toth", "domains and steps of Newton's method", &make_toth},
        PatchMethodEntry{"joy_bhetanabhotla", "quasi-Newton steps", &make_joy_bhetanabhotla},
        PatchMethodEntry{"bezier_clipping", "clips", &make_bezier_clipping},
        PatchMethodEntry{"certified_newton", nullptr, &make_certified_newton}};
    return kMethods;
}

const PatchMethodEntry& patch_method(const std::string& name) {
    std::string known;
    for (const PatchMethodEntry& entry : patch_methods()) {
        if (name == entry.name) return entry;
        known += known.empty() ? entry.name : std::string(", ") + entry.name;
    }
    throw Error(ErrorKind::Usage,
                "no method '" + name + "' for patches; the valid ones are: " + known);
}

}  // namespace alhazen
