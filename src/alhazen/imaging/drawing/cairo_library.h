#pragma once
/// The library cairo, loaded when it is first asked for: with what it needs in turn (X11,
/// fontconfig and others) it would take a fifth of the start of every program that is linked with
/// Alhazen.

#include <cairo-pdf.h>
#include <dlfcn.h>

#include <string>

#include "alhazen/base/error.h"

namespace alhazen {

/// The functions that a drawing needs, without their prefix.
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
    void* library_ = dlopen(kFile, RTLD_LAZY | RTLD_LOCAL);

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

/// Throws Error (Resource) where the library cannot be loaded.
inline const Cairo& cairo() {
    static const Cairo functions;
    return functions;
}

}  // namespace alhazen
