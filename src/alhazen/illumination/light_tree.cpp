#include "alhazen/illumination/light_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "alhazen/illumination/light_importance.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr int kBins = 12;
/// Only nodes with a number of lights in this range are split along the best of all axes, others
/// along their longest axis.
constexpr std::size_t kTriesAllAxesFrom = 12, kTriesAllAxesTo = 2048;

/// The variance of an importance per variance of the places of its lights; found by experiments
/// (docs/log/light_transport.md).
constexpr double kVarianceFactor = 1.4;
/// The least share of a node in the intensity of all lights: products stay normal numbers.
constexpr double kLeastIntensity = 1e-12;

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

/// What the importance of a set of lights depends on, in world space.
struct Moments {
    Vec3 center;          ///< mean by intensity
    double variance = 0;  ///< of places, along one axis
    Vec3 axis;            ///< mean by intensity
    double intensity = 0;
    bool two_sided = false;
    Box3 box;
    Cluster cone;  ///< if the tree has cones
};

bool emits_to_all_directions(const TreeLight& l) {
    return l.bounds.cosine_spread <= -1.0 || l.cosine_reach <= -1.0;
}
bool is_surface(const TreeLight& l) {
    return l.cosine_reach == 0.0;
}

Moments moments_of(const TreeLight& l) {
    Moments m;
    m.center = l.bounds.center;
    m.box = l.bounds.box;
    // Emitters fill about their box.
    m.variance = length_squared(m.box.size()) / 36.0;
    m.two_sided = l.two_sided;
    m.intensity = l.intensity;
    if (is_surface(l) && !emits_to_all_directions(l)) {
        m.axis = 0.5 * (1.0 + l.bounds.cosine_spread) * l.bounds.axis;
    } else {
        // The largest intensity in all directions, and not in one.
        m.intensity *= l.two_sided ? 2.0 : 4.0;
    }
    return m;
}

Moments united(const Moments& a, const Moments& b) {
    Moments m;
    m.intensity = a.intensity + b.intensity;
    const double of_a = a.intensity / m.intensity, of_b = b.intensity / m.intensity;
    m.center = of_a * a.center + of_b * b.center;
    m.variance = of_a * a.variance + of_b * b.variance +
                 of_a * of_b * length_squared(a.center - b.center) / 3.0;
    m.two_sided = a.two_sided || b.two_sided;
    const bool turned = m.two_sided && dot(a.axis, b.axis) < 0.0;
    m.axis = of_a * a.axis + (turned ? -of_b : of_b) * b.axis;
    m.box = a.box;
    m.box.include(b.box);
    m.cone = a.cone;
    unite(m.cone, b.cone);
    return m;
}

/// The largest squared distance of the point to points of the box.
double squared_reach(const Box3& box, const Vec3& from) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double reach = std::max(from[k] - box.lo[k], box.hi[k] - from[k]);
        sum += reach * reach;
    }
    return sum;
}

std::uint32_t low_half(double axis) {
    const auto number =
        static_cast<std::int16_t>(std::lround(std::clamp(axis, -1.0, 1.0) * LightTree::kAxisUnits));
    return static_cast<std::uint16_t>(number);
}

/// The float next to `x` that has zeros below its first bits.
std::uint32_t first_bits(double x, int count) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(x));
    const std::uint32_t unit = 1u << (32 - count);
    return (bits + unit / 2) & ~(unit - 1);
}

/// The upper half of a float that is not below `x`.
std::uint32_t high_half_above(double x) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(x));
    return (bits + 0x1FFFFu) & 0xFFFF0000u;
}

class LightTreeBuilder {
  public:
    explicit LightTreeBuilder(const std::vector<TreeLight>& lights) : lights_(lights) {
        for (std::size_t i = 0; i < lights.size(); ++i) {
            if (lights[i].intensity > 0.0 && std::isfinite(lights[i].intensity)) {
                order_.push_back(static_cast<std::uint32_t>(i));
                has_cones_ =
                    has_cones_ || !(is_surface(lights[i]) || emits_to_all_directions(lights[i]));
            }
        }
    }

    void build(LightTree& tree) {
        tree.leaves_.assign(lights_.size(), LightTree::kNone);
        tree.empty_ = order_.empty();
        if (order_.empty()) return;
        // Not recursive: a tree of equal lights may be deep.
        std::vector<Task> waiting{{LightTree::kNone, 0, order_.size()}};
        while (!waiting.empty()) {
            const Task task = waiting.back();
            waiting.pop_back();
            const bool is_root = task.child == LightTree::kNone;
            LightTree::Link& link = is_root ? tree.root_
                                            : tree.nodes_[task.child / LightTree::kWidth]
                                                  .links[task.child % LightTree::kWidth];
            if (task.end - task.begin == 1) {
                const std::uint32_t light = order_[task.begin];
                link = LightTree::Link::to_light(light);
                tree.leaves_[light] = task.child;
                continue;
            }
            const auto made = static_cast<std::uint32_t>(tree.nodes_.size());
            link = LightTree::Link::to_node(made);
            tree.nodes_.emplace_back();
            tree.parents_.push_back(task.child);
            // The halves of both halves.
            const std::size_t middle = divide(task.begin, task.end);
            std::array<std::size_t, LightTree::kWidth + 1> ends{task.begin};
            std::uint32_t children = 0;
            for (const auto& [begin, end] :
                 {std::pair{task.begin, middle}, std::pair{middle, task.end}}) {
                if (end - begin > 1) ends[++children] = divide(begin, end);
                ends[++children] = end;
            }
            std::fill(std::begin(tree.nodes_[made].links) + children,
                      std::end(tree.nodes_[made].links), LightTree::Link::to_light(0));
            for (std::uint32_t i = children; i-- > 0;) {
                waiting.push_back({LightTree::kWidth * made + i, ends[i], ends[i + 1]});
            }
            counts_.push_back(children);
        }
        set_frame(tree);
        set_numbers(tree);
    }

  private:
    struct Task {
        std::uint32_t child;  ///< as LightTree::parents_; kNone: the root
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

    void set_frame(LightTree& tree) {
        Box3 box;
        for (const std::uint32_t i : order_) {
            box.include(lights_[i].bounds.box);
            intensity_ += moments_of(lights_[i]).intensity;
        }
        tree.origin_ = box.center();
        const double radius = 0.5 * length(box.size());
        tree.scale_ = radius > 0.0 && std::isfinite(1.0 / radius) ? 1.0 / radius : 1.0;
    }

    /// Sets the numbers of all nodes, from the leaves to the root.
    void set_numbers(LightTree& tree) const {
        if (has_cones_) tree.cones_.resize(tree.nodes_.size());
        // A node precedes what is below it, its first child before the rest.
        std::vector<Moments> made;
        for (std::size_t k = tree.nodes_.size(); k-- > 0;) {
            Moments all;
            for (std::size_t i = 0; i < LightTree::kWidth; ++i) {
                if (i >= counts_[k]) {
                    set_none(tree.nodes_[k], i);
                    continue;
                }
                const LightTree::Link link = tree.nodes_[k].links[i];
                Moments child;
                if (link.is_leaf()) {
                    child = moments_of(lights_[link.target()]);
                    if (has_cones_) child.cone = cone_of(lights_[link.target()]);
                } else {
                    child = made.back();
                    made.pop_back();
                }
                set(tree, k, i, child);
                all = i == 0 ? child : united(all, child);
            }
            made.push_back(all);
        }
    }

    static void set_none(LightTree::Node& node, std::size_t i) {
        for (auto& place : node.center) place[i] = 0.0f;
        node.variance[i] = 1.0f;
        node.intensity_turn[i] = node.axis_xy[i] = node.axis_z_radius2[i] = 0;
    }

    static Cluster cone_of(const TreeLight& l) {
        Cluster c;
        c.axis = l.bounds.axis;
        c.cosine_spread = l.bounds.cosine_spread;
        c.cosine_reach = l.cosine_reach;
        c.two_sided = l.two_sided;
        c.count = 1;
        return c;
    }

    void set(LightTree& tree, std::size_t node, std::size_t i, const Moments& m) const {
        LightTree::Node& to = tree.nodes_[node];
        const Vec3 center = tree.scale_ * (m.center - tree.origin_);
        for (int k = 0; k < 3; ++k) to.center[k][i] = static_cast<float>(center[k]);
        // Larger by more than the rounding of places.
        const double radius = tree.scale_ * std::sqrt(squared_reach(m.box, m.center)) + 1e-6;
        const double variance = kVarianceFactor * m.variance * (tree.scale_ * tree.scale_);
        to.variance[i] =
            static_cast<float>(std::max(variance, std::max(2e-6 * radius * radius, 1e-12)));
        const double share = std::clamp(m.intensity / intensity_, kLeastIntensity, 1.0);
        const double turn = std::max(kTurned * (1.0 - length_squared(m.axis)), double{kLeastTurn});
        constexpr int kTurnBits = LightTree::kTurnBits;
        to.intensity_turn[i] = first_bits(m.two_sided ? -share : share, 32 - kTurnBits) |
                               first_bits(turn, kTurnBits) >> (32 - kTurnBits);
        to.axis_xy[i] = low_half(m.axis.x) | low_half(m.axis.y) << 16;
        // More than (radius + error)^2, if the square of the error is a hundredth of kGrazing.
        to.axis_z_radius2[i] = low_half(m.axis.z) | high_half_above(1.01 * radius * radius);
        if (!has_cones_) return;
        LightTree::Cones& cones = tree.cones_[node];
        for (int k = 0; k < 3; ++k) cones.axis[k][i] = static_cast<float>(m.cone.axis[k]);
        // Widened by more than the rounding of the axis.
        const double angle = std::acos(std::clamp(m.cone.cosine_spread, -1.0, 1.0)) +
                             std::acos(std::clamp(m.cone.cosine_reach, -1.0, 1.0)) + 1e-3;
        const bool open = m.cone.two_sided || angle >= kPi;
        cones.cosine[i] = open ? -2.0f : static_cast<float>(std::cos(angle));
        cones.radius[i] = static_cast<float>(1.001 * radius);
    }

    /// Orders the lights of a range by the sides of a split; returns the end of the first side.
    std::size_t divide(std::size_t begin, std::size_t end) {
        const Task task{LightTree::kNone, begin, end};
        const std::size_t count = end - begin;
        const std::size_t half = begin + count / 2;
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
    std::vector<std::uint32_t> counts_;  ///< [node] children
    double intensity_ = 0;               ///< of all lights
    bool has_cones_ = false;
};

namespace {

/// The importances before each child, and of all.
struct ImportanceSums {
    LightTree::OfChildren<double> before;
    double all;
};
ImportanceSums sums_of(const std::array<float, LightTree::kWidth>& of) {
    const double two = double{of[0]} + double{of[1]}, three = two + double{of[2]};
    return {{0.0, of[0], two, three}, three + double{of[3]}};
}

}  // namespace

LightTree::LightTree(const std::vector<TreeLight>& lights) {
    LightTreeBuilder(lights).build(*this);
}

ChosenLight LightTree::choose(const LitPoint& at, double choice) const {
    if (empty_) return {};
    const PointOfTree seen(*this, at);
    // `rest`: of the choice, less than `probability`.
    double rest = choice, probability = 1.0;
    Link link = root_;
    while (!link.is_leaf()) {
        const Node& node = nodes_[link.target()];
        const auto own = importances(node, cones_of(link.target()), seen);
        const ImportanceSums sums = sums_of(own);
        if (!(sums.all > 0.0)) return {};
        const double at_rest = rest * sums.all;
        std::size_t i = 0;
        while (i < kWidth - 1 && at_rest >= probability * sums.before[i + 1]) ++i;
        const double part = 1.0 / sums.all;
        rest = std::max(rest - probability * (sums.before[i] * part), 0.0);
        probability = probability * (double{own[i]} * part);
        link = node.links[i];
    }
    return {link.target(), probability};
}

double LightTree::probability(const LitPoint& at, std::size_t light) const {
    if (empty_ || (leaves_[light] == kNone && !nodes_.empty())) return 0.0;
    if (nodes_.empty()) return root_.target() == light ? 1.0 : 0.0;
    const PointOfTree seen(*this, at);
    double probability = 1.0;
    for (std::uint32_t child = leaves_[light]; child != kNone;) {
        const std::uint32_t node = child / kWidth;
        const auto own = importances(nodes_[node], cones_of(node), seen);
        const double sum = sums_of(own).all;
        if (!(sum > 0.0)) return 0.0;
        probability *= double{own[child % kWidth]} / sum;
        child = parents_[node];
    }
    return probability;
}

}  // namespace alhazen
