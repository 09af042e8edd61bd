#include "alhazen/renderers/beam_tracing/beam_outlines.h"

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <tuple>

namespace alhazen {

namespace {

constexpr std::uint32_t kNoPlane = 0xFFFFFFFFu;
/// Least contribution of a mirror image that has lines.
constexpr double kLeastContribution = 0.25;

/// [facet] index of its plane among those of its part.
std::vector<std::uint32_t> planes_of_facets(const BeamScene& scene) {
    using Rounded = std::array<std::int64_t, 4>;
    std::map<std::pair<std::uint32_t, Rounded>, std::uint32_t> numbers;
    std::vector<std::uint32_t> planes;
    double reach = 0;
    for (std::uint32_t f = 0; f < scene.facets.size(); ++f) {
        reach = std::max(reach, std::abs(scene.plane(f).offset));
    }
    const double scale = 1e6 / (1.0 + reach);
    for (std::uint32_t f = 0; f < scene.facets.size(); ++f) {
        const std::uint32_t source = scene.facets[f].source;
        Rounded rounded{};
        if (!scene.sources[source].smooth) {
            const FacetPlane& p = scene.plane(f);
            rounded = {std::llround(1e5 * p.normal.x), std::llround(1e5 * p.normal.y),
                       std::llround(1e5 * p.normal.z), std::llround(scale * p.offset)};
        }
        const auto next = static_cast<std::uint32_t>(numbers.size());
        planes.push_back(numbers.try_emplace({source, rounded}, next).first->second);
    }
    return planes;
}

/// Numbers the visible images of pieces: a plane, or a part, seen through a chain of mirrors.
class Images {
  public:
    Images(const BeamTree& tree, std::span<const std::uint32_t> kinds) : tree_(tree) {
        for (const BeamPiece& piece : tree.pieces) {
            const BeamNode& beam = tree_.beams[piece.beam];
            if (piece.seen.facet == kNoFacet || beam.contribution.max() < kLeastContribution) {
                of_piece_.push_back(kNoPlane);
                continue;
            }
            const std::uint32_t through = beam.piece == kNoFacet ? kNoPlane : of_piece_[beam.piece];
            const auto next = static_cast<std::uint32_t>(numbers_.size());
            of_piece_.push_back(
                numbers_.try_emplace({through, beam.view.kind, kinds[piece.seen.facet]}, next)
                    .first->second);
        }
    }
    /// The union of the pieces of each image.
    [[nodiscard]] std::vector<PolygonSet> unions() const {
        std::vector<std::vector<PolygonSet>> regions(numbers_.size());
        for (std::size_t p = 0; p < of_piece_.size(); ++p) {
            if (of_piece_[p] != kNoPlane)
                regions[of_piece_[p]].push_back(tree_.pieces[p].seen.region);
        }
        std::vector<PolygonSet> result;
        for (std::vector<PolygonSet>& some : regions) {
            // Merges pairwise: each region takes part in log n unions.
            while (some.size() > 1) {
                std::vector<PolygonSet> half;
                for (std::size_t i = 0; i + 1 < some.size(); i += 2) {
                    half.push_back(union_of(some[i], some[i + 1]));
                }
                if (some.size() % 2 == 1) half.push_back(std::move(some.back()));
                some = std::move(half);
            }
            if (!some.empty()) result.push_back(std::move(some.front()));
        }
        return result;
    }

  private:
    const BeamTree& tree_;
    std::map<std::tuple<std::uint32_t, RayKind, std::uint32_t>, std::uint32_t> numbers_;
    std::vector<std::uint32_t> of_piece_;
};

/// True if there is region on both sides of an edge of its boundary: separately rounded pieces
/// leave cracks far thinner than a pixel.
bool is_crack(const PolygonSet& region, LatticePoint a, LatticePoint b) {
    constexpr double kBeside = 64;
    const double x = 0.5 * (double(a.x) + b.x), y = 0.5 * (double(a.y) + b.y);
    const double dx = b.x - a.x, dy = b.y - a.y, scale = kBeside / std::hypot(dx, dy);
    const auto inside = [&](double side) {
        const LatticePoint p{static_cast<std::int32_t>(std::lround(x - side * scale * dy)),
                             static_cast<std::int32_t>(std::lround(y + side * scale * dx))};
        return side_of_point(region, p) != PointSide::Outside;
    };
    return inside(1) && inside(-1);
}

/// Adds the lines of a loop without its cracks.
void add_lines(LineStyle style, const PolygonSet& region, std::span<const LatticePoint> loop,
               std::vector<BeamOutline>& outlines) {
    /// Limit of the edges tested, as the test takes quadratic time.
    constexpr std::size_t kMostTested = 4000;
    const std::size_t n = loop.size();
    std::vector<bool> crack(n, false);
    std::size_t first = n;  // after a crack
    for (std::size_t i = 0; i < n && region.vertex_count() <= kMostTested; ++i) {
        crack[i] = is_crack(region, loop[i], loop[(i + 1) % n]);
        if (crack[i]) first = (i + 1) % n;
    }
    if (first == n) {
        outlines.push_back({style, {loop.begin(), loop.end()}, true});
        return;
    }
    LatticeLoop line;
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = (first + k) % n;
        if (line.empty()) line.push_back(loop[i]);
        if (!crack[i]) {
            line.push_back(loop[(i + 1) % n]);
        } else {
            if (line.size() > 1) outlines.push_back({style, line, false});
            line.clear();
        }
    }
    if (line.size() > 1) outlines.push_back({style, std::move(line), false});
}

}  // namespace

std::vector<BeamOutline> beam_outlines(const BeamScene& scene, const BeamTree& tree) {
    std::vector<std::uint32_t> sources;
    for (const BeamFacet& facet : scene.facets) sources.push_back(facet.source);
    std::vector<BeamOutline> outlines;
    const auto add = [&](LineStyle style, std::span<const std::uint32_t> kinds) {
        for (const PolygonSet& region : Images(tree, kinds).unions()) {
            for (std::size_t i = 0; i < region.loop_count(); ++i) {
                add_lines(style, region, region.loop(i), outlines);
            }
        }
    };
    add(LineStyle::Crease, planes_of_facets(scene));
    add(LineStyle::Silhouette, sources);
    return outlines;
}

}  // namespace alhazen
