#include "alhazen/illumination/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "alhazen/illumination/light_importance.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr int kBins = 12;
/// Only nodes with a number of lights in this range are split along the best of all axes, others
/// along their longest axis.
constexpr std::size_t kTriesAllAxesFrom = 12, kTriesAllAxesTo = 2048;

/// Bounds of a set of lights.
struct Cluster {
    Box3 box;
    Vec3 axis{0, 0, 1};
    double cosine_spread = 1, cosine_reach = 1;
    double intensity = 0;
    bool two_sided = false;
    std::size_t count = 0;
};

/// Extends the cone of `a` to the smallest cone around both: section 4.1, algorithm 1.
void unite_cones(Cluster& a, Cluster b) {
    if (a.two_sided && b.two_sided && dot(a.axis, b.axis) < 0.0) b.axis = -b.axis;
    if (b.cosine_spread < a.cosine_spread) {
        std::swap(a.axis, b.axis);
        std::swap(a.cosine_spread, b.cosine_spread);
    }
    if (a.cosine_spread <= -1.0) return;
    const double between = std::atan2(length(cross(a.axis, b.axis)), dot(a.axis, b.axis));
    const double wide = std::acos(a.cosine_spread),
                 narrow = std::acos(std::min(1.0, b.cosine_spread));
    if (between + narrow <= wide) return;
    const double spread = 0.5 * (wide + between + narrow);
    const Vec3 across = b.axis - dot(a.axis, b.axis) * a.axis;
    if (spread >= kPi || !(length_squared(across) > 1e-20)) {
        a.cosine_spread = spread >= kPi || between > 1.0 ? -1.0 : std::cos(spread);
        return;
    }
    const double turn = spread - wide;
    a.axis = normalize(std::cos(turn) * a.axis + std::sin(turn) * normalize(across));
    a.cosine_spread = std::cos(spread);
}

void unite(Cluster& a, const Cluster& b) {
    if (b.count == 0) return;
    if (a.count == 0) {
        a = b;
        return;
    }
    unite_cones(a, b);
    a.box.include(b.box);
    a.cosine_reach = std::min(a.cosine_reach, b.cosine_reach);
    a.intensity += b.intensity;
    a.two_sided = a.two_sided || b.two_sided;
    a.count += b.count;
}

/// The cost of section 4.4: the measure of directions (M_Omega) times area and intensity.
double cost_of(const Cluster& c) {
    if (c.count == 0) return 0.0;
    const double spread = std::acos(std::clamp(c.cosine_spread, -1.0, 1.0));
    const double reach = std::acos(std::clamp(c.cosine_reach, -1.0, 1.0));
    const double to = std::min(spread + reach, kPi), sine = std::sin(spread);
    double directions =
        2.0 * kPi * (1.0 - c.cosine_spread) + kPi / 2.0 *
                                                  (2.0 * to * sine - std::cos(spread - 2.0 * to) -
                                                   2.0 * spread * sine + std::cos(spread));
    if (c.two_sided) directions *= 2.0;
    // Lights at a point or on a line count as a thin box.
    const Vec3 size = c.box.size();
    const double thin = 1e-3 * max_component(size);
    const double area = c.box.half_area() + thin * thin;
    return c.intensity * directions * area;
}

}  // namespace

class LightTreeBuilder {
  public:
    explicit LightTreeBuilder(const std::vector<TreeLight>& lights) : lights_(lights) {
        for (std::size_t i = 0; i < lights.size(); ++i) {
            if (lights[i].intensity > 0.0 && std::isfinite(lights[i].intensity)) {
                order_.push_back(static_cast<std::uint32_t>(i));
                surfaces_only_ = surfaces_only_ && lights[i].cosine_reach == 0.0;
            }
        }
    }

    void build(LightTree& tree) {
        tree.leaves_.assign(lights_.size(), LightTree::kNone);
        tree.empty_ = order_.empty();
        tree.surfaces_only_ = surfaces_only_;
        if (order_.empty()) return;
        const std::size_t pairs = order_.size() - 1;
        tree.pairs_.resize(pairs);
        std::uint32_t made = 0;
        // Not recursive: a tree of equal lights may be deep.
        std::vector<Task> waiting{{LightTree::kNone, 0, order_.size()}};
        while (!waiting.empty()) {
            const Task task = waiting.back();
            waiting.pop_back();
            const bool is_root = task.node == LightTree::kNone;
            LightTree::Link& link =
                is_root ? tree.root_ : tree.pairs_[task.node / 2].links[task.node % 2];
            if (!is_root) {
                tree.pairs_[task.node / 2].set(task.node % 2, node_of(bound(task)));
            }
            if (task.end - task.begin == 1) {
                const std::uint32_t light = order_[task.begin];
                link = LightTree::Link::to_light(light);
                tree.leaves_[light] = task.node;
                continue;
            }
            const std::size_t middle = divide(task);
            link = LightTree::Link::to_siblings(made);
            tree.pairs_[made].parent = task.node;
            waiting.push_back({2 * made + 1, middle, task.end});
            waiting.push_back({2 * made, task.begin, middle});
            ++made;
        }
    }

  private:
    struct Task {
        std::uint32_t node;  ///< kNone: the root
        std::size_t begin, end;
    };
    struct Bin {
        Cluster cluster;
        Vec3 axes;
    };

    [[nodiscard]] const TreeLight& light(std::size_t i) const { return lights_[order_[i]]; }

    /// Adds box, intensity and axis of a light; not its cone.
    static void add_to(Bin& bin, const TreeLight& l) {
        Cluster& c = bin.cluster;
        c.box.include(l.bounds.box);
        c.intensity += l.intensity;
        c.cosine_reach = std::min(c.cosine_reach, l.cosine_reach);
        c.two_sided = c.two_sided || l.two_sided;
        const bool turned = l.two_sided && dot(bin.axes, l.bounds.axis) < 0.0;
        bin.axes += turned ? -l.bounds.axis : l.bounds.axis;
        ++c.count;
    }
    /// Begins the cone around the mean axis, after all lights are added.
    static void begin_cone(Bin& bin) {
        bin.cluster.axis = unit_or(bin.axes, {0, 0, 1});
        bin.cluster.cosine_spread = 1.0;
    }
    static void widen_cone(Bin& bin, const TreeLight& l) {
        Cluster& c = bin.cluster;
        double cosine = std::min(1.0, dot(c.axis, l.bounds.axis));
        // A two-sided light counts by the normal nearer to the axis; its node is two-sided.
        if (l.two_sided) cosine = std::abs(cosine);
        const double own = l.bounds.cosine_spread;
        if (own <= -1.0) {
            cosine = -1.0;
        } else if (own < 1.0) {
            const double angle = std::acos(std::max(-1.0, cosine)) + std::acos(own);
            cosine = angle >= kPi ? -1.0 : std::cos(angle);
        }
        c.cosine_spread = std::min(c.cosine_spread, cosine);
    }

    [[nodiscard]] Cluster bound(const Task& task) const {
        Bin all;
        for (std::size_t i = task.begin; i < task.end; ++i) add_to(all, light(i));
        begin_cone(all);
        for (std::size_t i = task.begin; i < task.end; ++i) widen_cone(all, light(i));
        return all.cluster;
    }

    static LightTree::Node node_of(const Cluster& c) {
        LightTree::Node node;
        constexpr float kInf = std::numeric_limits<float>::infinity();
        for (int k = 0; k < 3; ++k) {
            node.lo[k] = std::nextafter(static_cast<float>(c.box.lo[k]), -kInf);
            node.hi[k] = std::nextafter(static_cast<float>(c.box.hi[k]), kInf);
            node.axis[k] = static_cast<float>(c.axis[k]);
        }
        // Widened by more than the rounding of the axis.
        const double spread = std::acos(std::clamp(c.cosine_spread, -1.0, 1.0)) + 1e-3;
        node.cosine_spread = spread >= kPi ? -1.0f : static_cast<float>(std::cos(spread));
        node.cosine_reach = static_cast<float>(c.cosine_reach);
        node.intensity = static_cast<float>(std::clamp(c.intensity, 1e-37, 1e37));
        node.two_sided = c.two_sided;
        return node;
    }

    /// Orders the lights of the task by the sides of a split; returns the end of the first side.
    std::size_t divide(const Task& task) {
        const std::size_t count = task.end - task.begin;
        const std::size_t half = task.begin + count / 2;
        if (count == 2) return half;
        Box3 centers;
        for (std::size_t i = task.begin; i < task.end; ++i) {
            centers.include(light(i).bounds.box.center());
        }
        const Vec3 size = centers.size();
        const int longest = dominant_axis(size);
        const bool tries_all = count >= kTriesAllAxesFrom && count <= kTriesAllAxesTo;
        double best_cost = kInfinity, best_plane = 0.0;
        int best_axis = -1;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(size[axis] > 0.0) || (!tries_all && axis != longest)) continue;
            const auto [cost, plane] = best_split(task, axis, centers, size[longest]);
            if (cost < best_cost) {
                best_cost = cost;
                best_plane = plane;
                best_axis = axis;
            }
        }
        if (best_axis < 0) return half;
        const auto first = order_.begin() + std::ptrdiff_t(task.begin);
        const auto middle = std::stable_partition(
            first, order_.begin() + std::ptrdiff_t(task.end), [&](std::uint32_t i) {
                return lights_[i].bounds.box.center()[best_axis] < best_plane;
            });
        const std::size_t split = std::size_t(middle - order_.begin());
        return split == task.begin || split == task.end ? half : split;
    }

    /// The split of lowest cost among the planes between bins, and its cost.
    [[nodiscard]] std::pair<double, double> best_split(const Task& task, int axis,
                                                       const Box3& centers, double longest) const {
        const int used = static_cast<int>(std::min<std::size_t>(kBins, task.end - task.begin));
        const double from = centers.lo[axis], size = centers.hi[axis] - from;
        std::array<Bin, kBins> bins;
        const auto bin_of = [&](const TreeLight& l) -> Bin& {
            const double share = (l.bounds.box.center()[axis] - from) / size;
            return bins[std::size_t(std::clamp(static_cast<int>(share * used), 0, used - 1))];
        };
        for (std::size_t i = task.begin; i < task.end; ++i) add_to(bin_of(light(i)), light(i));
        for (Bin& bin : bins) begin_cone(bin);
        for (std::size_t i = task.begin; i < task.end; ++i) widen_cone(bin_of(light(i)), light(i));
        std::array<double, kBins> above{};
        Cluster sum;
        for (int i = used - 1; i > 0; --i) {
            unite(sum, bins[std::size_t(i)].cluster);
            above[std::size_t(i)] = sum.count > 0 ? cost_of(sum) : kInfinity;
        }
        sum = {};
        double best = kInfinity, plane = 0.0;
        for (int i = 1; i < used; ++i) {
            unite(sum, bins[std::size_t(i - 1)].cluster);
            if (sum.count == 0) continue;
            const double cost = (cost_of(sum) + above[std::size_t(i)]) * (longest / size);
            if (cost < best) {
                best = cost;
                plane = from + size * i / used;
            }
        }
        return {best, plane};
    }

    const std::vector<TreeLight>& lights_;
    std::vector<std::uint32_t> order_;
    bool surfaces_only_ = true;
};

void LightTree::Siblings::set(std::size_t sibling, const Node& node) {
    const Vec3 lo{node.lo[0], node.lo[1], node.lo[2]}, hi{node.hi[0], node.hi[1], node.hi[2]};
    const Vec3 middle = 0.5 * (lo + hi);
    for (int k = 0; k < 3; ++k) {
        center[k][sibling] = middle[k];
        axis[k][sibling] = node.axis[k];
    }
    radius2[sibling] = 0.25 * length_squared(hi - lo);
    cosine_spread[sibling] = node.cosine_spread;
    cosine_reach[sibling] = node.cosine_reach;
    intensity[sibling] = node.two_sided ? -node.intensity : node.intensity;
}

LightTree::LightTree(const std::vector<TreeLight>& lights) {
    LightTreeBuilder(lights).build(*this);
}

ChosenLight LightTree::choose(const LitPoint& at, double choice) const {
    if (empty_) return {};
    double probability = 1.0;
    Link link = root_;
    while (!link.is_leaf()) {
        const Siblings& pair = pairs_[link.target()];
        const auto [first, second] = importances(pair, at);
        const double sum = first + second;
        if (!(sum > 0.0)) return {};
        const double share = first / sum;
        if (choice < share) {
            choice = std::min(choice / share, 0x1.fffffffffffffp-1);
            probability *= share;
            link = pair.links[0];
        } else {
            choice = std::min((choice - share) / (1.0 - share), 0x1.fffffffffffffp-1);
            probability *= second / sum;
            link = pair.links[1];
        }
    }
    return {link.target(), probability};
}

double LightTree::probability(const LitPoint& at, std::size_t light) const {
    if (empty_ || (leaves_[light] == kNone && !pairs_.empty())) return 0.0;
    if (pairs_.empty()) return root_.target() == light ? 1.0 : 0.0;
    double probability = 1.0;
    for (std::uint32_t node = leaves_[light]; node != kNone; node = pairs_[node / 2].parent) {
        const auto [one, two] = importances(pairs_[node / 2], at);
        if (!(one + two > 0.0)) return 0.0;
        probability *= (node % 2 == 0 ? one : two) / (one + two);
    }
    return probability;
}

}  // namespace alhazen
