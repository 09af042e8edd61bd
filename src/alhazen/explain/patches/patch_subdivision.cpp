#include "alhazen/explain/patches/patch_subdivision.h"

#include <algorithm>
#include <concepts>
#include <tuple>
#include <utility>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/shapes_on_ray.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/shapes/patches/bezier_patch.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"
#include "alhazen/shapes/patches/patch_mesh.h"

namespace alhazen {

namespace {

constexpr double kPixelOfPatch = 0x1p-10;
constexpr int kDeepestPart = 16;
constexpr std::size_t kMostPatchParts = 4000, kMostPatches = 6;

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
            part.met = meets_ahead(box, ray);
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

    template <PatchShape Shape>
    void operator()(const Shape& shape, Ray ray, std::uint32_t part) {
        ray.t_min = 0.0;
        ray.t_max = kInfinity;
        const PatchTree& tree = *shape.tree;
        if (!meets_ahead(tree.box(), ray)) return;
        ShapeHits hits;
        shape.intersect(ray, hits);
        for (std::size_t k = 0; k < tree.pieces().size(); ++k) {
            add(tree.pieces()[k], k, ray, hits,
                {Shape::kName, part_name(loaded_.description, part)});
        }
    }

    /// Keeps the first kMostPatches patches, and subdivides them.
    void finish() {
        std::vector<std::size_t> order(found_.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        const auto first = [&](std::size_t i) {
            return found_[i].crossings.empty() ? kInfinity : found_[i].crossings.front().t;
        };
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return first(a) < first(b); });
        if (order.size() > kMostPatches) order.resize(kMostPatches);
        std::vector<PatchSubdivision> kept;
        for (const std::size_t i : order) {
            subdivide(nets_[i].first, nets_[i].second, found_[i]);
            kept.push_back(std::move(found_[i]));
        }
        found_ = std::move(kept);
    }

  private:
    void add(const BezierPiece& piece, std::size_t number, const Ray& ray, const ShapeHits& hits,
             std::pair<std::string, std::string> names) {
        if (!meets_ahead(control_box(piece.net), ray)) return;
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

std::vector<PatchSubdivision> patch_subdivisions(const LoadedScene& loaded, const Ray& ray) {
    std::vector<PatchSubdivision> found;
    PatchFinder finder(loaded, found);
    visit_shapes_on_ray(loaded.scene.aggregate->primitives(), ray, finder);
    finder.finish();
    return found;
}

}  // namespace alhazen
