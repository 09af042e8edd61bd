#include "alhazen/renderers/antialias/pixel_selection.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/antialias/answer_pool.h"
#include "alhazen/renderers/core/antialias_settings.h"
#include "alhazen/renderers/core/samplers.h"

namespace alhazen {

namespace {

/// Pixels x0 to x1 by y0 to y1 of the crop, inclusive; the corners have rays.
struct SelectionCell {
    int x0, y0, x1, y1;
    std::uint32_t place = 0;  ///< index in the grid of the initial cells
    bool agreed = false;      ///< agreed with all rays of the last round

    /// True if all of its pixels are corners: there is nothing to divide or fill.
    [[nodiscard]] bool is_done() const { return x1 - x0 <= 1 && y1 - y0 <= 1; }
};

/// Identifies the part that a ray hits first, and the part that placed it in the scene.
std::uint64_t thing_of(const Scene& scene, const Hit& hit) {
    if (!hit.found()) return 0;
    const HitParts parts = parts_of(*scene.aggregate, hit);
    return (std::uint64_t{parts.instance} << 32) + parts.part + 1;
}

double shown(double channel) {
    return channel > 0.0 ? (channel < 1.0 ? channel : 1.0) : 0.0;
}
bool differ(const Rgb& a, const Rgb& b, double threshold) {
    return std::abs(shown(a.r) - shown(b.r)) > threshold ||
           std::abs(shown(a.g) - shown(b.g)) > threshold ||
           std::abs(shown(a.b) - shown(b.b)) > threshold;
}
/// Linear interpolation from a to b.
Rgb mean(double u, const Rgb& a, const Rgb& b) {
    return (1 - u) * a + u * b;
}
/// Position of `i` between the ends of a side, 0 to 1.
double part(int i, int first, int last) {
    return last > first ? double(i - first) / (last - first) : 0.0;
}

/// The round in which a pixel was traced, from 1; or one of these.
using PixelRound = std::uint32_t;
constexpr std::size_t kCellsAtOnce = 256;
constexpr PixelRound kNoRay = 0, kAskedFor = std::numeric_limits<PixelRound>::max();

/// Renders one film.
class PixelSelection {
  public:
    PixelSelection(const SingleRayRenderer& renderer, const RenderJob& job, Film& film)
        : job_(job),
          film_(film),
          settings_(*job.antialias),
          sampler_(job, film.frame_width(), film.frame_height()),
          eye_(job.camera),
          pool_(renderer, job),
          width_(film.crop().width()),
          height_(film.crop().height()),
          shades_(film.from(film.crop().x0, film.crop().y0), film.crop().area()),
          things_(std::make_unique_for_overwrite<std::uint64_t[]>(film.crop().area())),
          rounds_(film.crop().area(), kNoRay) {}

    RenderReport run() {
        RenderReport report;
        report.parts = 1;
        ThreadLimit threads(job_.control.threads);
        report.threads = threads.threads();
        threads.run([&] {
            select();
            if (job_.stop_requested()) return;
            parallel_for(cells_.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) fill(cells_[i]);
            });
        });
        report.counters = pool_.counters();
        if (job_.stop_requested()) return report;
        report.done = 1;
        return report;
    }

  private:
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    /// Borders of cells along an axis: multiples of the step in the frame.
    [[nodiscard]] std::vector<int> marks(int first, int count) const {
        std::vector<int> result{0};
        const int step = settings_.step;
        for (int k = step - first % step; k < count; k += step) result.push_back(k);
        if (result.back() != count - 1) result.push_back(count - 1);
        if (result.size() == 1) result.push_back(result.front());
        return result;
    }

    void select() {
        const PixelBox& crop = film_.crop();
        const std::vector<int> columns = marks(crop.x0, width_), rows = marks(crop.y0, height_);
        across_ = columns.size() - 1;
        changed_.assign(across_ * (rows.size() - 1), kNoRay);
        for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
            for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
                const std::size_t place = j * across_ + i;
                const SelectionCell c{columns[i], rows[j], columns[i + 1], rows[j + 1],
                                      static_cast<std::uint32_t>(place)};
                for (const int y : {c.y0, c.y1}) {
                    for (const int x : {c.x0, c.x1}) ask(x, y);
                }
                add(c);
            }
        }
        do {
            trace();
            if (job_.stop_requested()) return;
        } while (divide());
    }

    void ask(int x, int y) {
        PixelRound& known = rounds_[at(x, y)];
        if (known != kNoRay) return;
        asked_.push_back(static_cast<std::uint32_t>(at(x, y)));
        known = kAskedFor;
    }
    void add(const SelectionCell& c) {
        if (!c.is_done()) cells_.push_back(c);
    }

    /// Divides cells that do not agree with their rays. False if there are none.
    bool divide() {
        parallel_for(cells_.size(), kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) cells_[i].agreed = agrees(cells_[i]);
        });
        std::swap(cells_, before_);
        cells_.clear();
        cells_.reserve(2 * before_.size());
        bool any = false;
        for (const SelectionCell& c : before_) {
            if (c.agreed) {
                cells_.push_back(c);
                continue;
            }
            any = true;
            mark_changed(c.place);
            const bool wide = c.x1 - c.x0 > 1, high = c.y1 - c.y0 > 1;
            const int xm = wide ? (c.x0 + c.x1) / 2 : c.x1, ym = high ? (c.y0 + c.y1) / 2 : c.y1;
            if (wide) ask(xm, c.y0);
            if (high) ask(c.x0, ym);
            if (wide && high) ask(xm, ym);
            if (high) ask(c.x1, ym);
            if (wide) ask(xm, c.y1);
            add({c.x0, c.y0, xm, ym, c.place});
            if (wide) add({xm, c.y0, c.x1, ym, c.place});
            if (high) add({c.x0, ym, xm, c.y1, c.place});
            if (wide && high) add({xm, ym, c.x1, c.y1, c.place});
        }
        return any;
    }

    /// Records that the next round has rays in an initial cell, or on its sides.
    void mark_changed(std::size_t place) {
        const PixelRound next = round_ + 1;
        const std::size_t column = place % across_;
        changed_[place] = next;
        if (column > 0) changed_[place - 1] = next;
        if (column + 1 < across_) changed_[place + 1] = next;
        if (place >= across_) changed_[place - across_] = next;
        if (place + across_ < changed_.size()) changed_[place + across_] = next;
    }

    [[nodiscard]] bool agrees(const SelectionCell& c) const {
        if (c.agreed && changed_[c.place] != round_) return true;
        return (c.agreed || corners_agree(c)) && sides_agree(c);
    }
    [[nodiscard]] bool corners_agree(const SelectionCell& c) const {
        const std::size_t corners[] = {at(c.x0, c.y0), at(c.x1, c.y0), at(c.x0, c.y1),
                                       at(c.x1, c.y1)};
        for (std::size_t i = 1; i < 4; ++i) {
            if (things_[corners[i]] != things_[corners[0]]) return false;
            for (std::size_t j = 0; j < i; ++j) {
                if (differ(shades_[corners[i]], shades_[corners[j]], settings_.threshold)) {
                    return false;
                }
            }
        }
        return true;
    }
    /// True if the cell agrees with the rays on its sides. Only rays of the last round are tested
    /// if the cell has agreed before.
    [[nodiscard]] bool sides_agree(const SelectionCell& c) const {
        const PixelRound* const rounds = rounds_.data();
        const std::size_t first = at(c.x0, c.y0);
        const std::size_t corners[] = {first, at(c.x1, c.y0), at(c.x0, c.y1), at(c.x1, c.y1)};
        const auto agrees_at = [&](std::size_t k, double u, std::size_t a, std::size_t b) {
            return things_[k] == things_[first] &&
                   !differ(shades_[k], mean(u, shades_[a], shades_[b]), settings_.threshold);
        };
        const auto counts = [&](std::size_t k) {
            return c.agreed ? rounds[k] == round_ : rounds[k] != kNoRay;
        };
        for (const std::size_t side : {0, 2}) {
            for (int x = c.x0 + 1; x < c.x1; ++x) {
                const std::size_t k = corners[side] + static_cast<std::size_t>(x - c.x0);
                if (!counts(k)) continue;
                if (!agrees_at(k, part(x, c.x0, c.x1), corners[side], corners[side + 1])) {
                    return false;
                }
            }
        }
        for (const std::size_t side : {0, 1}) {
            std::size_t k = corners[side];
            for (int y = c.y0 + 1; y < c.y1; ++y) {
                k += static_cast<std::size_t>(width_);
                if (!counts(k)) continue;
                if (!agrees_at(k, part(y, c.y0, c.y1), corners[side], corners[side + 2])) {
                    return false;
                }
            }
        }
        return true;
    }

    /// Sets the pixels of a cell without rays to the bilinear mean of its corners; its last column
    /// and row belong to its neighbours, if any.
    void fill(const SelectionCell& c) {
        std::array<Rgb, AntialiasSettings::kLargestStep + 1> upper, lower;
        const int x_end = c.x1 + (c.x1 == width_ - 1), y_end = c.y1 + (c.y1 == height_ - 1);
        for (int x = c.x0; x < x_end; ++x) {
            const double u = part(x, c.x0, c.x1);
            const auto i = static_cast<std::size_t>(x - c.x0);
            upper[i] = mean(u, shades_[at(c.x0, c.y0)], shades_[at(c.x1, c.y0)]);
            lower[i] = mean(u, shades_[at(c.x0, c.y1)], shades_[at(c.x1, c.y1)]);
        }
        for (int y = c.y0; y < y_end; ++y) {
            const double v = part(y, c.y0, c.y1);
            for (int x = c.x0; x < x_end; ++x) {
                const auto i = static_cast<std::size_t>(x - c.x0);
                if (rounds_[at(x, y)] == kNoRay) shades_[at(x, y)] = mean(v, upper[i], lower[i]);
            }
        }
    }

    /// Traces the requested rays.
    void trace() {
        ++round_;
        pool_.trace(asked_.size(), [&](RayAnswers& answers, std::size_t first, std::size_t count,
                                       RayCounters& counters) {
            std::array<Ray, RayAnswers::kRaysAtOnce> rays;
            std::array<Rgb, RayAnswers::kRaysAtOnce> shades;
            std::array<Hit, RayAnswers::kRaysAtOnce> hits;
            const std::span asked = std::span(asked_).subspan(first, count);
            for (std::size_t k = 0; k < count; ++k) rays[k] = ray(asked[k]);
            answers.trace(std::span(rays).first(count), std::span(shades).first(count),
                          std::span(hits).first(count), counters);
            for (std::size_t k = 0; k < count; ++k) {
                const bool finite = shades[k].is_finite();
                counters.non_finite += !finite;
                shades_[asked[k]] = finite ? shades[k] : Rgb{};
                things_[asked[k]] = thing_of(job_.scene, hits[k]);
                rounds_[asked[k]] = round_;
            }
        });
        asked_.clear();
    }
    [[nodiscard]] Ray ray(std::uint32_t pixel) const {
        const int x = film_.crop().x0 + static_cast<int>(pixel) % width_;
        const int y = film_.crop().y0 + static_cast<int>(pixel) / width_;
        const Vec2 place = sampler_.at(x, y);
        return eye_.ray(eye_.column(place.x) + eye_.row(place.y));
    }

    const RenderJob& job_;
    Film& film_;
    const AntialiasSettings& settings_;
    PointSampler sampler_;
    EyeRays eye_;
    AnswerPool pool_;
    int width_, height_;
    std::span<Rgb> shades_;  ///< [pixel of the crop] the film; pixels without a ray are set last
    std::unique_ptr<std::uint64_t[]> things_;  ///< [pixel of the crop] with a ray
    PixelRound round_ = 0;                     ///< the last round
    std::vector<PixelRound> rounds_;           ///< [pixel of the crop]
    std::vector<std::uint32_t> asked_;         ///< pixels of the next round
    std::size_t across_ = 0;                   ///< initial cells in a row
    std::vector<PixelRound> changed_;  ///< [initial cell] the last round with rays in or next to it
    std::vector<SelectionCell> cells_;   ///< not done
    std::vector<SelectionCell> before_;  ///< cells of the previous round, during division
};

}  // namespace

RenderReport render_selected_pixels(const SingleRayRenderer& renderer, const RenderJob& job,
                                    Film& film) {
    if (job.aovs != nullptr) {
        throw Error(ErrorKind::Usage,
                    "--antialias pixel_selection: layers require a ray in every pixel");
    }
    return PixelSelection(renderer, job, film).run();
}

}  // namespace alhazen
