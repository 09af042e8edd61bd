// Solids with fields that are lists: polyhedra, blobs and height fields.

#include "alhazen/formats/native/fields/native_shape_fields.h"

#include <array>
#include <span>

namespace alhazen {

namespace {

/// Reads `((point, normal), ...)`.
void read_planes(TextNode list, const ValueReader& values, Polyhedron& solid) {
    if (!values.is_list(list, "planes")) return;
    for (const TextNode entry : list) {
        if (!values.is_list(entry, "planes")) continue;
        if (entry.size() != 2) {
            values.fail(entry, "planes", "a list (point, outward normal)");
            continue;
        }
        OrientedPlane plane;
        auto field = entry.begin();
        const bool point = values.read(*field, "point of a plane", plane.point);
        if (values.read(*++field, "normal of a plane", plane.normal) && point) {
            solid.planes.push_back(plane);
        }
    }
}

bool read_vertex_number(TextNode value, const ValueReader& values, std::uint32_t& number) {
    int read = 0;
    if (!values.read(value, "faces", read)) return false;
    if (read < 0) return values.fail(value, "faces", "numbers of vertices, from 0");
    number = static_cast<std::uint32_t>(read);
    return true;
}

/// Reads `((a, b, c, ...), ...)`.
void read_faces(TextNode list, const ValueReader& values, Polyhedron& solid) {
    if (!values.is_list(list, "faces")) return;
    for (const TextNode face : list) {
        if (!values.is_list(face, "faces")) continue;
        for (const TextNode corner : face) {
            std::uint32_t number = 0;
            if (read_vertex_number(corner, values, number)) solid.corners.push_back(number);
        }
        solid.face_ends.push_back(static_cast<std::uint32_t>(solid.corners.size()));
    }
}

}  // namespace

void read_native_fields(BlockReader& reader, Polyhedron& solid) {
    const auto planes = reader.find("planes");
    const auto vertices = reader.find("vertices");
    const auto faces = reader.find("faces");
    if (reader.has("planes") == reader.has("vertices")) {
        reader.error(reader.block(), "expected either 'planes = ...' or 'vertices = ...'");
        return;
    }
    if (planes) read_planes(*planes, reader.values(), solid);
    if (vertices && reader.values().is_list(*vertices, "vertices")) {
        for (const TextNode point : *vertices) {
            Vec3 vertex;
            if (reader.values().read(point, "vertices", vertex)) solid.vertices.push_back(vertex);
        }
    }
    if (faces) {
        read_faces(*faces, reader.values(), solid);
    } else if (vertices && !reader.has("faces")) {
        if (solid.vertices.size() != 8) {
            reader.error(reader.block(), "expected 'faces = ...', or 8 vertices of a hexahedron");
            return;
        }
        std::array<Vec3, 8> points;
        std::copy(solid.vertices.begin(), solid.vertices.end(), points.begin());
        solid = hexahedron(points);
    }
}

void write_native_fields(NativeBlockText& block, const Polyhedron& s) {
    if (!s.planes.empty()) {
        block.add("planes", native_list_of(s.planes, [](const OrientedPlane& plane) {
                      return native_list({native_value(plane.point), native_value(plane.normal)});
                  }));
    }
    if (s.vertices.empty()) return;
    block.add("vertices",
              native_list_of(s.vertices, [](const Vec3& p) { return native_value(p); }));
    std::vector<std::string> faces;
    std::size_t begin = 0;
    for (const std::uint32_t end : s.face_ends) {
        const std::span<const std::uint32_t> face(&s.corners[begin], end - begin);
        faces.push_back(native_list_of(face, [](std::uint32_t v) { return std::to_string(v); }));
        begin = end;
    }
    block.add("faces", native_list(faces));
}

namespace {

/// Reads sphere(center, radius, strength) or cylinder(base, top, radius, strength).
bool read_component(TextNode entry, const ValueReader& values, BlobComponent& component) {
    component.rod = entry.is(NodeKind::Entry, "cylinder");
    const std::size_t count = component.rod ? 4 : 3;
    if ((!component.rod && !entry.is(NodeKind::Entry, "sphere")) || entry.empty() ||
        !entry.first().is(NodeKind::List) || entry.first().size() != count) {
        return values.fail(entry, "components",
                           "sphere(center, radius, strength) or "
                           "cylinder(base, top, radius, strength)");
    }
    auto field = entry.first().begin();
    if (!values.read(*field, "components", component.base)) return false;
    component.top = component.base;
    if (component.rod && !values.read(*++field, "components", component.top)) return false;
    return values.read(*++field, "radius of a component", component.radius) &&
           values.read(*++field, "strength of a component", component.strength);
}

}  // namespace

void read_native_field(BlockReader& reader, const Field<Blob, std::vector<BlobComponent>>& field,
                       Blob& shape) {
    reader.require(field.name);
    const auto components = reader.find(field.name);
    if (!components || !reader.values().is_list(*components, field.name)) return;
    for (const TextNode entry : *components) {
        BlobComponent component;
        if (read_component(entry, reader.values(), component)) {
            (shape.*field.member).push_back(component);
        }
    }
}

std::string native_field_text(const std::vector<BlobComponent>& components) {
    return native_list_of(components, [](const BlobComponent& c) {
        const std::string rest =
            ", " + native_value(c.radius) + ", " + native_value(c.strength) + ")";
        if (!c.rod) return "sphere(" + native_value(c.base) + rest;
        return "cylinder(" + native_value(c.base) + ", " + native_value(c.top) + rest;
    });
}

void read_native_fields(BlockReader& reader, HeightField& field) {
    reader.read("lo", field.lo);
    reader.read("hi", field.hi);
    reader.read("base", field.base);
    auto heights = std::make_shared<std::vector<float>>();
    field.heights = heights;
    const auto list = reader.find("heights");
    if (reader.has("heights") == reader.has("file")) {
        reader.error(reader.block(), "expected either 'heights = ...' or 'file = ...'");
    }
    reader.needs("columns", "heights");
    if (!reader.has("heights")) return;
    int columns = 0;
    reader.require("columns");
    if (!reader.read("columns", columns) || !list) return;
    if (!reader.values().is_list(*list, "heights")) return;
    for (const TextNode value : *list) {
        double height = 0;
        if (!reader.values().read(value, "heights", height)) return;
        heights->push_back(static_cast<float>(height));
    }
    if (columns < 2 || heights->size() % static_cast<std::size_t>(columns) != 0) {
        reader.error(reader.block(), "'columns' must be at least 2 and divide the " +
                                         std::to_string(heights->size()) + " heights into rows");
        return;
    }
    field.columns = static_cast<std::uint32_t>(columns);
    field.rows = static_cast<std::uint32_t>(heights->size()) / field.columns;
}

void write_native_fields(NativeBlockText& block, const HeightField& s) {
    block.add("columns", native_value(static_cast<int>(s.columns)));
    block.add("heights",
              native_list_of(*s.heights, [](float h) { return native_value(double{h}); }));
    block.add("lo", native_value(s.lo));
    block.add("hi", native_value(s.hi));
    block.add("base", native_value(s.base));
}

}  // namespace alhazen
