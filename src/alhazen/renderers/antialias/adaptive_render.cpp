#include "alhazen/renderers/antialias/adaptive_render.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <optional>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/renderers/antialias/adaptive_grid.h"
#include "alhazen/renderers/antialias/answer_pool.h"
#include "alhazen/renderers/antialias/object_search.h"
#include "alhazen/renderers/antialias/picture_grid.h"
#include "alhazen/renderers/antialias/pixel_selection.h"
#include "alhazen/renderers/antialias/scene_objects.h"
#include "alhazen/renderers/antialias/search_spheres.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/reports/antialias_report.h"

namespace alhazen {

namespace {

void keep_distinct(std::vector<std::uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// Renders one film.
class AdaptiveRender {
  public:
    AdaptiveRender(const SingleRayRenderer& renderer, const RenderJob& job, Film& film)
        : job_(job),
          pool_(renderer, job),
          film_(film),
          settings_(*job.antialias),
          picture_(job.camera, film),
          grid_(film.crop().width(), film.crop().height(), settings_) {}

    RenderReport run() {
        ThreadLimit threads(job_.control.threads);
        RenderReport report;
        report.parts = 1;
        report.threads = threads.threads();
        report_.pixels = film_.crop().area();
        threads.run([&] { levels(); });
        counters_ = pool_.counters();
        report.counters = counters_;
        if (job_.stop_requested()) return report;
        write_pixels();
        write_layers();
        report.counters = counters_;
        report.done = 1;
        report.antialias = std::make_shared<AntialiasReport>(report_);
        return report;
    }

  private:
    void levels() {
        if (settings_.guarantee) collect_objects();
        bool first = true;
        do {
            trace();
            if (first && objects_) look_for_objects();
            if (job_.stop_requested()) return;
            first = false;
        } while (grid_.refine(spheres_ ? &*spheres_ : nullptr));
        report_.points.assign(grid_.points_of_levels().begin(), grid_.points_of_levels().end());
        while (report_.points.back() == 0) report_.points.pop_back();
        report_.divided.assign(grid_.divided().begin(), grid_.divided().end());
        report_.divided.resize(report_.points.size());
        if (objects_) report_objects();
    }

    void collect_objects() {
        const Stopwatch time;
        objects_.emplace(*job_.scene.aggregate);
        met_.assign(objects_->objects().size(), 0);
        report_.guarantee = true;
        report_.seconds += time.seconds();
    }

    /// Finds objects between the corner rays, which the grid must then show.
    void look_for_objects() {
        if (job_.stop_requested()) return;
        const Stopwatch time;
        spheres_.emplace(objects_->objects(), met_, picture_, settings_.behind_all);
        if (spheres_->empty()) {
            spheres_.reset();
        } else {
            std::vector<WatchedObject> around = spheres_->around(grid_);
            for (const WatchedObject& w : around) looked_for_.push_back(w.object);
            keep_distinct(looked_for_);
            report_.sought = looked_for_.size();
            search_.emplace(ObjectSearch::Where{*objects_, *spheres_, picture_, grid_}, met_,
                            around);
            search_->run(pool_, job_);
            std::erase_if(around,
                          [&](const WatchedObject& w) { return !search_->has_met(w.object); });
            grid_.look_for(around);
        }
        report_.seconds += time.seconds();
    }

    void report_objects() {
        const std::vector<SceneObject>& objects = objects_->objects();
        for (std::size_t i = 0; i < objects.size(); ++i) {
            report_.objects += objects[i].is_seen;
            report_.unbounded += objects[i].is_seen && !(objects[i].sphere.radius < kInfinity);
            report_.met += met_[i];
        }
        count_passed_over();
        if (!search_) return;
        for (const std::uint32_t pixel : search_->pixels()) {
            report_.searching += pixel != ObjectSearch::kNone;
        }
        below_depth_.assign(search_->below_depth().begin(), search_->below_depth().end());
        // Shaded rays may have hit the object elsewhere.
        std::erase_if(below_depth_, [&](const WatchedObject& w) { return met_[w.object] != 0; });
        std::vector<std::uint32_t> unmet;
        std::uint32_t before = std::numeric_limits<std::uint32_t>::max();
        for (const WatchedObject& w : below_depth_) {
            report_.below_depth_pixels += w.pixel != before;
            before = w.pixel;
            unmet.push_back(w.object);
        }
        keep_distinct(unmet);
        report_.below_depth = unmet.size();
        name_unmet();
    }
    void count_passed_over() {
        std::vector<std::uint8_t> known = met_;
        for (const std::uint32_t object : looked_for_) known[object] = 1;
        for (std::size_t i = 0; i < known.size(); ++i) {
            const SceneObject& object = objects_->objects()[i];
            report_.passed_over +=
                known[i] == 0 && object.is_seen && object.sphere.radius < kInfinity;
        }
    }

    /// Names the first objects that were not hit, each with the first pixel where it was sought.
    void name_unmet() {
        std::vector<std::uint8_t> named(met_.size(), 0);
        const PixelBox& crop = film_.crop();
        const auto width = static_cast<std::uint32_t>(crop.width());
        for (const WatchedObject& w : below_depth_) {
            if (report_.unmet.size() == AntialiasReport::kNamed) return;
            if (named[w.object] != 0) continue;
            named[w.object] = 1;
            const SceneObject& object = objects_->objects()[w.object];
            report_.unmet.push_back({object.part, object.instance,
                                     static_cast<std::uint32_t>(crop.x0) + w.pixel % width,
                                     static_cast<std::uint32_t>(crop.y0) + w.pixel / width});
        }
    }

    /// Traces the rays of the round. Rays that the search has traced are shaded from their hits.
    void trace() {
        if (!search_) {
            return trace_all(
                grid_.points().size(), [](std::size_t i) { return i; }, nullptr);
        }
        std::vector<std::uint32_t> fresh, known, rays;
        for (std::uint32_t i = 0; const GridPoint& p : grid_.points()) {
            const std::uint32_t ray = search_->ray_at(p);
            if (ray == ObjectSearch::kNone) {
                fresh.push_back(i);
            } else {
                known.push_back(i);
                rays.push_back(ray);
                search_->hand_over(ray);
            }
            ++i;
        }
        trace_all(
            fresh.size(), [&](std::size_t k) { return fresh[k]; }, nullptr);
        trace_all(
            known.size(), [&](std::size_t k) { return known[k]; }, rays.data());
    }
    /// Traces the points `index(0)` ... `index(count - 1)` of the round. `known`: their rays in the
    /// search, or null.
    template <class Index>
    void trace_all(std::size_t total, Index&& index, const std::uint32_t* known) {
        pool_.trace(total, [&](RayAnswers& answers, std::size_t first, std::size_t count,
                               RayCounters& counters) {
            std::array<Ray, RayAnswers::kRaysAtOnce> rays;
            std::array<Rgb, RayAnswers::kRaysAtOnce> shades;
            std::vector<Hit> hits(objects_ ? count : 0);
            for (std::size_t k = 0; k < count; ++k) {
                rays[k] = picture_.ray(grid_.depth(), grid_.points()[index(first + k)]);
                if (known != nullptr) hits[k] = search_->hit(known[first + k]);
            }
            const std::span<const Ray> some = std::span(rays).first(count);
            if (known != nullptr) {
                answers.shade(some, hits, std::span(shades).first(count), counters);
            } else {
                answers.trace(some, std::span(shades).first(count), hits, counters);
            }
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t i = index(first + k);
                grid_.shades()[i] = shades[k];
                counters.non_finite += !shades[k].is_finite();
                if (objects_) take_hit(i, hits[k]);
            }
        });
    }
    void take_hit(std::size_t point, const Hit& hit) {
        grid_.distances()[point] = hit.t;
        if (!hit.found()) return;
        std::atomic_ref<std::uint8_t>(met_[objects_->number_of(hit)])
            .store(1, std::memory_order_relaxed);
    }

    void write_pixels() {
        const PixelBox& crop = film_.crop();
        std::size_t k = 0;
        for (int y = crop.y0; y < crop.y1; ++y) {
            for (int x = crop.x0; x < crop.x1; ++x) film_.set(x, y, grid_.pixels()[k++]);
        }
    }

    /// Writes the layers: the cost of a pixel is that of its own rays.
    void write_layers() {
        if (job_.aovs == nullptr) return;
        AovRecorder recorder(job_, counters_);
        const PixelBox& crop = film_.crop();
        const std::vector<std::uint32_t> rays_of_pixels = count_rays();
        std::size_t k = 0;
        for (int y = crop.y0; y < crop.y1; ++y) {
            for (int x = crop.x0; x < crop.x1; ++x, ++k) {
                recorder.begin_pixel();
                const GridPoint p{x - crop.x0, y - crop.y0};
                const Vec2 places[] = {picture_.place(0, p), picture_.place(0, {p.x + 1, p.y}),
                                       picture_.place(0, {p.x, p.y + 1}),
                                       picture_.place(0, {p.x + 1, p.y + 1})};
                recorder.end_pixel(x, y, places);
                const double rays = rays_of_pixels[k];
                job_.aovs->set(AovKind::Rays, x, y, {&rays, 1});
            }
        }
        for (std::size_t i = 0, n = 0; i < below_depth_.size(); ++i) {
            const std::uint32_t pixel = below_depth_[i].pixel;
            n = i > 0 && below_depth_[i - 1].pixel == pixel ? n + 1 : 1;
            const int width = crop.width();
            job_.aovs->set_whole(AovKind::Unmet, crop.x0 + static_cast<int>(pixel) % width,
                                 crop.y0 + static_cast<int>(pixel) / width, n);
        }
    }

    /// [pixel] number of eye rays first traced for it.
    [[nodiscard]] std::vector<std::uint32_t> count_rays() const {
        const std::span<const std::uint32_t> points = grid_.points_of_pixels();
        std::vector<std::uint32_t> rays(points.begin(), points.end());
        if (!search_) return rays;
        for (const std::uint32_t pixel : search_->pixels()) {
            if (pixel != ObjectSearch::kNone) ++rays[pixel];
        }
        return rays;
    }

    const RenderJob& job_;
    AnswerPool pool_;
    Film& film_;
    const AntialiasSettings& settings_;
    PictureGrid picture_;
    AdaptiveGrid grid_;
    RayCounters counters_;
    AntialiasReport report_;
    std::optional<SceneObjects> objects_;    ///< only with the guarantee
    std::vector<std::uint8_t> met_;          ///< [object] 1 if a shaded ray hit it
    std::vector<std::uint32_t> looked_for_;  ///< objects, each once
    std::optional<SearchSpheres> spheres_;   ///< only if some object was not hit at first
    std::optional<ObjectSearch> search_;     ///< likewise
    std::vector<WatchedObject> below_depth_;
};

/// Rejects layers that are undefined for pixels with shared rays.
void check_layers(const RenderJob& job) {
    if (job.aovs == nullptr) return;
    const AovSet& wanted = job.aovs->wanted();
    if (wanted.has_tests() || wanted.has(AovKind::Time)) {
        throw Error(
            ErrorKind::Usage,
            "--antialias: pixels share their rays, so the time and the tests of a pixel are "
            "undefined; of the cost layers only --aov count.rays is available");
    }
}

}  // namespace

RenderReport render_adaptively(const SingleRayRenderer& renderer, const RenderJob& job,
                               Film& film) {
    check_layers(job);
    return AdaptiveRender(renderer, job, film).run();
}

RenderReport SingleRayRenderer::render(const RenderJob& job, Film& film) const {
    if (job.antialias == nullptr) return TiledRenderer::render(job, film);
    return job.antialias->step > 0 ? render_selected_pixels(*this, job, film)
                                   : render_adaptively(*this, job, film);
}

}  // namespace alhazen
