#include "alhazen/formats/native/write/native_write_shapes.h"

#include "alhazen/formats/native/read/native_exact_shapes.h"

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

/// `[[(x, y), curve((x, y), (x, y), (x, y)), ...], ...]`.
std::string profile_text(const Profile& profile) {
    std::vector<std::string> loops;
    std::size_t begin = 0;
    for (const std::size_t end : profile.loop_ends) {
        std::vector<std::string> steps;
        for (std::size_t i = begin; i < end; ++i) {
            const ProfileCurve& c = profile.curves[i];
            if (i == begin) steps.push_back(native_value(c.p[0]));
            steps.push_back(c.line ? native_value(c.p[3])
                                   : "curve(" + native_value(c.p[1]) + ", " + native_value(c.p[2]) +
                                         ", " + native_value(c.p[3]) + ")");
        }
        loops.push_back(native_list(steps));
        begin = end;
    }
    return native_list(loops);
}
void add_fields(NativeBlockText& block, const Prism& s) {
    block.add("loops", profile_text(s.profile));
    block.add("h0", native_value(s.h0));
    block.add("h1", native_value(s.h1));
    block.add_unless("top_scale", s.top_scale, 1.0);
}
void add_fields(NativeBlockText& block, const Lathe& s) {
    block.add("loops", profile_text(s.profile));
}
void add_fields(NativeBlockText& block, const Blob& s) {
    block.add("threshold", native_value(s.threshold));
    block.add("components", native_list_of(s.components, [](const BlobComponent& c) {
                  const std::string rest =
                      ", " + native_value(c.radius) + ", " + native_value(c.strength) + ")";
                  if (!c.rod) return "sphere(" + native_value(c.base) + rest;
                  return "cylinder(" + native_value(c.base) + ", " + native_value(c.top) + rest;
              }));
}
void add_fields(NativeBlockText& block, const HeightField& s) {
    block.add("columns", native_value(static_cast<int>(s.columns)));
    block.add("heights",
              native_list_of(*s.heights, [](float h) { return native_value(double{h}); }));
    block.add("lo", native_value(s.lo));
    block.add("hi", native_value(s.hi));
    block.add("base", native_value(s.base));
}

}  // namespace

void add_shape_fields(NativeBlockText& block, const AnyShape& shape) {
    std::visit([&](const auto& s) { add_fields(block, s); }, shape);
}

}  // namespace alhazen
