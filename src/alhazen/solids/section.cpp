#include "alhazen/solids/section.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/math/constants.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/shading/spectrum/color_matching.h"

namespace alhazen {

namespace {

constexpr int kBandRows = 16;
constexpr std::uint64_t kNoSolid = std::numeric_limits<std::uint64_t>::max();
constexpr Rgb kPaper{1, 1, 1}, kInk{0.012, 0.012, 0.012};

/// The content of one sample of a pixel.
struct Sample {
    std::uint64_t cut = kNoSolid;  ///< the solid whose cut face is seen
    Rgb color = kPaper;
};

class SectionPainter {
  public:
    SectionPainter(const SolidScene& solids, const Scene& scene, const PlaneFrame& frame,
                   const SectionView& view)
        : solids_(solids), scene_(scene), frame_(frame), view_(view) {
        if (view.camera) {
            camera_ = *view.camera;
        } else {
            look_straight_on();
        }
    }

    Image paint() {
        Image picture(view_.width, view_.height, 3);
        const std::size_t rows = static_cast<std::size_t>(view_.height);
        parallel_for(rows, kBandRows, [&](std::size_t begin, std::size_t end) {
            paint_rows(static_cast<int>(begin), static_cast<int>(end), picture);
        });
        return picture;
    }

  private:
    /// Sets a parallel camera over all bounded geometry.
    void look_straight_on() {
        const Box3 box = bounded_box();
        Interval x, y;
        for (int i = 0; i < 8; ++i) {
            const Vec3 p = box.corner(i) - frame_.origin;
            x.include(dot(p, frame_.right));
            y.include(dot(p, frame_.up));
        }
        const double aspect = static_cast<double>(view_.width) / view_.height;
        const double margin = 1.06;
        const double height = margin * std::max({y.width(), x.width() / aspect, 1e-12});
        const Vec3 middle =
            frame_.origin + 0.5 * (x.lo + x.hi) * frame_.right + 0.5 * (y.lo + y.hi) * frame_.up;
        camera_ = OrthographicCamera{middle, -frame_.normal, height * aspect * frame_.right,
                                     height * frame_.up};
    }

    /// The box of the bounded geometry; a cube around the plane's origin for an empty scene.
    [[nodiscard]] Box3 bounded_box() const {
        const PrimitiveTable& table = scene_.aggregate->primitives();
        Box3 box = scene_.aggregate->box();
        if (!box.empty() && box.bounded()) return box;
        box = {};
        for (std::size_t i = 0; i < table.size(); ++i) {
            const Box3 one = table.box(i);
            if (!one.empty() && one.bounded()) box.include(one);
        }
        if (box.empty()) box = {frame_.origin - Vec3{1, 1, 1}, frame_.origin + Vec3{1, 1, 1}};
        return box;
    }

    void paint_rows(int begin, int end, Image& picture) const {
        const int grid = view_.grid;
        const int width = view_.width * grid;
        // One more pixel right and below, because edges are found by comparing neighbours.
        const int stride = width + grid;
        const int rows = (end - begin + 1) * grid;
        std::vector<Sample> samples(static_cast<std::size_t>(stride) *
                                    static_cast<std::size_t>(rows));
        SpanList list;
        for (int j = 0; j < rows; ++j) {
            for (int i = 0; i < stride; ++i) {
                const double x = (i + 0.5) / width;
                const double y = 1 - (begin * grid + j + 0.5) / (view_.height * grid);
                samples[at(i, j, stride)] = look(eye_ray(camera_, x, y), list);
            }
        }
        for (int row = begin; row < end; ++row) {
            for (int column = 0; column < view_.width; ++column) {
                Rgb sum;
                for (int j = 0; j < grid; ++j) {
                    for (int i = 0; i < grid; ++i) {
                        sum += ink(samples, column * grid + i, (row - begin) * grid + j, stride);
                    }
                }
                float* pixel = picture.pixel(column, row);
                const double share = 1.0 / (grid * grid);
                for (int k = 0; k < 3; ++k) pixel[k] = static_cast<float>(share * sum[k]);
            }
        }
    }

    static std::size_t at(int i, int j, int stride) {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(stride) +
               static_cast<std::size_t>(i);
    }

    /// The colour of the sample, dark if another cut face begins within a pixel.
    [[nodiscard]] Rgb ink(const std::vector<Sample>& samples, int i, int j, int stride) const {
        const Sample& here = samples[at(i, j, stride)];
        const bool edge = samples[at(i + view_.grid, j, stride)].cut != here.cut ||
                          samples[at(i, j + view_.grid, stride)].cut != here.cut;
        return edge ? kInk : here.color;
    }

    /// Clips the ray to the remaining half space and returns its first hit there.
    [[nodiscard]] Sample look(Ray ray, SpanList& list) const {
        const double across = dot(frame_.normal, ray.direction);
        const double above = dot(frame_.normal, ray.origin - frame_.origin);
        const double crossing = -above / across;
        // The camera of the plane lies in it; other cameras lie in front of it or behind it.
        const bool through_plane = across < 0.0 && (above >= 0.0 || !view_.camera);
        if (through_plane) {
            ray.t_min = view_.camera ? crossing : 0.0;
        } else if (above >= 0.0) {
            return {};
        } else if (across > 0.0) {
            ray.t_max = crossing;
        }
        if (!is_valid(ray)) return {};
        if (through_plane) {
            solids_.queries().spans(ray, list);
            std::uint64_t cut = kNoSolid;
            for (const SolidSpan& span : list.spans) {
                if (span.entry.is_crossing || span.entry.t > ray.t_min) continue;
                cut = std::min(cut, static_cast<std::uint64_t>(span.solid));
            }
            if (cut != kNoSolid) {
                return {cut, color_of(scene_, material_at(ray, SolidId{cut}, list))};
            }
        }
        Hit hit;
        if (!scene_.aggregate->closest(ray, hit, nullptr)) return {};
        const Surface surface = surface_at(*scene_.aggregate, ray, hit);
        const double cosine = std::abs(dot(surface.normal, ray.direction)) / length(ray.direction);
        const Rgb color = color_of(scene_, surface.materials[0]);
        // At most half as bright as a cut face, so that cut faces stand out.
        return {kNoSolid, (0.08 + 0.42 * cosine) * color};
    }

    /// The material inside the solid at the start of the ray; for several media, the one there.
    [[nodiscard]] MaterialId material_at(Ray ray, SolidId solid, SpanList& list) const {
        ray.t_max = ray.t_min;
        ray.t_min = -kInfinity;
        solids_.queries().spans(ray, list);
        for (const SolidSpan& span : list.spans) {
            if (span.solid != solid || span.exit.is_crossing || !span.entry.is_crossing) continue;
            const Surface surface = surface_at(*scene_.aggregate, ray, span.entry.hit);
            if (surface.media.after) return *surface.media.after;
        }
        return solids_.solids().place(solid).material;
    }

    const SolidScene& solids_;
    const Scene& scene_;
    const PlaneFrame& frame_;
    const SectionView& view_;
    Camera camera_;
};

}  // namespace

Rgb color_of(const Scene& scene, MaterialId material) {
    const Material& m = scene.materials[static_cast<std::size_t>(material)];
    const MaterialSample sample = evaluate(m, scene.textures, Vec2{0.5, 0.5});
    Rgb best = sample.albedo;
    // Glass and mirrors have almost no albedo: they show their transmissive or reflective colour.
    for (const Rgb& other : {0.8 * sample.transmissive, 0.8 * sample.reflective, sample.emission}) {
        if (luminance_of(best) < 0.05 && luminance_of(other) > luminance_of(best)) best = other;
    }
    for (int i = 0; i < 3; ++i) best[i] = std::clamp(best[i], 0.0, 1.0);
    return luminance_of(best) < 0.02 ? best + Rgb{0.05, 0.05, 0.05} : best;
}

Image section_picture(const SolidScene& solids, const Scene& scene, const SectionPlane& plane,
                      const SectionView& view) {
    const PlaneFrame frame = frame_of(plane);
    check_picture_size(view.width, view.height);
    return SectionPainter(solids, scene, frame, view).paint();
}

}  // namespace alhazen
