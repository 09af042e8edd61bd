#include "alhazen/laboratory/traversal_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "alhazen/base/error.h"
#include "alhazen/geometry/polygon/convex_outline.h"
#include "alhazen/imaging/svg/svg_writer.h"
#include "alhazen/primitives/bounded_primitives.h"

namespace alhazen {
namespace {

using StepKind = TraversalStep::Kind;

constexpr double kWidth = 900, kEdge = 24, kLegend = 64;
/// Limit above which only the tested primitives are drawn.
constexpr std::size_t kMostDrawn = 5000;

/// The projection from the world to the picture.
class Projection {
  public:
    Projection(FigureView view, const Box3& box) {
        switch (view) {
            case FigureView::AlongX:
                right_ = {0, 1, 0};
                up_ = {0, 0, 1};
                break;
            case FigureView::AlongY:
                right_ = {1, 0, 0};
                up_ = {0, 0, 1};
                break;
            case FigureView::AlongZ:
                right_ = {1, 0, 0};
                up_ = {0, 1, 0};
                break;
            case FigureView::Isometric:
                right_ = Vec3{1, -1, 0} / std::sqrt(2.0);
                up_ = Vec3{-1, -1, 2} / std::sqrt(6.0);
                break;
        }
        Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
        for (int i = 0; i < 8; ++i) {
            const Vec2 p = flat(box.corner(i));
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
            hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
        }
        const double wide = std::max(hi.x - lo.x, 1e-300), high = std::max(hi.y - lo.y, 0.0);
        scale_ = (kWidth - 2 * kEdge) / std::max(wide, high);
        left_ = 0.5 * (kWidth - scale_ * wide) - scale_ * lo.x;
        top_ = kEdge + kLegend + scale_ * hi.y;
        height_ = 2 * kEdge + kLegend + scale_ * high;
    }

    [[nodiscard]] Vec2 operator()(const Vec3& p) const {
        const Vec2 q = flat(p);
        return {left_ + scale_ * q.x, top_ - scale_ * q.y};
    }
    [[nodiscard]] double scale() const { return scale_; }
    [[nodiscard]] double height() const { return height_; }

  private:
    [[nodiscard]] Vec2 flat(const Vec3& p) const { return {dot(right_, p), dot(up_, p)}; }

    Vec3 right_, up_;
    double scale_ = 1, left_ = 0, top_ = 0, height_ = 0;
};

void draw_polygon(svg::Writer& out, const Projection& project, const std::vector<Vec3>& corners,
                  const std::string& style) {
    std::vector<Vec2> points;
    for (const Vec3& p : corners) points.push_back(project(p));
    out.leaf("polygon",
             {{"class", style}, {"points", svg::points(convex_outline(std::move(points)))}});
}

/// The index of spheres among the kinds of shapes.
std::uint32_t sphere_kind() {
    return []<class... Columns>(const std::tuple<Columns...>*) {
        std::uint32_t at = 0, found = 0;
        ((std::is_same_v<Columns, ShapeColumn<Sphere>> ? found = at++ : at++), ...);
        return found;
    }(static_cast<const AnalyticShapes::Columns<ShapeColumn>*>(nullptr));
}

/// Draws a sphere as a circle, a triangle as such, other primitives as their boxes.
void draw_primitive(svg::Writer& out, const Projection& project, const PrimitiveTable& table,
                    PrimitiveId id, const std::string& style) {
    const std::uint32_t kind = table.kind(id);
    if (kind == sphere_kind() && table.placement_of(id) == nullptr) {
        const Sphere& sphere = std::get<ShapeColumn<Sphere>>(table.columns).shapes[table.index(id)];
        const Vec2 c = project(sphere.center);
        out.leaf("circle", {{"class", style},
                            {"cx", svg::decimals(c.x, 2)},
                            {"cy", svg::decimals(c.y, 2)},
                            {"r", svg::decimals(project.scale() * sphere.radius, 2)}});
        return;
    }
    std::vector<Vec3> corners;
    if (kind == kTriangleKind) {
        for (const Vec3& p : table.triangle_vertices(table.index(id))) corners.push_back(p);
    } else {
        const Box3 box = table.box(static_cast<std::size_t>(id));
        for (int i = 0; i < 8; ++i) corners.push_back(box.corner(i));
    }
    draw_polygon(out, project, corners, style);
}

constexpr const char* kStyle = R"css(
svg{--ground:#fff;--ink:#1d2330;--soft:#8b93a3;--cell:#0b63a8;--test:#c77d1c;--hit:#b3261e;background:var(--ground)}
@media(prefers-color-scheme:dark){svg{--ground:#12151c;--ink:#e8eaf0;--soft:#6d7789;--cell:#7cc0ff;--test:#e0a84a;--hit:#ff8a80}}
text{font-family:system-ui,sans-serif;fill:var(--ink)}
.thing{fill:var(--soft);fill-opacity:.15;stroke:var(--soft)}
.tested{fill:var(--test);fill-opacity:.45;stroke:var(--test);stroke-width:1.5}
.hit{fill:var(--hit);fill-opacity:.55;stroke:var(--hit);stroke-width:2}
.cell{fill:var(--cell);fill-opacity:.1;stroke:var(--cell);stroke-width:1.2}
.bound{fill:none;stroke:var(--cell);stroke-width:1.4}
.beam{fill:var(--cell);fill-opacity:.07;stroke:var(--cell);stroke-dasharray:9 4}
.missed{fill:none;stroke:var(--cell);stroke-width:1;stroke-dasharray:5 4;stroke-opacity:.65}
.ray{stroke:var(--ink);stroke-width:2.2}
.ray.behind{stroke-width:1;stroke-dasharray:2 5}
.number{text-anchor:middle;dominant-baseline:central;fill:var(--cell);font-weight:600}
)css";

class Figure {
  public:
    Figure(const Scene& scene, const TraversalTrace& trace, FigureView view)
        : table_(scene.aggregate->primitives()),
          trace_(trace),
          box_(picture_box(table_, trace)),
          project_(view, box_) {}

    std::string text() {
        out_.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                          {"viewBox", fmt::format("0 0 {:.0f} {:.0f}", kWidth, project_.height())},
                          {"role", "img"},
                          {"aria-label", summary()}});
        out_.raw(fmt::format("<style>{}</style>\n", kStyle));
        out_.raw(
            "<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" "
            "markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" "
            "fill=\"var(--ink)\"/></marker></defs>\n");
        draw_legend();
        draw_primitives();
        draw_regions();
        draw_ray();
        draw_numbers();
        return out_.finish();
    }

  private:
    /// The box of the picture: all bounded primitives and the origin of the ray.
    static Box3 picture_box(const PrimitiveTable& table, const TraversalTrace& trace) {
        const BoundedPrimitives bounded(table);
        Box3 box;
        for (std::size_t i = 0; i < bounded.size(); ++i) box.include(bounded.box(i));
        if (box.empty()) box.include(trace.ray.origin);
        const Vec3 reach = 0.5 * box.size() + Vec3{1e-9, 1e-9, 1e-9};
        const Vec3 out = abs(trace.ray.origin - box.center());
        // For a distant eye only the last part of the ray is drawn.
        if (out.x < 2 * reach.x && out.y < 2 * reach.y && out.z < 2 * reach.z) {
            box.include(trace.ray.origin);
        }
        return box;
    }

    [[nodiscard]] std::size_t count(StepKind kind) const {
        return static_cast<std::size_t>(
            std::count_if(trace_.steps.begin(), trace_.steps.end(),
                          [&](const TraversalStep& step) { return step.kind == kind; }));
    }
    [[nodiscard]] std::string summary() const {
        std::string text = trace_.accelerator + ":";
        const std::size_t cells = count(StepKind::Cell);
        if (count(StepKind::Beam) > 0) {
            text += " one class of rays,";
        } else if (cells > 0) {
            text += fmt::format(" {} cells visited,", cells);
        }
        if (count(StepKind::Bound) > 0)
            text += fmt::format(" {} bounds tested,", count(StepKind::Bound));
        return text + fmt::format(" {} of {} primitives tested", count(StepKind::Primitive),
                                  table_.size());
    }

    void draw_legend() {
        out_.text("text", {{"x", svg::decimals(kEdge, 0)}, {"y", "30"}, {"font-size", "19"}},
                  summary());
        double x = kEdge;
        const auto key = [&](const char* style, const char* what) {
            out_.leaf("rect", {{"class", style},
                               {"x", svg::decimals(x, 0)},
                               {"y", "47"},
                               {"width", "22"},
                               {"height", "13"}});
            out_.text("text", {{"x", svg::decimals(x + 29, 0)}, {"y", "59"}, {"font-size", "14"}},
                      what);
            x += 55 + 7.4 * static_cast<double>(std::string_view(what).size());
        };
        if (count(StepKind::Beam) > 0) {
            key("cell", "where the rays of the class come from");
            key("beam", "their beam");
        } else if (count(StepKind::Cell) > 0) {
            key("cell", "cell visited, by number");
        }
        if (count(StepKind::Bound) > 0) {
            key("bound", "bound that the ray meets");
            key("missed", "bound that it misses");
        }
        key("tested", "tested, not the answer");
        if (trace_.hit.found()) key("hit", "the answer");
    }

    void draw_primitives() {
        std::set<std::uint32_t> tested;
        for (const TraversalStep& step : trace_.steps) {
            if (step.kind == StepKind::Primitive) tested.insert(step.number);
        }
        const bool all = table_.size() <= kMostDrawn;
        for (std::uint32_t i = 0; i < table_.size(); ++i) {
            const Box3 box = table_.box(i);
            if (box.empty() || !box.bounded()) continue;
            const bool is_tested = tested.count(i) > 0;
            if (!all && !is_tested) continue;
            const bool is_hit = trace_.hit.found() && trace_.hit.top() == PrimitiveId{i};
            draw_primitive(out_, project_, table_, PrimitiveId{i},
                           is_hit      ? "hit"
                           : is_tested ? "tested"
                                       : "thing");
        }
    }

    /// Draws each cell once, however often it is visited.
    void draw_regions() {
        for (const TraversalStep& step : trace_.steps) {
            if (step.corners.empty()) continue;
            draw_polygon(out_, project_, step.corners,
                         step.kind == StepKind::Cell   ? "cell"
                         : step.kind == StepKind::Beam ? "beam"
                         : step.met                    ? "bound"
                                                       : "missed");
        }
    }

    /// Draws the part of the ray inside the picture.
    void draw_ray() {
        const Ray& ray = trace_.ray;
        double enter = 0, leave = 1e300;
        for (int k = 0; k < 3; ++k) {
            if (ray.direction[k] == 0) continue;
            const double a = (box_.lo[k] - ray.origin[k]) / ray.direction[k];
            const double b = (box_.hi[k] - ray.origin[k]) / ray.direction[k];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (!(enter <= leave)) leave = enter;
        const double end = trace_.hit.found() ? trace_.hit.t : leave;
        const Vec2 p = project_(ray.at(enter)), q = project_(ray.at(end)),
                   far = project_(ray.at(leave));
        const auto at = [](double x) { return svg::decimals(x, 2); };
        out_.leaf("line", {{"class", "ray"},
                           {"marker-end", "url(#tip)"},
                           {"x1", at(p.x)},
                           {"y1", at(p.y)},
                           {"x2", at(q.x)},
                           {"y2", at(q.y)}});
        if (trace_.hit.found()) {
            out_.leaf("line", {{"class", "ray behind"},
                               {"x1", at(q.x)},
                               {"y1", at(q.y)},
                               {"x2", at(far.x)},
                               {"y2", at(far.y)}});
        }
        out_.leaf("circle", {{"cx", at(p.x)}, {"cy", at(p.y)}, {"r", "4"}, {"fill", "var(--ink)"}});
    }

    /// Draws numbers in the lower left of cells with enough space; of several in one place the
    /// first.
    void draw_numbers() {
        if (count(StepKind::Beam) > 0) return;
        int number = 0;
        for (const TraversalStep& step : trace_.steps) {
            if (step.kind != StepKind::Cell) continue;
            ++number;
            Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
            for (const Vec3& corner : step.corners) {
                const Vec2 p = project_(corner);
                lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
                hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
            }
            const double room = std::min(hi.x - lo.x, hi.y - lo.y);
            const double size = std::clamp(0.38 * room, 6.5, 18.0);
            out_.text("text",
                      {{"class", "number"},
                       {"x", svg::decimals(lo.x + std::min(0.5 * (hi.x - lo.x), 0.95 * size), 2)},
                       {"y", svg::decimals(hi.y - std::min(0.5 * (hi.y - lo.y), 0.75 * size), 2)},
                       {"font-size", svg::decimals(size, 1)}},
                      std::to_string(number));
        }
    }

    const PrimitiveTable& table_;
    const TraversalTrace& trace_;
    Box3 box_;
    Projection project_;
    svg::Writer out_;
};

}  // namespace

FigureView parse_figure_view(const std::string& name) {
    if (name == "x") return FigureView::AlongX;
    if (name == "y") return FigureView::AlongY;
    if (name == "z") return FigureView::AlongZ;
    if (name == "isometric") return FigureView::Isometric;
    throw Error(ErrorKind::Usage, fmt::format("--along '{}': expected x, y, z or isometric", name));
}

FigureView natural_view(const Ray& ray) {
    const Vec3 d = abs(ray.direction);
    if (d.x < d.y && d.x < d.z) return FigureView::AlongX;
    return d.y < d.z ? FigureView::AlongY : FigureView::AlongZ;
}

std::string traversal_svg(const Scene& scene, const TraversalTrace& trace, FigureView view) {
    return Figure(scene, trace, view).text();
}

}  // namespace alhazen
