// Fields of basic types, clips and polygons; outlines are in native_profiles.cpp, other lists in
// native_list_fields.cpp.

#include "alhazen/formats/native/fields/native_shape_fields.h"

#include <span>

namespace alhazen {

namespace {

void read_box(BlockReader& reader, std::string_view key, Box3& box) {
    const auto list = reader.find(key);
    if (!list || !reader.values().is_list(*list, key)) return;
    Vec3 corners[2];
    int count = 0;
    for (const TextNode corner : *list) {
        Vec3 value;
        if (!reader.values().read(corner, key, value)) return;
        if (count < 2) corners[count] = value;
        ++count;
    }
    if (count != 2) {
        reader.error(*list, std::string(key) + ": expected ((x, y, z), (x, y, z)), the lower " +
                                "corner and the upper one");
        return;
    }
    box = {corners[0], corners[1]};
}

/// Appends one loop `((x, y, z), ...)` to the polygon.
void read_loop(TextNode loop, std::string_view key, const ValueReader& values, Polygon& polygon) {
    if (!values.is_list(loop, key)) return;
    for (const TextNode point : loop) {
        Vec3 vertex;
        if (values.read(point, key, vertex)) polygon.vertices.push_back(vertex);
    }
    polygon.loop_ends.push_back(static_cast<std::uint32_t>(polygon.vertices.size()));
}

std::string points_text(std::span<const Vec3> points) {
    return native_list_of(points, [](const Vec3& p) { return native_value(p); });
}

}  // namespace

void read_native_field(BlockReader& reader, const Field<Quadric, Box3>& field, Quadric& shape) {
    read_box(reader, field.name, shape.*field.member);
}

void read_native_field(BlockReader& reader, const Field<Algebraic, Box3>& field, Algebraic& shape) {
    read_box(reader, field.name, shape.*field.member);
}

void read_native_field(BlockReader& reader, const Field<Quadric, std::vector<ClipPlane>>& field,
                       Quadric& shape) {
    const auto list = reader.find(field.name);
    if (!list || !reader.values().is_list(*list, field.name)) return;
    for (const TextNode plane : *list) {
        double n[4];
        if (!reader.values().read_numbers(plane, field.name, 4, n)) continue;
        (shape.*field.member).push_back({{n[0], n[1], n[2]}, n[3]});
    }
}

std::string native_field_text(const std::string& value) {
    return native_string(value);
}

std::string native_field_text(const Box3& box) {
    return native_list({native_value(box.lo), native_value(box.hi)});
}

std::string native_field_text(const std::vector<ClipPlane>& planes) {
    return native_list_of(planes, [](const ClipPlane& plane) {
        return native_list({native_value(plane.normal.x), native_value(plane.normal.y),
                            native_value(plane.normal.z), native_value(plane.offset)});
    });
}

void read_native_fields(BlockReader& reader, Polygon& shape) {
    const auto vertices = reader.find("vertices");
    const auto loops = reader.find("loops");
    if (reader.has("vertices") == reader.has("loops")) {
        reader.error(reader.block(), "expected either 'vertices = ...' or 'loops = ...'");
    }
    if (vertices) read_loop(*vertices, "vertices", reader.values(), shape);
    if (loops && reader.values().is_list(*loops, "loops")) {
        for (const TextNode loop : *loops) read_loop(loop, "loops", reader.values(), shape);
    }
}

void write_native_fields(NativeBlockText& block, const Polygon& shape) {
    const std::span<const Vec3> vertices(shape.vertices);
    if (shape.loop_ends.size() <= 1) {
        block.add("vertices", points_text(vertices));
        return;
    }
    std::vector<std::string> loops;
    std::size_t begin = 0;
    for (const std::uint32_t end : shape.loop_ends) {
        loops.push_back(points_text(vertices.subspan(begin, end - begin)));
        begin = end;
    }
    block.add("loops", native_list(loops));
}

}  // namespace alhazen
