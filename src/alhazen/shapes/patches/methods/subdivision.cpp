/// `subdivision`: boxes around parts of a patch, halved down to the size of a pixel.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, section
/// "Object representation and hidden surface elimination"; Rubin and Whitted, "A 3-Dimensional
/// Representation for Fast Rendering of Complex Scenes", SIGGRAPH 1980 (boxes).
/// Differs: boxes in place of spheres; every crossing is reported, hence parts that touch in the
/// parameters are merged to one crossing, at the part whose middle is nearest to the line. A pixel
/// is 2^-10 of the model's box.
/// Conventions: the error of t is some pixels, more at grazing incidence; crossings within a pixel
/// are merged, and a line that passes a silhouette within a pixel has one.
/// Complexity: O(log(1 / pixel)) boxes for a crossing, O(1 / pixel) along a tangent.

#include <cstdlib>
#include <numeric>

#include "alhazen/shapes/patches/methods/each_patch.h"

namespace alhazen {
namespace {

constexpr double kPixel = 0x1p-10;
constexpr int kDeepestSplit = 20;

struct SplitPart {
    BezierNet net;
    int u = 0, v = 0, level = 0;  // [u, u + 1] / 2^level
};

/// A part as small as a pixel, in units of 2^-kDeepestSplit.
struct PixelPart {
    long u0, u1, v0, v1;
    double distance;  // of its middle from the line

    [[nodiscard]] bool touches(const PixelPart& o) const {
        return u0 <= o.u1 && o.u0 <= u1 && v0 <= o.v1 && o.v0 <= v1;
    }
};

class Subdivision final : public EachPatchMethod {
  public:
    using EachPatchMethod::EachPatchMethod;

  private:
    void meet(const BezierNet& net, std::uint32_t patch, PatchQuestion& question) override {
        const double pixel = kPixel * max_component(box().size());
        std::vector<PixelPart> small;
        std::vector<SplitPart> waiting{{net}};
        while (!waiting.empty()) {
            const SplitPart part = std::move(waiting.back());
            waiting.pop_back();
            const Box3 around = control_box(part.net);
            ++question.counts.steps;
            if (!line_meets(around, 0.0, question.ray)) continue;
            if (max_component(around.size()) <= pixel || part.level == kDeepestSplit) {
                small.push_back(pixel_part(part, around, question));
                continue;
            }
            ++question.counts.subdivisions;
            const auto [low, high] = halved_u(part.net);
            for (int a = 0; a < 2; ++a) {
                const auto [first, second] = halved_v(a == 0 ? low : high);
                const int level = part.level + 1, u = 2 * part.u + a, v = 2 * part.v;
                waiting.push_back({first, u, v, level});
                waiting.push_back({second, u, v + 1, level});
            }
        }
        report_groups(small, net, patch, question);
    }

    static PixelPart pixel_part(const SplitPart& part, const Box3& around,
                                const PatchQuestion& question) {
        const int shift = kDeepestSplit - part.level;
        const long u = static_cast<long>(part.u) << shift, v = static_cast<long>(part.v) << shift;
        const Vec3 offset = around.center() - question.line.origin;
        return {u, u + (1L << shift), v, v + (1L << shift),
                length(cross(offset, question.line.direction))};
    }

    static void report_groups(const std::vector<PixelPart>& small, const BezierNet& net,
                              std::uint32_t patch, PatchQuestion& question) {
        std::vector<std::size_t> group(small.size());
        std::iota(group.begin(), group.end(), std::size_t{0});
        const auto root = [&](std::size_t k) {
            while (group[k] != k) k = group[k] = group[group[k]];
            return k;
        };
        for (std::size_t a = 0; a < small.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                if (small[a].touches(small[b])) group[root(a)] = root(b);
            }
        }
        for (std::size_t k = 0; k < small.size(); ++k) {
            if (root(k) != k) continue;
            std::size_t best = k;
            for (std::size_t other = 0; other < small.size(); ++other) {
                if (root(other) == k && small[other].distance < small[best].distance) best = other;
            }
            constexpr double kUnit = 1.0 / (1L << kDeepestSplit);
            const PixelPart& part = small[best];
            question.report(net, patch, 0.5 * kUnit * static_cast<double>(part.u0 + part.u1),
                            0.5 * kUnit * static_cast<double>(part.v0 + part.v1));
        }
    }
};

}  // namespace

std::unique_ptr<PatchMethod> make_subdivision(std::span<const BezierNet> nets) {
    return std::make_unique<Subdivision>(nets);
}

}  // namespace alhazen
