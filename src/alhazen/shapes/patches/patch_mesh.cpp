#include "alhazen/shapes/patches/patch_mesh.h"

#include <algorithm>
#include <bit>
#include <compare>
#include <tuple>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/patch_checks.h"
#include "alhazen/shapes/patches/patch_value.h"

namespace alhazen {

namespace {

using CurvePoints = std::array<HomogeneousPoint, kMaxPatchOrder>;

std::strong_ordering by_coordinates(const HomogeneousPoint& a, const HomogeneousPoint& b) {
    const double p[4] = {a.x, a.y, a.z, a.w}, q[4] = {b.x, b.y, b.z, b.w};
    for (int k = 0; k < 4; ++k) {
        if (p[k] != q[k])
            return p[k] < q[k] ? std::strong_ordering::less : std::strong_ordering::greater;
    }
    return std::strong_ordering::equal;
}

/// A boundary curve of a patch.
struct CurveUse {
    std::uint64_t curve;  ///< first a hash of its points, then a number unique to these points
    std::uint32_t patch;
    std::uint8_t side;
    bool turned;  ///< its points run against the border, which is counterclockwise in (u, v)
};

/// The control points of a boundary curve, from the end that compares less; returns their number,
/// or 0 for a curve that is one point. Sets `turned`.
int curve_points(BezierView net, int side, CurvePoints& curve, bool& turned) {
    const int count = boundary_curve(net, side, curve);
    const std::span points(curve.data(), static_cast<std::size_t>(count));
    bool is_point = true, backward = false;
    for (HomogeneousPoint& p : points) {
        // Adding zero turns -0 into 0.
        p = {p.x + 0.0, p.y + 0.0, p.z + 0.0, p.w};
        is_point = is_point && projected(p) == projected(points[0]);
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto order = by_coordinates(points[points.size() - 1 - k], points[k]);
        backward = order < 0;
        if (order != 0) break;
    }
    if (backward) std::reverse(points.begin(), points.end());
    turned = (side >= 2) != backward;
    return is_point ? 0 : count;
}

/// The boundary curves of all patches that are more than a point, grouped by equal points.
class CurveUses {
  public:
    explicit CurveUses(const PatchPieces& pieces) : pieces_(pieces) {
        uses_.reserve(4 * pieces.size());
        CurvePoints curve;
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            for (int side = 0; side < 4; ++side) {
                CurveUse use{0, static_cast<std::uint32_t>(k), static_cast<std::uint8_t>(side),
                             false};
                const int count = curve_points(pieces.net(k), side, curve, use.turned);
                if (count == 0) continue;
                use.curve = hash_of({curve.data(), static_cast<std::size_t>(count)});
                uses_.push_back(use);
            }
        }
        std::sort(uses_.begin(), uses_.end(), [](const CurveUse& a, const CurveUse& b) {
            return std::tie(a.curve, a.patch, a.side) < std::tie(b.curve, b.patch, b.side);
        });
        number_curves();
    }

    /// Calls f(uses) for each curve with the patches that share it.
    template <class F>
    void for_each(F&& f) const {
        for (std::size_t begin = 0; begin < uses_.size();) {
            std::size_t end = begin + 1;
            while (end < uses_.size() && uses_[end].curve == uses_[begin].curve) ++end;
            f(std::span(uses_).subspan(begin, end - begin));
            begin = end;
        }
    }

    /// True if every curve belongs to an even number of patches.
    [[nodiscard]] bool all_even() const {
        bool even = true;
        for_each([&](std::span<const CurveUse> users) { even = even && users.size() % 2 == 0; });
        return even;
    }

  private:
    static std::uint64_t hash_of(std::span<const HomogeneousPoint> points) {
        std::uint64_t hash = 0;
        for (const HomogeneousPoint& p : points) {
            for (const double x : {p.x, p.y, p.z, p.w}) {
                hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
                hash ^= hash >> 29;
            }
        }
        return hash;
    }
    [[nodiscard]] std::strong_ordering compare(const CurveUse& a, const CurveUse& b) const {
        CurvePoints p, q;
        bool turned = false;
        const int n = curve_points(pieces_.net(a.patch), a.side, p, turned);
        const int m = curve_points(pieces_.net(b.patch), b.side, q, turned);
        return std::lexicographical_compare_three_way(p.begin(), p.begin() + n, q.begin(),
                                                      q.begin() + m, by_coordinates);
    }
    /// Distinguishes curves of equal hash.
    void number_curves() {
        const auto same = [this](const CurveUse& a, const CurveUse& b) {
            return compare(a, b) == 0;
        };
        std::uint64_t number = 0;
        for (auto begin = uses_.begin(); begin != uses_.end();) {
            const auto end = std::find_if(
                begin, uses_.end(), [&](const CurveUse& use) { return use.curve != begin->curve; });
            for (auto rest = begin; rest != end; ++number) {
                const CurveUse first = *rest;
                const auto next = std::partition(
                    rest, end, [&](const CurveUse& use) { return same(first, use); });
                for (; rest != next; ++rest) rest->curve = number;
            }
            begin = end;
        }
    }

    const PatchPieces& pieces_;
    std::vector<CurveUse> uses_;
};

/// A rough value of a third of the integral of (P - center) . n over a patch.
double rough_flux(BezierView net, const Vec3& center) {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const PatchValue at = patch_value(net, (i + 0.5) / 4, (j + 0.5) / 4);
            sum += dot(at.point - center, cross(at.du, at.dv));
        }
    }
    return sum;
}

/// The patches of a closed mesh whose normals point inward: neighbours are oriented consistently
/// across shared curves, and the whole encloses a positive volume.
std::vector<bool> inward_patches(const PatchPieces& pieces, const CurveUses& uses,
                                 const Vec3& center) {
    constexpr std::uint32_t kNone = ~0u;
    struct Neighbour {
        std::uint32_t patch = kNone;
        bool against = false;
    };
    std::vector<std::array<Neighbour, 4>> neighbours(pieces.size());  // [patch][side]
    uses.for_each([&](std::span<const CurveUse> users) {
        if (users.size() != 2) return;
        const bool against = users[0].turned == users[1].turned;
        neighbours[users[0].patch][users[0].side] = {users[1].patch, against};
        neighbours[users[1].patch][users[1].side] = {users[0].patch, against};
    });
    std::vector<bool> inward(pieces.size()), seen(pieces.size());
    double flux = 0.0;
    std::vector<std::uint32_t> next;
    for (std::uint32_t first = 0; first < pieces.size(); ++first) {
        if (!seen[first]) next.push_back(first);
        seen[first] = true;
        while (!next.empty()) {
            const std::uint32_t patch = next.back();
            next.pop_back();
            flux += (inward[patch] ? -1.0 : 1.0) * rough_flux(pieces.net(patch), center);
            for (const Neighbour& other : neighbours[patch]) {
                if (other.patch == kNone || seen[other.patch]) continue;
                seen[other.patch] = true;
                inward[other.patch] = inward[patch] != other.against;
                next.push_back(other.patch);
            }
        }
    }
    if (flux < 0.0) inward.flip();
    return inward;
}

PatchPieces pieces_of(const PatchMesh& mesh) {
    PatchPieces pieces;
    for (std::size_t patch = 0; patch < mesh.patch_count(); ++patch) {
        pieces.add({.net = mesh.net(patch), .part = static_cast<std::uint32_t>(patch)});
    }
    return pieces;
}

}  // namespace

std::size_t PatchMesh::patch_count() const {
    return patches.size() / ((std::size_t{degree_u} + 1) * (std::size_t{degree_v} + 1));
}

BezierNet PatchMesh::net(std::size_t patch) const {
    BezierNet net;
    net.degree_u = static_cast<int>(degree_u);
    net.degree_v = static_cast<int>(degree_v);
    const auto count = static_cast<std::size_t>(net.count());
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t index = patches[patch * count + k];
        net.points[k] = homogeneous(points[index], weights.empty() ? 1.0 : weights[index]);
    }
    return net;
}

bool PatchMesh::closed() const {
    if (tree != nullptr) return is_closed;
    Diagnostics findings;
    validate({}, findings);
    if (findings.error_count() != 0) return false;
    const PatchPieces pieces = pieces_of(*this);
    return CurveUses(pieces).all_even();
}

void PatchMesh::prepare() {
    tree = std::make_shared<PatchTree>(pieces_of(*this));
    const CurveUses uses(tree->pieces());
    is_closed = uses.all_even();
    inward.clear();
    if (is_closed) inward = inward_patches(tree->pieces(), uses, tree->box().center());
}

void PatchMesh::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    check_patch_degrees(checks, degree_u, degree_v);
    check_control_points(checks, points, weights);
    const std::size_t count = (std::size_t{degree_u} + 1) * (std::size_t{degree_v} + 1);
    if (patches.empty() || patches.size() % count != 0) {
        checks.fail("patches of degree " + std::to_string(degree_u) + " by " +
                    std::to_string(degree_v) + " have " + std::to_string(count) +
                    " indices each; found " + std::to_string(patches.size()) + " in all");
    }
    for (std::size_t k = 0; k < patches.size(); ++k) {
        if (patches[k] >= points.size()) {
            checks.fail("patch " + std::to_string(k / count) + ": there is no point " +
                        std::to_string(patches[k]));
        }
    }
}

ShapeSurface PatchMesh::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = tree->surface(ray, hit);
    if (is_closed && inward[hit.part]) {
        surface.normal = surface.shading_normal = -surface.normal;
    }
    return surface;
}

PatchMeasures measures_of(const PatchMesh& mesh) {
    PatchMeasures sum;
    for (std::size_t patch = 0; patch < mesh.patch_count(); ++patch) {
        const PatchMeasures measures = measures_of(mesh.net(patch));
        sum.area += measures.area;
        sum.flux_volume += measures.flux_volume;
    }
    return sum;
}

}  // namespace alhazen
