/// `certified_newton`: the production search (patch_tree.h) under the interface of the methods.
///
/// Source: patch_tree.h.
/// Conventions: all patches are in one tree, as in a patch mesh. Steps are not counted.

#include "alhazen/shapes/patches/methods/each_patch.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {
namespace {

class CertifiedNewton final : public PatchMethod {
  public:
    explicit CertifiedNewton(std::span<const BezierNet> nets) : tree_(pieces_of(nets)) {}

    void crossings(const Ray& ray, std::vector<PatchCrossing>& out,
                   PatchMethodCounts& counts) override {
        ++counts.rays;
        ShapeHits hits;
        tree_.intersect(ray, hits);
        for (std::size_t k = 0; k < hits.size(); ++k) {
            out.push_back({hits[k].t, hits[k].u, hits[k].v, hits[k].part});
        }
    }

  private:
    static std::vector<BezierPiece> pieces_of(std::span<const BezierNet> nets) {
        std::vector<BezierPiece> pieces;
        for (const BezierNet& net : nets) {
            pieces.push_back({net, static_cast<std::uint32_t>(pieces.size())});
        }
        return pieces;
    }

    PatchTree tree_;
};

}  // namespace

std::unique_ptr<PatchMethod> make_certified_newton(std::span<const BezierNet> nets) {
    return std::make_unique<CertifiedNewton>(nets);
}

}  // namespace alhazen
