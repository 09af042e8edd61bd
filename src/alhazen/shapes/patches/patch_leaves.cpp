#include "alhazen/shapes/patches/patch_leaves.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/patches/patch_cells.h"

namespace alhazen {

namespace {

constexpr std::size_t kMostLeaves = 40;
constexpr int kMostLeafLevel = 12;
/// Part of a patch's area, seen from everywhere, that need not be certified.
constexpr double kUncertified = 0.04;

Vec3 xyz(const HomogeneousPoint& p) {
    return {p.x, p.y, p.z};
}

/// A part of a patch, with what decides where to divide it.
struct Part {
    BezierNet net;
    PatchLeaf leaf;
    double area = 0, uncertified = 0;
    bool split_u = false;
};

/// The bounds of the derivatives and of the distance from the tangent plane, in half-widths.
class PartBounds {
  public:
    explicit PartBounds(const BezierNet& net)
        : net_(net),
          middle_(patch_value(net, 0.5, 0.5)),
          du(0.5 * middle_.du),
          dv(0.5 * middle_.dv) {
        for (int k = 0; k < net.count(); ++k) {
            const double w = net.points[static_cast<std::size_t>(k)].w;
            least_weight_ = std::min(least_weight_, w);
            weight_change_ = std::max(weight_change_, std::abs(w - middle_.weight));
            radius_ = std::max(radius_, length(offset(k)));
        }
        radius_ /= least_weight_;
        bound_bulge();
        bound_spread();
    }
    [[nodiscard]] const Vec3& center() const { return middle_.point; }

  private:
    /// The control point from the middle, times its weight.
    [[nodiscard]] Vec3 offset(int k) const {
        const HomogeneousPoint& p = net_.points[static_cast<std::size_t>(k)];
        return xyz(p) - p.w * middle_.point;
    }
    void bound_bulge() {
        for (int i = 0; i <= net_.degree_u; ++i) {
            for (int j = 0; j <= net_.degree_v; ++j) {
                const Vec3 plane =
                    (2.0 * i / net_.degree_u - 1.0) * du + (2.0 * j / net_.degree_v - 1.0) * dv;
                const Vec3 d = offset(i * (net_.degree_v + 1) + j) - middle_.weight * plane;
                bulge = std::max(bulge, length(d));
            }
        }
        bulge = (bulge + (length(du) + length(dv)) * weight_change_) / least_weight_;
    }
    void bound_spread() {
        double spread_u = 0.0, spread_v = 0.0;
        const int row = net_.degree_v + 1;
        const auto change = [&](int from, int to, int degree, const Vec3& middle) {
            const double rise = net_.points[static_cast<std::size_t>(to)].w -
                                net_.points[static_cast<std::size_t>(from)].w;
            return length(0.5 * degree * (offset(to) - offset(from)) - middle_.weight * middle) +
                   0.5 * degree * radius_ * std::abs(rise);
        };
        for (int i = 0; i <= net_.degree_u; ++i) {
            for (int j = 0; j <= net_.degree_v; ++j) {
                const int k = i * row + j;
                if (i < net_.degree_u) {
                    spread_u = std::max(spread_u, change(k, k + row, net_.degree_u, du));
                }
                if (j < net_.degree_v) {
                    spread_v = std::max(spread_v, change(k, k + 1, net_.degree_v, dv));
                }
            }
        }
        const double rest = (length(du) + length(dv)) * weight_change_;
        const double growth = 1.0 + 2.5 * kCellMargin * (net_.degree_u + net_.degree_v);
        spread = growth * (spread_u + spread_v + rest) / least_weight_;
    }

    const BezierNet& net_;
    PatchValue middle_;
    double least_weight_ = kInfinity, weight_change_ = 0, radius_ = 0;

  public:
    Vec3 du, dv;
    double bulge = 0, spread = 0;
};

/// Whether halving in u straightens a part more.
bool straighter_by_u(const BezierNet& net) {
    const int n = net.degree_u, m = net.degree_v;
    const auto at = [&](int i, int j) { return projected(net.at(i, j)); };
    double bend_u = 0.0, bend_v = 0.0, twist = 0.0, extent_u = 0.0, extent_v = 0.0;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            const Vec3 p = at(i, j);
            if (i < n) extent_u = std::max(extent_u, length(at(i + 1, j) - p));
            if (j < m) extent_v = std::max(extent_v, length(at(i, j + 1) - p));
            if (i + 2 <= n) {
                bend_u = std::max(bend_u, length(at(i + 2, j) - 2.0 * at(i + 1, j) + p));
            }
            if (j + 2 <= m) {
                bend_v = std::max(bend_v, length(at(i, j + 2) - 2.0 * at(i, j + 1) + p));
            }
            if (i < n && j < m) {
                const Vec3 d = at(i + 1, j + 1) - at(i, j + 1) - at(i + 1, j) + p;
                twist = std::max(twist, length(d));
            }
        }
    }
    bend_u *= n * (n - 1);
    bend_v *= m * (m - 1);
    if (std::max(bend_u, bend_v) > n * m * twist) return bend_u > bend_v;
    return n * extent_u > m * extent_v;
}

void measure(Part& part, const PatchFrame& frame) {
    const PartBounds bounds(part.net);
    const Vec3 center = frame.scale * (bounds.center() - frame.center);
    const Vec3 du = frame.scale * bounds.du, dv = frame.scale * bounds.dv;
    PatchLeaf& leaf = part.leaf;
    for (int k = 0; k < 3; ++k) {
        leaf.center[k] = static_cast<float>(center[k]);
        leaf.du[k] = static_cast<float>(du[k]);
        leaf.dv[k] = static_cast<float>(dv[k]);
    }
    const double size_u = length(du), size_v = length(dv);
    // Rounding of the six vectors, and of the sums made of them.
    const double rounding = 0x1p-21 * (length(center) + size_u + size_v);
    leaf.bulge = static_cast<float>(1.000001 * frame.scale * bounds.bulge + rounding);
    leaf.spread =
        static_cast<float>(1.000001 * frame.scale * bounds.spread + 0x1p-21 * (size_u + size_v));
    // The certificate holds for lines at an angle to the plane whose sine is above `sine`.
    part.area = size_u * size_v;
    const double sine = std::max(size_u, size_v) * leaf.spread / kCertified;
    const double flat = length(cross(du, dv));
    const double part_uncertified = sine < flat ? sine * sine / (flat * flat) : 1.0;
    part.uncertified = part.area * part_uncertified;
    const int level_u = leaf.level_u, level_v = leaf.level_v;
    part.split_u = straighter_by_u(part.net);
    if ((part.split_u ? level_u : level_v) >= kMostLeafLevel) part.uncertified = 0.0;
}

std::array<Part, 2> halves_of_part(const Part& part, const PatchFrame& frame) {
    std::array<Part, 2> halves{part, part};
    auto nets = part.split_u ? halved_u(part.net) : halved_v(part.net);
    halves[0].net = nets.first;
    halves[1].net = nets.second;
    for (std::size_t side = 0; side < 2; ++side) {
        PatchLeaf& leaf = halves[side].leaf;
        std::uint16_t& place = part.split_u ? leaf.u : leaf.v;
        place = static_cast<std::uint16_t>(2 * place + side);
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
    while (parts.size() < kMostLeaves) {
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
