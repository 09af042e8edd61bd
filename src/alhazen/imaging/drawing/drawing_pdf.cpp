#include <cairo-pdf.h>
#include <dlfcn.h>

#include <memory>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/imaging/drawing/drawing_style.h"

namespace alhazen {

namespace {

/// The functions of Cairo that a drawing needs, without their prefix. The library is loaded with
/// the first drawing: with its own dependencies (X11, fontconfig and others) it would take a fifth
/// of the start-up time of every program.
class Cairo {
  private:
    struct Function {
        void* address;
        template <class F>
        operator F*() const {  // NOLINT(google-explicit-constructor)
            return reinterpret_cast<F*>(address);
        }
    };
#ifdef __APPLE__
    static constexpr const char* kFile = "libcairo.2.dylib";
#else
    static constexpr const char* kFile = "libcairo.so.2";
#endif
    void* library_ = open(kFile);

    /// Opens the library on the loader's search path, or at its path at build time.
    static void* open(const char* file) {
        void* library = dlopen(file, RTLD_LAZY | RTLD_LOCAL);
        if (library != nullptr) return library;
        const std::string built_with = std::string(ALHAZEN_CAIRO_FOLDER) + file;
        return dlopen(built_with.c_str(), RTLD_LAZY | RTLD_LOCAL);
    }

    [[nodiscard]] Function find(const char* name) const {
        void* address = library_ == nullptr ? nullptr : dlsym(library_, name);
        if (address == nullptr) {
            const char* why = dlerror();
            throw Error(ErrorKind::Resource, std::string("a PDF needs the library cairo 1.16: ") +
                                                 (why != nullptr ? why : name));
        }
        return {address};
    }

  public:
    decltype(&cairo_arc) arc = find("cairo_arc");
    decltype(&cairo_arc_negative) arc_negative = find("cairo_arc_negative");
    decltype(&cairo_close_path) close_path = find("cairo_close_path");
    decltype(&cairo_create) create = find("cairo_create");
    decltype(&cairo_destroy) destroy = find("cairo_destroy");
    decltype(&cairo_fill) fill = find("cairo_fill");
    decltype(&cairo_fill_preserve) fill_preserve = find("cairo_fill_preserve");
    decltype(&cairo_get_matrix) get_matrix = find("cairo_get_matrix");
    decltype(&cairo_line_to) line_to = find("cairo_line_to");
    decltype(&cairo_matrix_init) matrix_init = find("cairo_matrix_init");
    decltype(&cairo_move_to) move_to = find("cairo_move_to");
    decltype(&cairo_new_sub_path) new_sub_path = find("cairo_new_sub_path");
    decltype(&cairo_paint) paint = find("cairo_paint");
    decltype(&cairo_pattern_add_color_stop_rgb) pattern_add_color_stop_rgb =
        find("cairo_pattern_add_color_stop_rgb");
    decltype(&cairo_pattern_create_linear) pattern_create_linear =
        find("cairo_pattern_create_linear");
    decltype(&cairo_pattern_destroy) pattern_destroy = find("cairo_pattern_destroy");
    decltype(&cairo_pdf_surface_create_for_stream) pdf_surface_create_for_stream =
        find("cairo_pdf_surface_create_for_stream");
    decltype(&cairo_set_dash) set_dash = find("cairo_set_dash");
    decltype(&cairo_set_fill_rule) set_fill_rule = find("cairo_set_fill_rule");
    decltype(&cairo_set_line_cap) set_line_cap = find("cairo_set_line_cap");
    decltype(&cairo_set_line_join) set_line_join = find("cairo_set_line_join");
    decltype(&cairo_set_line_width) set_line_width = find("cairo_set_line_width");
    decltype(&cairo_set_matrix) set_matrix = find("cairo_set_matrix");
    decltype(&cairo_set_source) set_source = find("cairo_set_source");
    decltype(&cairo_set_source_rgb) set_source_rgb = find("cairo_set_source_rgb");
    decltype(&cairo_set_tolerance) set_tolerance = find("cairo_set_tolerance");
    decltype(&cairo_show_page) show_page = find("cairo_show_page");
    decltype(&cairo_status) status = find("cairo_status");
    decltype(&cairo_status_to_string) status_to_string = find("cairo_status_to_string");
    decltype(&cairo_stroke) stroke = find("cairo_stroke");
    decltype(&cairo_surface_destroy) surface_destroy = find("cairo_surface_destroy");
    decltype(&cairo_surface_finish) surface_finish = find("cairo_surface_finish");
    decltype(&cairo_surface_status) surface_status = find("cairo_surface_status");
    decltype(&cairo_transform) transform = find("cairo_transform");
};

/// Throws Error (Resource) if the library cannot be loaded.
const Cairo& cairo() {
    static const Cairo functions;
    return functions;
}

struct Release {
    void operator()(cairo_surface_t* surface) const { cairo().surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo().destroy(context); }
    void operator()(cairo_pattern_t* pattern) const { cairo().pattern_destroy(pattern); }
};
template <class T>
using Owned = std::unique_ptr<T, Release>;

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int count) {
    static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
}

void trace(cairo_t* page, const std::vector<Vec2>& points, bool closed) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i == 0) {
            cairo().move_to(page, points[i].x, points[i].y);
        } else {
            cairo().line_to(page, points[i].x, points[i].y);
        }
    }
    if (closed) cairo().close_path(page);
}

/// Traces the unit circle in the frame of the half diameters; the line itself keeps its width.
void trace(cairo_t* page, const DrawingArc& arc) {
    cairo_matrix_t shown, ellipse;
    cairo().get_matrix(page, &shown);
    cairo().matrix_init(&ellipse, arc.u.x, arc.u.y, arc.v.x, arc.v.y, arc.center.x, arc.center.y);
    cairo().transform(page, &ellipse);
    cairo().new_sub_path(page);
    if (arc.to > arc.from) {
        cairo().arc(page, 0, 0, 1, arc.from, arc.to);
    } else {
        cairo().arc_negative(page, 0, 0, 1, arc.from, arc.to);
    }
    cairo().set_matrix(page, &shown);
}

void set_color(cairo_t* page, const Rgb& c) {
    cairo().set_source_rgb(page, c.r, c.g, c.b);
}

/// `seams`: also draw a line around the region.
void fill(cairo_t* page, const DrawingRegion& region, bool seams) {
    for (const std::vector<Vec2>& loop : region.loops) trace(page, loop, true);
    if (region.gradient) {
        const DrawingGradient& g = *region.gradient;
        const Owned<cairo_pattern_t> pattern(
            cairo().pattern_create_linear(g.from.x, g.from.y, g.to.x, g.to.y));
        cairo().pattern_add_color_stop_rgb(pattern.get(), 0, g.at_from.r, g.at_from.g, g.at_from.b);
        cairo().pattern_add_color_stop_rgb(pattern.get(), 1, g.at_to.r, g.at_to.g, g.at_to.b);
        cairo().set_source(page, pattern.get());
    } else {
        set_color(page, region.color);
    }
    if (!seams) return cairo().fill(page);
    cairo().fill_preserve(page);
    cairo().set_line_width(page, kSeam);
    cairo().stroke(page);
}

void draw(cairo_t* page, const DrawingLine& line) {
    const LineLook& look = look_of(line.style);
    cairo().set_line_width(page, look.width);
    cairo().set_dash(page, look.dash.data(), look.dash[0] > 0 ? 2 : 0, 0);
    set_color(page, {0, 0, 0});
    if (line.arc) {
        trace(page, *line.arc);
    } else {
        trace(page, line.points, line.closed);
    }
    cairo().stroke(page);
}

}  // namespace

std::string drawing_pdf(const Drawing& drawing) {
    std::string bytes;
    const Owned<cairo_surface_t> surface(
        cairo().pdf_surface_create_for_stream(append, &bytes, drawing.width, drawing.height));
    const Owned<cairo_t> page(cairo().create(surface.get()));
    cairo().set_fill_rule(page.get(), CAIRO_FILL_RULE_EVEN_ODD);
    cairo().set_line_join(page.get(), CAIRO_LINE_JOIN_ROUND);
    cairo().set_tolerance(page.get(), 0.01);  // of the curves that replace arcs
    set_color(page.get(), drawing.background);
    cairo().paint(page.get());
    // Readers antialias the edges of regions, so the background shows between two that abut: the
    // same regions, slightly larger, are drawn below.
    for (const bool seams : {true, false}) {
        for (const DrawingGroup& group : drawing.groups) {
            for (const DrawingRegion& region : group.regions) fill(page.get(), region, seams);
        }
    }
    cairo().set_line_cap(page.get(), CAIRO_LINE_CAP_ROUND);
    for (const DrawingLine& line : drawing.lines) draw(page.get(), line);
    cairo().show_page(page.get());
    cairo().surface_finish(surface.get());
    const cairo_status_t status = cairo().surface_status(surface.get());
    if (status != CAIRO_STATUS_SUCCESS || cairo().status(page.get()) != CAIRO_STATUS_SUCCESS) {
        throw Error(ErrorKind::Resource, std::string("the PDF could not be made: ") +
                                             cairo().status_to_string(cairo().status(page.get())));
    }
    return bytes;
}

}  // namespace alhazen
