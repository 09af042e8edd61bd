#include "alhazen/explain/cones/cone_explanation.h"

#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/cameras/pixel_cones.h"
#include "alhazen/renderers/core/samplers.h"
#include "alhazen/session/aov_pictures.h"

namespace alhazen {

namespace {

constexpr std::size_t kMostCones = 2000;

/// Builds the tree from the events of the renderer.
class ConeRecorder final : public ConeWatcher {
  public:
    explicit ConeRecorder(const SceneDescription& description) : description_(description) {}

    void begin_cone(const ConeRay& whole, const ConeRay& cone, const ConePath& path,
                    int depth) override {
        ConeNode node;
        node.kind = path.start.kind;
        node.depth = depth;
        node.cone = cone;
        const bool grows = whole.spread != 0.0;
        node.narrowed = grows                ? cone.spread / whole.spread
                        : whole.radius > 0.0 ? cone.radius / whole.radius
                                             : 1.0;
        node.length = kInfinity;
        open_.push_back(std::move(node));
    }
    void begin_piece(const ConePiece& piece, double weight, double radius, double t,
                     const ShadingPoint& point) override {
        ConePart part;
        part.object = part_name(description_, point.surface.part);
        part.point = point.surface.point;
        part.at = piece.at;
        part.t = t;
        part.share = piece.share;
        part.weight = weight;
        part.radius = radius;
        open_.back().parts.push_back(std::move(part));
    }
    void end_piece(const Rgb& color) override { open_.back().parts.back().color = color; }
    void end_cone(double left, const Rgb& radiance) override {
        ConeNode node = std::move(open_.back());
        open_.pop_back();
        node.left = left;
        node.radiance = radiance;
        // A cone that is mostly covered is drawn up to its last piece.
        if (!node.parts.empty() && left < 0.5) node.length = node.parts.back().t;
        add(std::move(node));
    }
    void shadow_cone(const ConeRay& cone, double distance, const Rgb& through,
                     const ConeToLight& to) override {
        ConeNode node;
        node.kind = RayKind::Shadow;
        node.depth = open_.back().depth + 1;
        node.cone = cone;
        node.length = distance;
        node.radiance = through;
        node.to = to;
        add(std::move(node));
    }

    [[nodiscard]] ConeExplanation take() { return std::move(result_); }

  private:
    void add(ConeNode node) {
        if (open_.empty()) {
            result_.tree = std::move(node);
        } else if (++count_ > kMostCones) {
            result_.cut = true;
        } else {
            open_.back().parts.back().cones.push_back(std::move(node));
        }
    }

    const SceneDescription& description_;
    std::vector<ConeNode> open_;  ///< from the eye to the cone being traced
    std::size_t count_ = 0;
    ConeExplanation result_;
};

}  // namespace

ConeExplanation explain_cones(const RenderJob& job, int x, int y, int width, int height) {
    try {
        const ConeScene scene = cone_scene(*job.description, job.scene);
        RayCounters counters;
        ConeTracer tracer(job, scene, false, counters);
        ConeRecorder recorder(*job.description);
        tracer.set_watcher(&recorder);
        const PixelCones cones(job.camera, width, height, 1);
        const PointSampler middle(job, width, height);
        (void)tracer.trace_eye(cones.at(middle.at(x, y)));
        return recorder.take();
    } catch (const Error& error) {
        ConeExplanation none;
        none.unavailable = error.what();
        return none;
    }
}

}  // namespace alhazen
