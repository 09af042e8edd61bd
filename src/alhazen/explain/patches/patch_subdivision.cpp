#include "alhazen/explain/patches/patch_subdivision.h"

#include <algorithm>
#include <concepts>
#include <tuple>
#include <utility>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/shapes/patches/bezier_patch.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"
#include "alhazen/shapes/patches/patch_mesh.h"

namespace alhazen {

namespace {

constexpr double kPixelOfPatch = 0x1p-10;
constexpr int kDeepestPart = 16;
constexpr std::size_t kMostPatchParts = 4000;

bool box_meets(const Box3& box, const Ray& ray) {
    double from = 0.0, to = kInfinity;
    for (int k = 0; k < 3; ++k) {
        const double d = ray.direction[k], lo = box.lo[k] - ray.origin[k],
                     hi = box.hi[k] - ray.origin[k];
        if (d == 0.0) {
            if (lo > 0.0 || hi < 0.0) return false;
            continue;
        }
        from = std::max(from, (d > 0.0 ? lo : hi) / d);
        to = std::min(to, (d > 0.0 ? hi : lo) / d);
    }
    return from <= to;
}

/// Subdivides breadth first, so that the limit cuts off the finest parts.
void subdivide(const BezierNet& whole, const Ray& ray, PatchSubdivision& result) {
    struct Waiting {
        BezierNet net;
        PatchPart part;
    };
    const double pixel = kPixelOfPatch * max_component(control_box(whole).size());
    std::vector<Waiting> level{{whole, {}}};
    while (!level.empty()) {
        std::vector<Waiting> next;
        for (const Waiting& w : level) {
            if (result.parts.size() == kMostPatchParts) {
                result.cut = true;
                return;
            }
            PatchPart part = w.part;
            const Box3 box = control_box(w.net);
            part.met = box_meets(box, ray);
            result.parts.push_back(part);
            if (!part.met || part.level == kDeepestPart || max_component(box.size()) <= pixel) {
                continue;
            }
            const auto [low, high] = halved_u(w.net);
            for (int a = 0; a < 2; ++a) {
                const auto [first, second] = halved_v(a == 0 ? low : high);
                next.push_back({first, {part.level + 1, 2 * part.u + a, 2 * part.v}});
                next.push_back({second, {part.level + 1, 2 * part.u + a, 2 * part.v + 1}});
            }
        }
        level = std::move(next);
    }
}

template <class Shape>
concept PatchShape = std::same_as<Shape, BezierPatch> || std::same_as<Shape, PatchMesh> ||
    std::same_as<Shape, NurbsSurface>;

class PatchFinder {
  public:
    PatchFinder(const LoadedScene& loaded, std::vector<PatchSubdivision>& found)
        : loaded_(loaded), found_(found) {}

    /// Visits a table; `ray` is in its frame. Recursion ends with the nesting of instances.
    void look(const PrimitiveTable& table, const Ray& ray) {
        std::apply([&](const auto&... column) { (look_at(table, column, ray), ...); },
                   table.columns);
        for (const Instance& instance : table.instances) {
            const Ray inner = inner_ray(instance, ray);
            if (!box_meets(instance.aggregate->box(), inner)) continue;
            look(instance.aggregate->primitives(), inner);
        }
    }

    /// Keeps the first `most` patches, and subdivides them.
    void finish(std::size_t most) {
        std::vector<std::size_t> order(found_.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        const auto first = [&](std::size_t i) {
            return found_[i].crossings.empty() ? kInfinity : found_[i].crossings.front().t;
        };
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return first(a) < first(b); });
        if (order.size() > most) order.resize(most);
        std::vector<PatchSubdivision> kept;
        for (const std::size_t i : order) {
            subdivide(nets_[i].first, nets_[i].second, found_[i]);
            kept.push_back(std::move(found_[i]));
        }
        found_ = std::move(kept);
    }

  private:
    template <class Shape>
    void look_at(const PrimitiveTable&, const ShapeColumn<Shape>&, const Ray&) {}
    template <PatchShape Shape>
    void look_at(const PrimitiveTable& table, const ShapeColumn<Shape>& column, const Ray& ray) {
        for (std::size_t i = 0; i < column.shapes.size(); ++i) {
            const std::uint32_t placement = column.placements[i];
            Ray inner = placement == kNoPlacement
                            ? ray
                            : transformed(table.placements[placement].inner_from_outer, ray);
            inner.t_min = 0.0;
            inner.t_max = kInfinity;
            const PatchTree& tree = *column.shapes[i].tree;
            if (!box_meets(tree.box(), inner)) continue;
            ShapeHits hits;
            column.shapes[i].intersect(inner, hits);
            const std::uint32_t part = column.parts.empty() ? 0 : column.parts[i];
            for (std::size_t k = 0; k < tree.pieces().size(); ++k) {
                add(tree.pieces()[k], k, inner, hits,
                    {Shape::kName, part_name(loaded_.description, part)});
            }
        }
    }

    void add(const BezierPiece& piece, std::size_t number, const Ray& ray, const ShapeHits& hits,
             std::pair<std::string, std::string> names) {
        if (!box_meets(control_box(piece.net), ray)) return;
        PatchSubdivision& result = found_.emplace_back();
        result.shape = std::move(names.first);
        result.part = std::move(names.second);
        result.piece = number;
        result.degree_u = piece.net.degree_u;
        result.degree_v = piece.net.degree_v;
        const auto in_piece = [](double x, double lo, double hi) { return (x - lo) / (hi - lo); };
        for (const ShapeHit& hit : hits) {
            if (static_cast<std::uint32_t>(hit.part) != piece.part) continue;
            result.crossings.push_back({hit.t, in_piece(hit.u, piece.lo.x, piece.hi.x),
                                        in_piece(hit.v, piece.lo.y, piece.hi.y)});
        }
        nets_.emplace_back(piece.net, ray);
    }

    const LoadedScene& loaded_;
    std::vector<PatchSubdivision>& found_;
    std::vector<std::pair<BezierNet, Ray>> nets_;
};

}  // namespace

std::vector<PatchSubdivision> patch_subdivisions(const LoadedScene& loaded, const Ray& ray,
                                                 std::size_t most) {
    std::vector<PatchSubdivision> found;
    PatchFinder finder(loaded, found);
    finder.look(loaded.scene.aggregate->primitives(), ray);
    finder.finish(most);
    return found;
}

}  // namespace alhazen
