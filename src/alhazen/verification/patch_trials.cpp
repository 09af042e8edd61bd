#include "alhazen/verification/patch_trials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "alhazen/math/constants.h"

namespace alhazen {
namespace {

using SideKey = std::vector<double>;

/// The control points of a side, the same from both ends.
SideKey side_key(const BezierNet& net, int side, bool* reversed = nullptr) {
    std::array<HomogeneousPoint, kMaxPatchOrder> curve;
    const int count = boundary_curve(net, side, curve);
    SideKey forward, backward;
    for (int k = 0; k < count; ++k) {
        const auto append = [](SideKey& key, const HomogeneousPoint& p) {
            for (const double x : {p.x, p.y, p.z, p.w}) key.push_back(x + 0.0);  // no -0
        };
        append(forward, curve[static_cast<std::size_t>(k)]);
        append(backward, curve[static_cast<std::size_t>(count - 1 - k)]);
    }
    if (reversed != nullptr) *reversed = backward < forward;
    return std::min(forward, backward);
}

Vec3 unit_direction(RandomStream& random) {
    for (;;) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        const Vec3 v{x, y, random.uniform(-1, 1)};
        if (length_squared(v) <= 1.0 && length_squared(v) > 0.01) return normalize(v);
    }
}

/// A crossing by its position along the line.
struct LinePlace {
    std::uint32_t patch = 0;
    double at = 0;  ///< length along the line
    double slope = 0;
    bool inward = false;  ///< against the model's normal
    bool at_side = false, at_open_side = false;
};

LinePlace place_on(const PatchModel& model, const Ray& ray, std::uint32_t patch, double t, double u,
                   double v, double near) {
    const double size = length(ray.direction);
    const Vec3 d = ray.direction / size;
    const PatchPoint at = derivatives_at(model.nets[patch], u, v);
    const Vec3 normal = cross(at.du, at.dv);
    const double facing = std::abs(dot(normal, d));
    // Distances from the sides as seen along the line: heights of a parallelogram.
    const double per_u = facing / std::max(length(cross(at.dv, d)), 1e-300);
    const double per_v = facing / std::max(length(cross(at.du, d)), 1e-300);
    const bool by_side[4] = {v * per_v <= near, (1 - u) * per_u <= near, (1 - v) * per_v <= near,
                             u * per_u <= near};
    LinePlace place{patch, t * size, length(cross(normal, d)) / std::max(facing, 1e-300)};
    place.inward = (dot(normal, d) < 0.0) != model.turned[patch];
    for (std::size_t side = 0; side < 4; ++side) {
        place.at_side = place.at_side || by_side[side];
        if (by_side[side] && model.open[4 * patch + side]) place.at_open_side = true;
    }
    for (std::size_t corner = 0; corner < 4; ++corner) {
        if (by_side[corner < 2 ? 3 : 1] && by_side[corner % 2 == 0 ? 0 : 2] &&
            model.open_corner[4 * patch + corner]) {
            place.at_open_side = true;
        }
    }
    return place;
}

/// Pairs as many elements of the two lists as possible, in order, with the least differences: [k] =
/// index in `found` for exact crossing k, or -1.
std::vector<int> matched(const std::vector<LinePlace>& exact, const std::vector<LinePlace>& found,
                         double farthest) {
    const std::size_t n = exact.size(), m = found.size();
    constexpr double kUnmatched = 1e6;
    std::vector<double> cost((n + 1) * (m + 1));
    const auto at = [&](std::size_t i, std::size_t j) -> double& { return cost[i * (m + 1) + j]; };
    const auto pair = [&](std::size_t i, std::size_t j) {
        const double difference = std::abs(exact[i].at - found[j].at);
        return difference <= farthest ? difference / farthest : 4 * kUnmatched;
    };
    for (std::size_t i = n + 1; i-- > 0;) {
        for (std::size_t j = m + 1; j-- > 0;) {
            if (i == n || j == m) {
                at(i, j) = kUnmatched * static_cast<double>(n - i + m - j);
                continue;
            }
            at(i, j) = std::min({at(i + 1, j) + kUnmatched, at(i, j + 1) + kUnmatched,
                                 at(i + 1, j + 1) + pair(i, j)});
        }
    }
    std::vector<int> partner(n, -1);
    for (std::size_t i = 0, j = 0; i < n && j < m;) {
        if (at(i, j) == at(i + 1, j + 1) + pair(i, j)) {
            partner[i++] = static_cast<int>(j++);
        } else if (at(i, j) == at(i + 1, j) + kUnmatched) {
            ++i;
        } else {
            ++j;
        }
    }
    return partner;
}

/// Removes from `left` the crossings that rounding decides; returns the number that remain.
int judged(const std::vector<LinePlace>& left, double rounding, PatchJudgement& out) {
    std::vector<LinePlace> rest;
    for (const LinePlace& one : left) {
        if (one.at_open_side) {
            ++out.at_sides;
            continue;
        }
        // A parabola of sag h between two points of slope s is 4 h s long; a crease at distance h
        // from the line h (s0 + s1).
        const bool is_pair = !rest.empty() && one.inward != rest.back().inward &&
                             one.at - rest.back().at <=
                                 2.0 * kNear * rounding * (2.0 + one.slope + rest.back().slope);
        if (is_pair) {
            rest.pop_back();
            ++out.pairs;
        } else {
            rest.push_back(one);
        }
    }
    return static_cast<int>(rest.size());
}

}  // namespace

PatchModel::PatchModel(std::string name_, std::vector<BezierNet> nets_)
    : name(std::move(name_)), nets(std::move(nets_)) {
    std::map<SideKey, int> shared;
    for (const BezierNet& net : nets) {
        box.include(control_box(net));
        for (int side = 0; side < 4; ++side) ++shared[side_key(net, side)];
        for (int k = 0; k < net.count(); ++k) {
            const HomogeneousPoint& p = net.points[static_cast<std::size_t>(k)];
            reach = std::max(reach, length(Vec3{p.x, p.y, p.z}));
            most_weight = std::max(most_weight, p.w);
        }
    }
    for (const BezierNet& net : nets) {
        for (int side = 0; side < 4; ++side) open.push_back(shared[side_key(net, side)] % 2 != 0);
    }
    mark_open_corners();
    orient();
}

void PatchModel::orient() {
    struct SideUse {
        std::size_t patch;
        bool backward;  // direction around its patch
    };
    std::map<SideKey, std::vector<SideUse>> uses;
    std::vector<std::array<SideKey, 4>> keys(nets.size());
    for (std::size_t k = 0; k < nets.size(); ++k) {
        for (int side = 0; side < 4; ++side) {
            bool reversed = false;
            SideKey key = side_key(nets[k], side, &reversed);
            uses[key].push_back({k, reversed != (side >= 2)});
            keys[k][static_cast<std::size_t>(side)] = std::move(key);
        }
    }
    turned.assign(nets.size(), false);
    std::vector<bool> known(nets.size());
    for (std::size_t first = 0; first < nets.size(); ++first) {
        std::vector<std::size_t> waiting;
        if (!known[first]) waiting.push_back(first);
        known[first] = true;
        while (!waiting.empty()) {
            const std::size_t k = waiting.back();
            waiting.pop_back();
            for (const SideKey& key : keys[k]) {
                const std::vector<SideUse>& both = uses[key];
                if (both.size() != 2 || both[0].patch == both[1].patch) continue;
                const std::size_t other = both[both[0].patch == k ? 1 : 0].patch;
                if (known[other]) continue;
                known[other] = true;
                turned[other] = turned[k] != (both[0].backward == both[1].backward);
                waiting.push_back(other);
            }
        }
    }
}

void PatchModel::mark_open_corners() {
    // Sides in the order of boundary_curve: which corners each one ends at.
    constexpr std::size_t kEnds[4][2] = {{0, 2}, {2, 3}, {1, 3}, {0, 1}};
    const auto corner = [&](std::size_t patch, std::size_t k) {
        const BezierNet& net = nets[patch];
        const Vec3 p =
            projected(net.at(k / 2 != 0 ? net.degree_u : 0, k % 2 != 0 ? net.degree_v : 0));
        return std::array{p.x, p.y, p.z};
    };
    std::set<std::array<double, 3>> ends;
    for (std::size_t k = 0; k < open.size(); ++k) {
        if (!open[k]) continue;
        for (const std::size_t end : kEnds[k % 4]) ends.insert(corner(k / 4, end));
    }
    for (std::size_t k = 0; k < 4 * nets.size(); ++k) {
        open_corner.push_back(ends.count(corner(k / 4, k % 4)) != 0);
    }
}

double PatchModel::rounding(const Ray& ray) const {
    const Vec3 to_center = box.center() - ray.origin;
    double from = length(ray.origin);
    if (length(to_center) > 2.0 * length(box.size())) {
        const Vec3 d = normalize(ray.direction);
        from = length(ray.origin + dot(to_center, d) * d);
    }
    return 0x1p-46 * (reach + most_weight * from);
}

const char* patch_ray_name(PatchRayKind kind) {
    constexpr const char* kNames[kPatchRayKinds] = {"random", "tangent", "border", "corner"};
    return kNames[static_cast<int>(kind)];
}

Ray patch_ray(const PatchModel& model, PatchRayKind kind, RandomStream& random) {
    const double size = length(model.box.size());
    const BezierNet& net = model.nets[random.below(model.nets.size())];
    double uv[2] = {random.uniform(), random.uniform()};
    const auto end = [&] { return static_cast<double>(random.below(2)); };
    if (kind == PatchRayKind::Border) uv[random.below(2)] = end();
    if (kind == PatchRayKind::Corner) uv[0] = end(), uv[1] = end();
    const PatchPoint p = derivatives_at(net, uv[0], uv[1]);
    Vec3 origin = p.point, direction = unit_direction(random);
    if (kind == PatchRayKind::Random) {
        // Chords of the box's sphere.
        const Vec3 to = model.box.center() + 0.5 * size * unit_direction(random);
        origin = model.box.center() + 0.5 * size * direction;
        direction = length(to - origin) > 0.0 ? normalize(to - origin) : direction;
    }
    if (kind == PatchRayKind::Tangent) {
        const double angle = random.uniform(0, 2 * kPi);
        const Vec3 tangent = std::cos(angle) * p.du + std::sin(angle) * p.dv;
        if (length(tangent) > 0.0) direction = normalize(tangent);
        const double side = random.below(2) == 0 ? 1.0 : -1.0;
        const double beside = std::pow(10.0, random.uniform(-12, -1));
        origin += (side * size * beside) * patch_normal(net, uv[0], uv[1]);
    }
    origin -= (size * random.uniform(-1, 2)) * direction;
    return {origin, random.uniform(0.5, 2.0) * direction, -kInfinity, kInfinity};
}

PatchJudgement judge_crossings(const PatchModel& model, const Ray& ray,
                               const ExactPatchRoots& exact, std::span<const PatchCrossing> found,
                               double farthest) {
    PatchJudgement out;
    out.exact = static_cast<int>(exact.roots.size());
    out.found = static_cast<int>(found.size());
    out.undecided = exact.undecided > 0;
    const double rounding = model.rounding(ray), near = kNear * rounding;
    std::vector<LinePlace> all, ours;
    for (const ExactPatchRoot& root : exact.roots) {
        out.undecided = out.undecided || root.on_side;
        all.push_back(place_on(model, ray, root.patch, static_cast<double>(root.t),
                               static_cast<double>(root.u), static_cast<double>(root.v), near));
    }
    if (out.undecided) return out;
    for (const PatchCrossing& one : found) {
        ours.push_back(place_on(model, ray, one.patch, one.t, one.u, one.v, near));
    }
    std::sort(ours.begin(), ours.end(),
              [](const LinePlace& a, const LinePlace& b) { return a.at < b.at; });
    const std::vector<int> partner = matched(all, ours, farthest);
    std::vector<bool> used(ours.size());
    std::vector<LinePlace> missing, more;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (partner[k] < 0) {
            missing.push_back(all[k]);
            continue;
        }
        const auto p = static_cast<std::size_t>(partner[k]);
        used[p] = true;
        const double error = std::abs(all[k].at - ours[p].at);
        out.worst_t = std::max(out.worst_t, error);
        // At a crease another patch, which may be the steeper one, may report the crossing.
        const bool at_side = all[k].at_side, elsewhere = all[k].patch != ours[p].patch;
        const double slope =
            at_side && elsewhere ? std::max(all[k].slope, ours[p].slope) : all[k].slope;
        if (slope < 1e4) {
            const double bound = (at_side ? near : rounding) * (1.0 + slope);
            out.worst_of_bound = std::max(out.worst_of_bound, error / bound);
        }
    }
    for (std::size_t k = 0; k < ours.size(); ++k) {
        if (!used[k]) more.push_back(ours[k]);
    }
    out.missed = judged(missing, rounding, out);
    out.invented = judged(more, rounding, out);
    return out;
}

void PatchTally::add(const PatchJudgement& one) {
    ++rays;
    if (one.undecided) {
        ++undecided;
        return;
    }
    exact += one.exact;
    missed += one.missed;
    invented += one.invented;
    pairs += one.pairs;
    at_sides += one.at_sides;
    worst_t = std::max(worst_t, one.worst_t);
    worst_of_bound = std::max(worst_of_bound, one.worst_of_bound);
}

}  // namespace alhazen
