#include "alhazen/session/generators/nff_text.h"

#include <fmt/format.h>

#include <iterator>

namespace alhazen {

/// Writes a blank before each number.
void NffText::numbers(std::initializer_list<double> values) {
    for (const double value : values) {
        fmt::format_to(std::back_inserter(text_), " {:.{}g}", value, digits_);
    }
}

void NffText::vector_line(const char* word, const Vec3& v) {
    text_ += word;
    numbers({v.x, v.y, v.z});
    text_ += '\n';
}

void NffText::background(const Rgb& color) {
    vector_line("b", {color.r, color.g, color.b});
}

void NffText::view(const NffTextView& view) {
    text_ += "v\n";
    vector_line("from", view.from);
    vector_line("at", view.at);
    vector_line("up", view.up);
    text_ += "angle";
    numbers({view.angle_deg});
    text_ += "\nhither";
    numbers({view.hither});
    text_ += fmt::format("\nresolution {} {}\n", view.resolution, view.resolution);
}

void NffText::light(const Vec3& position) {
    vector_line("l", position);
}

void NffText::fill(const NffTextFill& f) {
    text_ += 'f';
    numbers({f.color.r, f.color.g, f.color.b, f.diffuse, f.specular, f.shininess, f.transmission,
             f.index});
    text_ += '\n';
}

void NffText::sphere(const Vec3& center, double radius) {
    text_ += 's';
    numbers({center.x, center.y, center.z, radius});
    text_ += '\n';
}

void NffText::cone(const Vec3& base, double base_radius, const Vec3& apex, double apex_radius) {
    text_ += 'c';
    numbers({base.x, base.y, base.z, base_radius});
    text_ += '\n';
    numbers({apex.x, apex.y, apex.z, apex_radius});
    text_ += '\n';
}

void NffText::polygon(std::span<const Vec3> vertices) {
    text_ += fmt::format("p {}\n", vertices.size());
    for (const Vec3& p : vertices) vector_line("", p);
}

void NffText::patch(std::span<const Vec3> vertices, std::span<const Vec3> normals) {
    text_ += fmt::format("pp {}\n", vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        numbers({vertices[i].x, vertices[i].y, vertices[i].z, normals[i].x, normals[i].y,
                 normals[i].z});
        text_ += '\n';
    }
}

}  // namespace alhazen
