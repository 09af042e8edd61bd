#include "alhazen/importers/native/native_write_shapes.h"

#include "alhazen/importers/native/native_exact_shapes.h"

#include <span>

namespace alhazen {

namespace {

// The fields that a file gives; the others are derived from them.

void add_fields(NativeBlockText& block, const Sphere& s) {
    block.add("center", native_value(s.center));
    block.add("radius", native_value(s.radius));
}
void add_fields(NativeBlockText& block, const Plane& s) {
    block.add("point", native_value(s.point));
    block.add("normal", native_value(s.normal));
}
void add_fields(NativeBlockText& block, const Disc& s) {
    block.add("center", native_value(s.center));
    block.add("normal", native_value(s.normal));
    block.add("radius", native_value(s.radius));
    block.add_unless("inner_radius", s.inner_radius, 0.0);
}
void add_fields(NativeBlockText& block, const Rectangle& s) {
    block.add("corner", native_value(s.corner));
    block.add("edge_u", native_value(s.edge_u));
    block.add("edge_v", native_value(s.edge_v));
}
void add_fields(NativeBlockText& block, const BoxShape& s) {
    block.add("lo", native_value(s.lo));
    block.add("hi", native_value(s.hi));
}
void add_fields(NativeBlockText& block, const Cylinder& s) {
    block.add("base", native_value(s.base));
    block.add("top", native_value(s.top));
    block.add("radius", native_value(s.radius));
    block.add_unless("capped", s.capped, true);
}
void add_fields(NativeBlockText& block, const Cone& s) {
    block.add("base", native_value(s.base));
    block.add("top", native_value(s.top));
    block.add("base_radius", native_value(s.base_radius));
    block.add("top_radius", native_value(s.top_radius));
    block.add_unless("capped", s.capped, true);
}
void add_fields(NativeBlockText& block, const Polygon& s) {
    const std::span<const Vec3> vertices(s.vertices);
    const auto loop_of = [](std::span<const Vec3> loop) {
        return native_list_of(loop, [](const Vec3& p) { return native_value(p); });
    };
    if (s.loop_ends.size() <= 1) {
        block.add("vertices", loop_of(vertices));
        return;
    }
    std::vector<std::string> loops;
    std::size_t begin = 0;
    for (const std::uint32_t end : s.loop_ends) {
        loops.push_back(loop_of(vertices.subspan(begin, end - begin)));
        begin = end;
    }
    block.add("loops", native_list(loops));
}

void add_fields(NativeBlockText& block, const HalfSpace& s) {
    block.add("point", native_value(s.point));
    block.add("normal", native_value(s.normal));
}
void add_fields(NativeBlockText& block, const Polyhedron& s) {
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

}  // namespace

void add_shape_fields(NativeBlockText& block, const AnyShape& shape) {
    std::visit([&](const auto& s) { add_fields(block, s); }, shape);
}

}  // namespace alhazen
