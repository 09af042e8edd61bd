#include "alhazen/shapes/patches/patch_leaves.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/patches/certified_cells.h"

namespace alhazen {

namespace {

constexpr std::size_t kFewestLeaves = 20;  ///< that a patch may have
/// Of a bicubic patch with its points, leaves and boxes.
constexpr std::size_t kMostBytes = 4096;
constexpr std::size_t kBytesOfLeaf = sizeof(PatchLeaf) + 36;  ///< with its share of the boxes
constexpr int kMostLeafLevel = 8;
/// Part of a patch's area, seen from everywhere, that need not be certified.
constexpr double kUncertified = 0.05;

/// A part of a patch, with what decides where to divide it.
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
    PartBends(const BezierNet& net, const Vec3& middle) : net_(net), middle_(middle) {
        double least = kInfinity;
        for (int k = 0; k < net.count(); ++k) {
            least = std::min(least, net.points[static_cast<std::size_t>(k)].w);
        }
        // For the margin of the cell (kCellMargin).
        const double growth = 1.0 + 2.5 * kCellMargin * (net.degree_u + net.degree_v);
        factor_ = growth / least;
    }

    /// Bounds of the second derivatives along an axis.
    struct Bends {
        double aa = 0, ab = 0, bb = 0;

        [[nodiscard]] double sum() const { return aa + 2.0 * ab + bb; }
        [[nodiscard]] double halved_u() const { return 0.25 * aa + ab + bb; }
        [[nodiscard]] double halved_v() const { return aa + ab + 0.25 * bb; }
    };
    [[nodiscard]] Bends along(const Vec3& axis) const {
        const auto most = [&](int order_u, int order_v) { return find(axis, order_u, order_v); };
        const Most m0 = most(0, 0), mu = most(1, 0), mv = most(0, 1);
        const Most muu = most(2, 0), muv = most(1, 1), mvv = most(0, 2);
        const double s = m0.point;
        const double s_u = mu.point + mu.weight * s, s_v = mv.point + mv.weight * s;
        const double s_uu = muu.point + 2.0 * mu.weight * s_u + muu.weight * s;
        const double s_vv = mvv.point + 2.0 * mv.weight * s_v + mvv.weight * s;
        const double s_uv = muv.point + mu.weight * s_v + mv.weight * s_u + muv.weight * s;
        return {s_uu, s_uv, s_vv};
    }

  private:
    struct Most {
        double point = 0, weight = 0;
    };

    /// Bounds of a derivative of axis . N and of the weight: `order_u` times by u, `order_v` times
    /// by v.
    [[nodiscard]] Most find(const Vec3& axis, int order_u, int order_v) const {
        static constexpr double kBinomial[3][3] = {{1, 0, 0}, {-1, 1, 0}, {1, -2, 1}};
        double factor = factor_;
        for (int k = 0; k < order_u; ++k) factor *= 0.5 * (net_.degree_u - k);
        for (int k = 0; k < order_v; ++k) factor *= 0.5 * (net_.degree_v - k);
        Most most;
        for (int i = 0; i + order_u <= net_.degree_u; ++i) {
            for (int j = 0; j + order_v <= net_.degree_v; ++j) {
                double point = 0.0, weight = 0.0;
                for (int k = 0; k <= order_u; ++k) {
                    for (int l = 0; l <= order_v; ++l) {
                        const double c = kBinomial[order_u][k] * kBinomial[order_v][l];
                        const HomogeneousPoint& p = net_.at(i + k, j + l);
                        point += c * dot(axis, Vec3{p.x, p.y, p.z} - p.w * middle_);
                        weight += c * p.w;
                    }
                }
                most.point = std::max(most.point, factor * std::abs(point));
                most.weight = std::max(most.weight, factor * std::abs(weight));
            }
        }
        return most;
    }

    const BezierNet& net_;
    Vec3 middle_;
    double factor_ = 1;
};

/// The part of the lines that meet a leaf for which it is not certified.
double uncertified_part(const PatchLeaf& leaf, double size_u, double size_v, double flat) {
    const double along = std::max(leaf.bend[0], leaf.bend[1]);
    const double across = leaf.bend[2] * std::max(size_u, size_v) * flat;
    if (!(along < kUnique)) return 1.0;
    // bend along + bend across * tan(angle) / (sine * size of a derivative) <= kUnique
    const double slope = (kUnique - along) * flat / std::max(across, 1e-30);
    return 1.0 / (1.0 + slope * slope);
}

void measure(Part& part, const PatchFrame& frame) {
    const PatchValue middle = patch_value(part.net, 0.5, 0.5);
    const Vec3 center = frame.scale * (middle.point - frame.center);
    const Vec3 du = (0.5 * frame.scale) * middle.du, dv = (0.5 * frame.scale) * middle.dv;
    PatchLeaf& leaf = part.leaf;
    for (int k = 0; k < 3; ++k) {
        leaf.center[k] = static_cast<float>(center[k]);
        leaf.du[k] = static_cast<float>(du[k]);
        leaf.dv[k] = static_cast<float>(dv[k]);
    }
    const auto vec = [](const float(&x)[3]) { return Vec3{x[0], x[1], x[2]}; };
    const Vec3 u = vec(leaf.du), v = vec(leaf.dv), normal = cross(u, v);
    const double square = dot(normal, normal);
    const Vec3 axes[3] = {cross(v, normal), cross(normal, u), normal};
    const PartBends bends(part.net, middle.point);
    // Rounding of the center and the derivatives, and of the sums made of them.
    const double rounding = 0x1p-20 * (length(center) + length(u) + length(v));
    PartBends::Bends bend[3];
    bool has_plane = square > 0.0;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = axes[k] / square;
        bend[k] = bends.along(frame.scale * axis);
        const double bound = 1.000001 * bend[k].sum() + rounding * length(axis);
        has_plane = has_plane && bound < 1e6;
        leaf.bend[k] = has_plane ? static_cast<float>(bound) : 0.0f;
    }
    part.area = length(u) * length(v);
    if (!has_plane) {
        // The middle may be where the patch is folded to a line: its derivatives tell nothing.
        leaf.set_without_plane();
        const double size = frame.scale * length(control_box(part.net).size());
        part.area = std::max(part.area, 0.125 * size * size);
    }
    part.uncertified = part.area;
    if (has_plane) {
        part.uncertified *= uncertified_part(leaf, length(u), length(v), std::sqrt(square));
    }
    const int level_u = leaf.level_u, level_v = leaf.level_v;
    // A half's own parameter is measured by half of the derivative.
    const double size_u = length(u), size_v = length(v);
    const double if_u = std::max(2.0 * (bend[0].halved_u() + bend[2].halved_u() * size_v),
                                 bend[1].halved_u() + bend[2].halved_u() * size_u);
    const double if_v = std::max(bend[0].halved_v() + bend[2].halved_v() * size_v,
                                 2.0 * (bend[1].halved_v() + bend[2].halved_v() * size_u));
    part.split_u = square > 0.0 ? if_u < if_v : size_u > size_v;
    if ((part.split_u ? level_u : level_v) >= kMostLeafLevel) part.uncertified = 0.0;
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
        ++(part.split_u ? leaf.level_u : leaf.level_v);
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
