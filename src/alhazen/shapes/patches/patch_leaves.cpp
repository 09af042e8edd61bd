#include "alhazen/shapes/patches/patch_leaves.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/patches/certified_cells.h"

namespace alhazen {

namespace {

constexpr std::size_t kFewestLeaves = 20;  ///< least limit of the leaves of a patch
/// Memory limit of a bicubic patch with its points, leaves and boxes.
constexpr std::size_t kMostBytes = 4096;
constexpr std::size_t kBytesOfLeaf = sizeof(PatchLeaf) + 13;  ///< includes its share of the boxes
constexpr int kMostLeafLevel = 8;
/// Fraction of a patch's area, averaged over directions, that may remain uncertified.
constexpr double kUncertified = 0.05;

/// A part of a patch, with the criteria for dividing it.
struct Part {
    BezierNet net;
    PatchLeaf leaf;
    double area = 0, uncertified = 0;
    bool split_u = false;
};

/// Bounds of a part's second derivatives, in half-widths, by Bernstein coefficients of the
/// numerator from the middle, N = w (S - middle), and the quotient rule.
class PartBends {
  public:
    PartBends(const BezierNet& net, const Vec3& middle)
        : value_(Coefficients::of(net, middle)),
          by_u_(value_.by_u()),
          by_v_(value_.by_v()),
          by_uu_(by_u_.by_u()),
          by_uv_(by_u_.by_v()),
          by_vv_(by_v_.by_v()) {}

    /// Bounds of the second derivatives along an axis.
    struct Bends {
        double aa = 0, ab = 0, bb = 0;

        [[nodiscard]] double sum() const { return aa + 2.0 * ab + bb; }
        [[nodiscard]] double halved_u() const { return 0.25 * aa + ab + bb; }
        [[nodiscard]] double halved_v() const { return aa + ab + 0.25 * bb; }
    };
    [[nodiscard]] Bends along(const Vec3& axis) const {
        const double mu = by_u_.most_weight(), mv = by_v_.most_weight();
        const double s = value_.most(axis);
        const double s_u = by_u_.most(axis) + mu * s, s_v = by_v_.most(axis) + mv * s;
        const double s_uu = by_uu_.most(axis) + 2.0 * mu * s_u + by_uu_.most_weight() * s;
        const double s_vv = by_vv_.most(axis) + 2.0 * mv * s_v + by_vv_.most_weight() * s;
        const double s_uv = by_uv_.most(axis) + mu * s_v + mv * s_u + by_uv_.most_weight() * s;
        return {s_uu, s_uv, s_vv};
    }

  private:
    /// Uninitialised, since most patches use 16 of the 64.
    struct Coefficient {
        double x, y, z, weight;

        [[nodiscard]] Vec3 point() const { return {x, y, z}; }
    };
    /// Bernstein coefficients of a derivative of N and of the weight, up to a factor.
    struct Coefficients {
        int order_u = 0, order_v = 0, count = 0;
        double factor = 1, largest_weight = 0;
        Coefficient at[kMaxPatchOrder * kMaxPatchOrder];

        /// The coefficients of N itself.
        static Coefficients of(const BezierNet& net, const Vec3& middle) {
            Coefficients value;
            double least = kInfinity;
            for (int k = 0; k < net.count(); ++k) {
                const HomogeneousPoint& p = net.points[static_cast<std::size_t>(k)];
                least = std::min(least, p.w);
                value.add(Vec3{p.x, p.y, p.z} - p.w * middle, p.w);
            }
            // Allows for the margin of the cell (kCellMargin).
            const double growth = 1.0 + 2.5 * kCellMargin * (net.degree_u + net.degree_v);
            value.factor = growth / least;
            value.order_u = net.degree_u + 1;
            value.order_v = net.degree_v + 1;
            return value;
        }
        void add(const Vec3& point, double weight) {
            at[count++] = {point.x, point.y, point.z, weight};
            largest_weight = std::max(largest_weight, std::abs(weight));
        }
        [[nodiscard]] double most(const Vec3& axis) const {
            double most = 0.0;
            for (int k = 0; k < count; ++k) {
                most = std::max(most, std::abs(dot(axis, at[k].point())));
            }
            return factor * most;
        }
        [[nodiscard]] double most_weight() const { return factor * largest_weight; }

        [[nodiscard]] Coefficients by_u() const { return difference(1, 0); }
        [[nodiscard]] Coefficients by_v() const { return difference(0, 1); }

      private:
        [[nodiscard]] Coefficients difference(int in_u, int in_v) const {
            Coefficients out;
            out.order_u = order_u - in_u;
            out.order_v = order_v - in_v;
            out.factor = 0.5 * factor * (in_u != 0 ? out.order_u : out.order_v);
            for (int i = 0; i < out.order_u; ++i) {
                for (int j = 0; j < out.order_v; ++j) {
                    const Coefficient& a = at[i * order_v + j];
                    const Coefficient& b = at[(i + in_u) * order_v + j + in_v];
                    out.add(b.point() - a.point(), b.weight - a.weight);
                }
            }
            return out;
        }
    };

    Coefficients value_, by_u_, by_v_, by_uu_, by_uv_, by_vv_;
};

/// The fraction of the lines meeting a leaf for which it is not certified.
double uncertified_part(const PatchLeaf& leaf, double size_u, double size_v, double flat) {
    const double along = std::max(leaf.most_bend(0), leaf.most_bend(1));
    const double across = leaf.most_bend(2) * std::max(size_u, size_v) * flat;
    if (!(along < kUnique)) return 1.0;
    // bend along + bend across * tan(angle) / (sine * size of a derivative) <= kUnique
    const double slope = (kUnique - along) * flat / std::max(across, 1e-30);
    return 1.0 / (1.0 + slope * slope);
}

/// Rounds to whole steps of 2^exponent; returns the exponent.
std::int8_t set_rounded(const Vec3& axis, std::int16_t (&to)[3]) {
    constexpr int kLeastExponent = -120;
    const double most = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
    const int exponent =
        most > 0.0 ? std::max(std::ilogb(most / PatchLeaf::kMost) + 1, kLeastExponent) : 0;
    for (int k = 0; k < 3; ++k) {
        to[k] = static_cast<std::int16_t>(std::lrint(std::ldexp(axis[k], -exponent)));
    }
    return static_cast<std::int8_t>(exponent);
}

/// The upper half of a float that is at least `x`.
std::uint16_t upper_half(double x) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(x));
    return static_cast<std::uint16_t>((bits >> 16) + 1);
}

/// True for a part so small that the rounding of its middle exceeds every bound that certifies it
/// or a part of it: its derivatives are at most the differences of its points times the degree.
bool is_below_rounding(const BezierNet& net, const PatchFrame& frame, double rounding) {
    const double size = frame.scale * length(control_box(net).size());
    return rounding > 0.5 * kUnique * std::max(net.degree_u, net.degree_v) * size;
}

void measure(Part& part, const PatchFrame& frame) {
    const PatchValue middle = patch_value(part.net, 0.5, 0.5);
    const Vec3 center = frame.scale * (middle.point - frame.center);
    const Vec3 du = (0.5 * frame.scale) * middle.du, dv = (0.5 * frame.scale) * middle.dv;
    PatchLeaf& leaf = part.leaf;
    for (int k = 0; k < 3; ++k) {
        leaf.center[k] = static_cast<float>(center[k]);
    }
    leaf.exponent_u = set_rounded(du, leaf.du);
    leaf.exponent_v = set_rounded(dv, leaf.dv);
    const Vec3 u = leaf.by_u(), v = leaf.by_v(), normal = cross(u, v);
    const double square = dot(normal, normal);
    const Vec3 axes[3] = {cross(v, normal), cross(normal, u), normal};
    const PartBends bends(part.net, middle.point);
    // Rounding of the center and the derivatives, and of sums of them.
    const double steps = std::ldexp(2.0, leaf.exponent_u) + std::ldexp(2.0, leaf.exponent_v);
    const double rounding = 0x1p-20 * (length(center) + length(u) + length(v)) + steps;
    PartBends::Bends bend[3];
    bool has_plane = square > 0.0;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = axes[k] / square;
        bend[k] = bends.along(frame.scale * axis);
        const double bound = 1.000001 * bend[k].sum() + rounding * length(axis);
        has_plane = has_plane && bound < 1e6;
        leaf.bend[k] = has_plane ? upper_half(bound) : std::uint16_t{0};
    }
    part.area = length(u) * length(v);
    if (!has_plane) {
        // The patch may be folded to a line at the middle, where its derivatives carry no
        // information.
        for (int k = 0; k < 3; ++k) leaf.du[k] = leaf.dv[k] = 0, leaf.bend[k] = 0;
        const double size = frame.scale * length(control_box(part.net).size());
        part.area = std::max(part.area, 0.125 * size * size);
    }
    part.uncertified = part.area;
    if (has_plane) {
        part.uncertified *= uncertified_part(leaf, length(u), length(v), std::sqrt(square));
    }
    const int level_u = leaf.level_u, level_v = leaf.level_v;
    // The parameter of a half has half of the derivative.
    const double size_u = length(u), size_v = length(v);
    const double if_u = std::max(2.0 * (bend[0].halved_u() + bend[2].halved_u() * size_v),
                                 bend[1].halved_u() + bend[2].halved_u() * size_u);
    const double if_v = std::max(bend[0].halved_v() + bend[2].halved_v() * size_v,
                                 2.0 * (bend[1].halved_v() + bend[2].halved_v() * size_u));
    part.split_u = square > 0.0 ? if_u < if_v : size_u > size_v;
    if ((part.split_u ? level_u : level_v) >= kMostLeafLevel ||
        is_below_rounding(part.net, frame, 0x1p-20 * length(center))) {
        part.uncertified = 0.0;
    }
}

std::array<Part, 2> halves_of_part(const Part& part, const PatchFrame& frame) {
    std::array<Part, 2> halves{part, part};
    auto nets = part.split_u ? halved_u(part.net) : halved_v(part.net);
    halves[0].net = nets.first;
    halves[1].net = nets.second;
    for (std::size_t side = 0; side < 2; ++side) {
        PatchLeaf& leaf = halves[side].leaf;
        std::uint8_t& place = part.split_u ? leaf.u : leaf.v;
        place = static_cast<std::uint8_t>(2 * place + side);
        if (part.split_u) {
            ++leaf.level_u;
        } else {
            ++leaf.level_v;
        }
        measure(halves[side], frame);
    }
    return halves;
}

}  // namespace

void append_leaves(const BezierNet& net, std::uint32_t piece, const PatchFrame& frame,
                   std::vector<PatchLeaf>& leaves, std::vector<Box3>& boxes) {
    const auto less = [](const Part& a, const Part& b) { return a.uncertified < b.uncertified; };
    std::vector<Part> parts(1);
    parts[0].net = net;
    parts[0].leaf = {};
    parts[0].leaf.piece = piece;
    measure(parts[0], frame);
    const std::size_t room = kMostBytes - 48;
    const std::size_t points = sizeof(HomogeneousPoint) * static_cast<std::size_t>(net.count());
    const std::size_t most =
        std::max(kFewestLeaves, points < room ? (room - points) / kBytesOfLeaf : 0);
    parts.reserve(most);
    while (parts.size() < most) {
        double area = 0.0, uncertified = 0.0;
        for (const Part& part : parts) {
            area += part.area;
            uncertified += part.uncertified;
        }
        if (!(uncertified > kUncertified * area)) break;
        const auto worst = std::max_element(parts.begin(), parts.end(), less);
        const auto halves = halves_of_part(*worst, frame);
        *worst = halves[0];
        parts.push_back(halves[1]);
    }
    for (const Part& part : parts) {
        leaves.push_back(part.leaf);
        const Box3 box = control_box(part.net);
        boxes.push_back(
            {frame.scale * (box.lo - frame.center), frame.scale * (box.hi - frame.center)});
    }
}

}  // namespace alhazen
