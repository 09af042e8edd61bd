#include "alhazen/renderers/lane_carpenter/scan_lines.h"

#include <algorithm>
#include <limits>

#include "alhazen/renderers/lane_carpenter/patch_tables.h"
#include "alhazen/renderers/lane_carpenter/polygon_table.h"
#include "alhazen/renderers/lane_carpenter/scan_polygon.h"

namespace alhazen {

class ScanLines::Impl {
  public:
    Impl(const ScanScene& scene, const ScreenView& view, const SampleGrid& grid,
         const ScanLineOptions& options)
        : scene_(scene),
          view_(view),
          grid_(grid),
          xs_(grid.xs()),
          most_nearness_(view.most_nearness()),
          with_chords_(options.cracks == Cracks::Clark),
          some_may_pass_(
              std::any_of(scene.pieces.begin(), scene.pieces.end(),
                          [&](const ScanPiece& piece) { return scene.may_pass(piece); })),
          patches_(scene, view, grid, options, false),
          quads_(grid.rows()),
          outlines_(grid.rows()) {
        report_.patches = scene.pieces.size();
        report_.flatness = options.flatness;
        report_.lines.resize(static_cast<std::size_t>(grid.rows()));
        for (std::uint32_t k = 0; k < scene.facets.size(); ++k) add_facet(k);
        const auto count = static_cast<std::size_t>(grid.columns() * grid.samples());
        nearness_.resize(count);
        owner_.resize(count);
        if (grid.several()) places_.resize(count);
        if (options.all_first) {
            for (int row = 0; row < grid.rows(); ++row) split_at(row);
        }
        split_ahead_ = options.all_first;
    }

    void next(ScanRow& row) {
        if (!split_ahead_) split_at(row_);
        quads_.enter(row_);
        outlines_.enter(row_);
        count_tables();
        begin_row(row);
        for (const std::uint32_t quad : quads_.active()) draw_quad(quads_[quad], quad, row);
        for (const std::uint32_t outline : outlines_.active()) {
            draw_outline(outlines_[outline], outline, row);
        }
        resolve(row);
        ++row_;
        quads_.leave(row_);
        outlines_.leave(row_);
    }

    [[nodiscard]] ScanLineReport& report() {
        report_.most_patches = patches_.pool().most();
        report_.most_polygons = quads_.most() + outlines_.most();
        report_.most_bytes = most_bytes_;
        return report_;
    }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu, kOutline = 0x80000000u;

    void add_facet(std::uint32_t index) {
        const ScanFacet& facet = scene_.facets[index];
        std::vector<std::vector<HomogeneousPoint>> loops;
        Vec3 point = facet.point, normal = facet.normal;
        if (facet.loops == 0) {
            const auto corners = triangle_corners(scene_.sources[facet.source], facet.part);
            loops.emplace_back();
            for (const Vec3& p : corners) {
                loops.back().push_back(view_.on_screen(homogeneous(p)));
            }
            point = corners[0];
            normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        }
        for (std::uint32_t k = 0; k < facet.loops; ++k) {
            loops.emplace_back();
            for (const HomogeneousPoint& p : scene_.loops[facet.first + k]) {
                loops.back().push_back(view_.on_screen(p));
            }
        }
        ScanOutline outline;
        if (!set_outline(view_, grid_, loops, view_.nearness_of(point, normal), outline)) return;
        outline.facet = index;
        const std::uint32_t slot = outlines_.take();
        outlines_[slot] = std::move(outline);
        outlines_.put(slot, 0);
        ++report_.facets;
    }

    void split_at(int row) {
        patches_.advance(row, report_, [&](const SubPatch& patch) {
            const std::uint32_t slot = quads_.take();
            ScanQuad& quad = quads_[slot];
            const PatchDegrees degrees = patches_.degrees(patch);
            set_quad(view_, grid_, degrees.u, degrees.v, patch, with_chords_, quad);
            // The rows of a patch are those of its control points: its corners may lie below the
            // last.
            if (quad.end_row <= row || quad.first_row >= grid_.rows() ||
                (quad.triangles[0].empty && quad.triangles[1].empty)) {
                quads_.give_back(slot);
                return;
            }
            ++report_.quads;
            quads_.put(slot, row);
            note_held();
        });
        note_held();
    }

    void note_held() {
        const std::uint64_t patches = patches_.pool().live();
        const std::uint64_t polygons = quads_.live() + outlines_.live();
        report_.most_held = std::max(report_.most_held, patches + polygons);
        most_bytes_ = std::max(
            most_bytes_, patches * patches_.pool().bytes_each() + quads_.live() * sizeof(ScanQuad));
    }

    void count_tables() {
        ScanLineTables& tables = report_.lines[static_cast<std::size_t>(row_)];
        tables.waiting = static_cast<std::uint32_t>(patches_.waiting());
        tables.active = static_cast<std::uint32_t>(split_ahead_ ? 0 : patches_.most_active());
        tables.polygons =
            static_cast<std::uint32_t>(quads_.active().size() + outlines_.active().size());
        report_.most_active = std::max<std::uint64_t>(report_.most_active, patches_.most_active());
    }

    // ---- a row of samples
    void begin_row(ScanRow& row) {
        std::fill(nearness_.begin(), nearness_.end(), -std::numeric_limits<double>::infinity());
        std::fill(owner_.begin(), owner_.end(), kNone);
        row.veils.clear();
        if (!grid_.several()) {
            y_ = grid_.y(row_);
            return;
        }
        const int samples = grid_.samples();
        for (int i = 0; i < grid_.columns(); ++i) {
            for (int s = 0; s < samples; ++s) {
                places_[static_cast<std::size_t>(i * samples + s)] = grid_.grid_at(i, row_, s);
            }
        }
    }

    /// Position of a piece or a facet in the tables; breaks ties of depth.
    [[nodiscard]] std::uint32_t rank(std::uint32_t owner) {
        return (owner & kOutline) != 0 ? outlines_[owner & ~kOutline].facet | kOutline
                                       : quads_[owner >> 1].piece;
    }
    /// True if a surface replaces `owner` at a sample of equal depth.
    [[nodiscard]] bool wins_tie(std::uint32_t surface, std::uint32_t owner) {
        return owner == kNone || rank(surface) < rank(owner);
    }

    void see(std::uint32_t sample, double nearness, std::uint32_t owner) {
        double& nearest = nearness_[sample];
        if (nearness < nearest || nearness > most_nearness_) return;
        if (nearness == nearest && !wins_tie(owner, owner_[sample])) return;
        nearest = nearness;
        owner_[sample] = owner;
    }

    /// As `see` for the columns of a triangle.
    void see_columns(const IndexRange& columns, const ScanTriangle& triangle, double at_row,
                     std::uint32_t owner) {
        double* const nearest = nearness_.data();
        std::uint32_t* const owners = owner_.data();
        const double gx = triangle.nearness.gx, least = triangle.least, most = triangle.most;
        for (int i = columns.begin; i < columns.end; ++i) {
            double nearness = gx * xs_[i] + at_row;
            nearness = nearness < least ? least : nearness > most ? most : nearness;
            if (nearness < nearest[i] || nearness > most_nearness_) continue;
            if (nearness == nearest[i] && !wins_tie(owner, owners[i])) continue;
            nearest[i] = nearness;
            owners[i] = owner;
        }
    }

    void draw_quad(const ScanQuad& quad, std::uint32_t slot, ScanRow& row) {
        const bool veil = some_may_pass_ && scene_.may_pass(scene_.pieces[quad.piece]);
        if (grid_.several()) return draw_quad_samples(quad, slot, veil, row);
        // Plain arrays, for speed of this innermost loop.
        int first[5];
        const EdgeLine* const edges = quad.lines.data();
        for (std::size_t k = 0; k < 5; ++k) first[k] = edges[k].first_right(grid_, y_);
        for (std::size_t t = 0; t < 2; ++t) {
            const ScanTriangle& triangle = quad.triangles[t];
            if (triangle.empty) continue;
            const std::uint8_t* const sides = triangle.lines.data();
            const bool* const right = triangle.inner_right.data();
            int begin = 0, end = grid_.columns();
            for (std::size_t k = 0; k < 3; ++k) {
                const int column = first[sides[k]];
                begin = right[k] && column > begin ? column : begin;
                end = !right[k] && column < end ? column : end;
            }
            if (begin >= end) continue;
            const double at_row = triangle.nearness.gy * y_ + triangle.nearness.at_origin;
            if (!veil) {
                see_columns({begin, end}, triangle, at_row,
                            slot << 1 | static_cast<std::uint32_t>(t));
                continue;
            }
            for (int i = begin; i < end; ++i) {
                const double nearness = triangle.nearness.gx * xs_[i] + at_row;
                meet(static_cast<std::uint32_t>(i),
                     std::clamp(nearness, triangle.least, triangle.most), slot, t, true, row);
            }
        }
    }

    void meet(std::uint32_t sample, double nearness, std::uint32_t quad, std::size_t triangle,
              bool veil, ScanRow& row) {
        if (!veil) return see(sample, nearness, quad << 1 | static_cast<std::uint32_t>(triangle));
        if (nearness > most_nearness_) return;
        const FixedPoint at = place(sample);
        const Vec2 uv = quads_[quad].parameters_at(triangle, at.x, at.y);
        row.veils.push_back({sample, {quads_[quad].piece, nearness, uv.x, uv.y}});
    }

    [[nodiscard]] FixedPoint place(std::uint32_t sample) const {
        return grid_.several() ? places_[sample]
                               : FixedPoint{grid_.x(static_cast<int>(sample)), y_};
    }

    /// The samples of the pixels that a polygon may cover.
    template <class Corners>
    [[nodiscard]] IndexRange samples_of(const Corners& xs) const {
        const double pixel = 1.0 / view_.grid_per_pixel();
        const IndexRange columns = grid_.columns_in(xs.first * pixel, xs.second * pixel);
        return {columns.begin * grid_.samples(), columns.end * grid_.samples()};
    }

    void draw_quad_samples(const ScanQuad& quad, std::uint32_t slot, bool veil, ScanRow& row) {
        std::pair<double, double> xs{quad.corners[0].at.x, quad.corners[0].at.x};
        for (const auto& corner : quad.corners) {
            xs.first = std::min(xs.first, double(corner.at.x));
            xs.second = std::max(xs.second, double(corner.at.x));
        }
        const IndexRange range = samples_of(xs);
        for (int i = range.begin; i < range.end; ++i) {
            const FixedPoint& at = places_[static_cast<std::size_t>(i)];
            for (std::size_t t = 0; t < 2; ++t) {
                const ScanTriangle& triangle = quad.triangles[t];
                bool inside = !triangle.empty;
                for (std::size_t k = 0; k < 3 && inside; ++k) {
                    inside = quad.lines[triangle.lines[k]].is_right(at.x, at.y) ==
                             triangle.inner_right[k];
                }
                if (!inside) continue;
                const double nearness = triangle.nearness.gx * at.x + triangle.nearness.gy * at.y +
                                        triangle.nearness.at_origin;
                meet(static_cast<std::uint32_t>(i),
                     std::clamp(nearness, triangle.least, triangle.most), slot, t, veil, row);
            }
        }
    }

    void draw_outline(const ScanOutline& outline, std::uint32_t slot, ScanRow& row) {
        const bool veil = scene_.sources[scene_.facets[outline.facet].source].may_pass;
        const auto meet_at = [&](int sample, const FixedPoint& at) {
            const double nearness = outline.nearness.gx * at.x + outline.nearness.gy * at.y +
                                    outline.nearness.at_origin;
            const auto k = static_cast<std::uint32_t>(sample);
            if (!veil) return see(k, nearness, slot | kOutline);
            if (nearness > most_nearness_) return;
            row.veils.push_back({k, {outline.facet | ScanSample::kFacet, nearness, 0, 0}});
        };
        if (!grid_.several()) {
            crossings_.clear();
            for (const EdgeLine& line : outline.lines) {
                if (line.y0 < y_ && y_ <= line.y0 + line.dy) {
                    crossings_.push_back(line.first_right(grid_, y_));
                }
            }
            std::sort(crossings_.begin(), crossings_.end());
            for (std::size_t k = 0; k + 1 < crossings_.size(); k += 2) {
                for (int i = crossings_[k]; i < crossings_[k + 1]; ++i) {
                    meet_at(i, {grid_.x(i), y_});
                }
            }
            return;
        }
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const FixedPoint& at = places_[i];
            bool inside = false;
            for (const EdgeLine& line : outline.lines) {
                if (line.y0 < at.y && at.y <= line.y0 + line.dy) {
                    inside = inside != line.is_right(at.x, at.y);
                }
            }
            if (inside) meet_at(static_cast<int>(i), at);
        }
    }

    void resolve(ScanRow& row) {
        row.samples.resize(owner_.size());
        for (std::uint32_t k = 0; k < owner_.size(); ++k) {
            ScanSample& sample = row.samples[k];
            const std::uint32_t owner = owner_[k];
            sample.item = ScanSample::kNothing;
            if (owner == kNone) continue;
            sample.nearness = nearness_[k];
            if ((owner & kOutline) != 0) {
                sample.item = outlines_[owner & ~kOutline].facet | ScanSample::kFacet;
                continue;
            }
            const ScanQuad& quad = quads_[owner >> 1];
            const FixedPoint at = place(k);
            const Vec2 uv = quad.parameters_at(owner & 1u, at.x, at.y);
            sample.item = quad.piece;
            sample.u = uv.x;
            sample.v = uv.y;
        }
        if (row.veils.empty()) return;
        std::erase_if(row.veils, [&](const ScanVeil& veil) {
            return owner_[veil.sample] != kNone && veil.seen.nearness < nearness_[veil.sample];
        });
        std::sort(row.veils.begin(), row.veils.end(), [](const ScanVeil& a, const ScanVeil& b) {
            if (a.sample != b.sample) return a.sample < b.sample;
            if (a.seen.nearness != b.seen.nearness) return a.seen.nearness > b.seen.nearness;
            return a.seen.item < b.seen.item;
        });
    }

    const ScanScene& scene_;
    ScreenView view_;
    const SampleGrid& grid_;
    const std::int32_t* xs_;  ///< x of the grid's columns
    double most_nearness_;    ///< largest nearness in front of the eye
    bool with_chords_, some_may_pass_;
    bool split_ahead_ = false;
    PatchTables patches_;
    PolygonTable<ScanQuad> quads_;
    PolygonTable<ScanOutline> outlines_;
    int row_ = 0;
    std::int32_t y_ = 0;
    std::vector<double> nearness_;      ///< [sample] of the nearest surface so far
    std::vector<std::uint32_t> owner_;  ///< [sample] 2 * quad + triangle, or an outline
    std::vector<FixedPoint> places_;    ///< [sample], with several samples per pixel
    std::vector<int> crossings_;
    std::uint64_t most_bytes_ = 0;
    ScanLineReport report_;
};

ScanLines::ScanLines(const ScanScene& scene, const ScreenView& view, const SampleGrid& grid,
                     const ScanLineOptions& options)
    : impl_(std::make_unique<Impl>(scene, view, grid, options)) {}
ScanLines::~ScanLines() = default;
void ScanLines::next(ScanRow& row) {
    impl_->next(row);
}
ScanLineReport& ScanLines::report() {
    return impl_->report();
}

}  // namespace alhazen
