// Records of version 4 that span several lines, or describe solids with few numbers.

#include <array>

#include "alhazen/formats/brlcad/brlcad_v4_reader.h"
#include "alhazen/formats/brlcad/brlcad_v4_solids.h"

namespace alhazen {

namespace {

constexpr std::int64_t kMost = 2147483647;

Vec3 vec(const double* v) {
    return {v[0], v[1], v[2]};
}

}  // namespace

bool BrlcadV4Reader::go_to_next(std::string_view kind) {
    TextCursor ahead = cursor_;
    ahead.skip_line();
    if (!ahead.skip_to_word() || ahead.word() != kind) return false;
    cursor_ = ahead;
    return true;
}

void BrlcadV4Reader::read_particle() {
    std::string solid_name;
    std::array<double, 8> v{};
    if (!own_name(solid_name) || !numbers(v)) return;
    check_room(1);
    add_solid(std::move(solid_name), {"part", BrlcadParticle{vec(&v[0]), vec(&v[3]), v[6], v[7]}},
              record_);
}

void BrlcadV4Reader::read_planes() {
    std::string solid_name;
    std::int64_t count = 0;
    if (!own_name(solid_name) || !integer(count, 0, kMost)) return;
    BrlcadPolyhedron polyhedron;
    for (std::int64_t i = 0; i < count; ++i) {
        std::array<double, 4> plane{};
        check_room(1);
        if (!go_to_next("n")) {
            fail("expected plane " + std::to_string(i + 1) + " of " + std::to_string(count) +
                 " of '" + solid_name + "': n and four numbers");
            return;
        }
        if (!numbers(plane)) return;
        polyhedron.planes.push_back({vec(plane.data()), plane[3]});
    }
    add_solid(std::move(solid_name), {"arbn", std::move(polyhedron)}, record_);
}

bool BrlcadV4Reader::read_ars_points(std::size_t count, std::vector<Vec3>& points) {
    for (std::size_t done = 0; done < count;) {
        std::int64_t type = 0, number = 0, granule = 0;
        std::array<double, 24> v{};
        if (!go_to_next("B")) return fail("expected a record B of points of an ars");
        if (!integer(type, -kMost, kMost) || !integer(number, -kMost, kMost) ||
            !integer(granule, -kMost, kMost) || !numbers(v)) {
            return false;
        }
        for (std::size_t i = 0; i < 8 && done < count; ++i, ++done)
            points.push_back(vec(&v[3 * i]));
    }
    return true;
}

void BrlcadV4Reader::read_ars() {
    std::int64_t type = 0, curves = 0, per_curve = 0, granules = 0, total = 0;
    std::string solid_name;
    if (!integer(type, -kMost, kMost) || !own_name(solid_name) || !integer(curves, 2, kMost) ||
        !integer(per_curve, 1, kMost) || !integer(granules, 1, kMost) ||
        !integer(total, 1, kMost)) {
        return;
    }
    if (granules != (per_curve + 7) / 8 || total != granules * curves) {
        fail("the records of ars '" + solid_name + "' do not match its points: " +
             std::to_string(curves) + " curves of " + std::to_string(per_curve) + " points need " +
             std::to_string((per_curve + 7) / 8) + " records each");
        return;
    }
    std::vector<Vec3> points;
    for (std::int64_t curve = 0; curve < curves; ++curve) {
        check_room(per_curve);
        if (!read_ars_points(static_cast<std::size_t>(per_curve), points)) return;
    }
    // All points except the first are relative to the first.
    for (std::size_t i = 1; i < points.size(); ++i) points[i] = points[0] + points[i];
    add_solid(std::move(solid_name),
              {"ars", brlcad_ars(points, static_cast<std::size_t>(curves),
                                 static_cast<std::size_t>(per_curve))},
              record_);
}

bool BrlcadV4Reader::read_bot_faces(bool thick, std::size_t count, TriangleMesh& mesh) {
    const auto most = static_cast<std::int64_t>(mesh.positions.size()) - 1;
    for (std::size_t i = 0; i < count; ++i) {
        cursor_.skip_line();
        std::string label;
        std::array<std::int64_t, 3> v{};
        std::array<double, 1> thickness{};
        check_room(1);
        if (!name(label) || !integer(v[0], 0, most) || !integer(v[1], 0, most) ||
            !integer(v[2], 0, most) || (thick && !numbers(thickness))) {
            return false;
        }
        mesh.triangles.push_back({static_cast<std::uint32_t>(v[0]),
                                  static_cast<std::uint32_t>(v[1]),
                                  static_cast<std::uint32_t>(v[2])});
    }
    if (thick) cursor_.skip_line();  // bits for the position of the thickness
    return true;
}

void BrlcadV4Reader::read_bot() {
    std::string solid_name;
    std::int64_t mode = 0, orientation = 0, unused = 0, vertices = 0, faces = 0;
    if (!own_name(solid_name) || !integer(mode, 1, 4) || !integer(orientation, 1, 3) ||
        !integer(unused, -kMost, kMost) || !integer(vertices, 0, kMost) ||
        !integer(faces, 0, kMost)) {
        return;
    }
    BrlcadMesh bot;
    bot.solid = mode == 2;
    bot.plate = mode >= 3;
    bot.mesh = std::make_shared<TriangleMesh>();
    for (std::int64_t i = 0; i < vertices; ++i) {
        cursor_.skip_line();
        std::string label;
        std::array<double, 3> p{};
        check_room(1);
        if (!name(label) || !numbers(p)) return;
        bot.mesh->positions.push_back(vec(p.data()));
    }
    if (!read_bot_faces(mode == 3, static_cast<std::size_t>(faces), *bot.mesh)) return;
    if (orientation == 3) {
        for (auto& triangle : bot.mesh->triangles) std::swap(triangle[1], triangle[2]);
    }
    add_solid(std::move(solid_name), {"bot", std::move(bot)}, record_);
}

void BrlcadV4Reader::read_polygons() {
    std::string solid_name;
    if (!own_name(solid_name)) return;
    BrlcadMesh polygons;
    polygons.mesh = std::make_shared<TriangleMesh>();
    TriangleMesh& mesh = *polygons.mesh;
    while (go_to_next("Q")) {
        std::int64_t count = 0;
        std::array<double, 15> v{};
        check_room(5);
        if (!integer(count, 3, 5) || !numbers(v)) return;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            mesh.positions.push_back(vec(&v[3 * i]));
        }
        for (std::uint32_t i = 2; i < static_cast<std::uint32_t>(count); ++i) {
            mesh.triangles.push_back({first, first + i - 1, first + i});
        }
    }
    add_solid(std::move(solid_name), {"polysolid", std::move(polygons)}, record_);
}

void BrlcadV4Reader::read_unsupported(const char* type) {
    std::string solid_name;
    if (own_name(solid_name))
        add_solid(std::move(solid_name), {type, BrlcadUnsupported{}}, record_);
}

void BrlcadV4Reader::read_string_solid() {
    std::string type, solid_name;
    if (!name(type) || !own_name(solid_name)) return;
    add_solid(std::move(solid_name), {std::move(type), BrlcadUnsupported{}}, record_);
}

void BrlcadV4Reader::read_nmg() {
    std::string solid_name;
    std::int64_t version = 0, granules = 0;
    if (!integer(version, -kMost, kMost) || !own_name(solid_name) || !integer(granules, 0, kMost)) {
        return;
    }
    // One line of counts, then four lines of hexadecimal digits per granule.
    for (std::int64_t i = 0; i < 1 + 4 * granules; ++i) {
        if (cursor_.bytes_left() == 0) {
            fail("the file ends within '" + solid_name + "'");
            return;
        }
        cursor_.skip_line();
        cursor_.rest_of_line();
    }
    add_solid(std::move(solid_name), {"nmg", BrlcadUnsupported{}}, record_);
}

void BrlcadV4Reader::read_pipe() {
    std::string solid_name;
    if (!own_name(solid_name)) return;
    for (;;) {
        if (cursor_.bytes_left() == 0) {
            fail("the file ends within pipe '" + solid_name + "'; expected END_PIPE");
            return;
        }
        cursor_.skip_line();
        cursor_.skip_blanks();
        TextCursor line = cursor_;
        if (line.word() == "END_PIPE") break;
    }
    add_solid(std::move(solid_name), {"pipe", BrlcadUnsupported{}}, record_);
}

void BrlcadV4Reader::skip_spline_surface() {
    // Knots and control points, a number a line.
    for (;;) {
        TextCursor ahead = cursor_;
        ahead.skip_line();
        if (!ahead.skip_to_word()) return;
        const char begin = ahead.peek();
        if (begin != '-' && begin != '.' && !(begin >= '0' && begin <= '9')) return;
        ahead.rest_of_line();
        cursor_ = ahead;
    }
}

void BrlcadV4Reader::read_sketch() {
    std::string solid_name;
    std::array<double, 9> placement{};
    std::int64_t vertices = 0, segments = 0;
    if (!own_name(solid_name) || !numbers(placement) || !integer(vertices, 0, kMost) ||
        !integer(segments, 0, kMost)) {
        return;
    }
    // A line of all vertices, and one of each segment.
    for (std::int64_t i = 0; i < 1 + segments; ++i) {
        if (cursor_.bytes_left() == 0) {
            fail("the file ends within '" + solid_name + "'");
            return;
        }
        cursor_.skip_line();
        cursor_.rest_of_line();
    }
    add_solid(std::move(solid_name), {"sketch", BrlcadUnsupported{}}, record_);
}

}  // namespace alhazen
