#include "alhazen/formats/nff/nff_reader.h"

#include <algorithm>

namespace alhazen {

namespace {

constexpr std::string_view kComments = "#%";
constexpr int kMaxNffErrors = 50;

struct Refusal {
    std::string_view name;
    const char* what;
};
/// AFF statements that are recognised but not supported.
constexpr std::array<Refusal, 7> kRefused{{
    {"m", "a mesh"},
    {"xs", "a static transform"},
    {"x", "an animated transform"},
    {"k", "key frames"},
    {"tpa", "an animated triangle"},
    {"i", "an included file"},
    {"d", "a detail level"},
}};

}  // namespace

// NFF first, then the supported part of AFF.
const std::array<NffReader::Statement, 20> NffReader::kStatements{{
    {"v", &NffReader::view},
    {"from", &NffReader::from},
    {"at", &NffReader::at},
    {"up", &NffReader::up},
    {"angle", &NffReader::angle},
    {"hither", &NffReader::hither},
    {"resolution", &NffReader::resolution},
    {"b", &NffReader::background},
    {"l", &NffReader::light},
    {"f", &NffReader::fill},
    {"c", &NffReader::cone},
    {"s", &NffReader::sphere},
    {"p", &NffReader::polygon},
    {"pp", &NffReader::patch},
    {"la", &NffReader::animated_light},
    {"am", &NffReader::ambient},
    {"fm", &NffReader::fill_of_colors},
    {"tt", &NffReader::textured_triangle},
    {"ttp", &NffReader::textured_patch},
    {"a", &NffReader::animation},
}};

NffReader::NffReader(const ImportSource& source, SceneDescription& scene, Diagnostics& diagnostics)
    : cursor_(source.bytes),
      file_(source.path.string()),
      scene_(scene),
      diagnostics_(diagnostics),
      builder_(scene, source.options, diagnostics) {
    view_.location = statement_ = {file_, 0, 0};
}

void NffReader::read() {
    while (errors_ < kMaxNffErrors && cursor_.skip_to_word(kComments)) read_word();
    if (errors_ == kMaxNffErrors) {
        diagnostics_.error(cursor_.location(file_),
                           "too many errors; the rest of the file is not read");
    }
    builder_.finish(view_);
}

void NffReader::read_word() {
    const TextCursor start = cursor_;
    const std::string_view word = cursor_.word();
    for (const Statement& statement : kStatements) {
        if (statement.name != word) continue;
        // Keeps the name of the file, which is long.
        const FileLocation place = start.location({});
        statement_.line = place.line;
        statement_.column = place.column;
        statement_name_ = word;
        recovering_ = !(this->*statement.read)();
        return;
    }
    for (const Refusal& refusal : kRefused) {
        if (refusal.name != word) continue;
        error(start.location(file_),
              "'" + std::string(word) + "' (" + refusal.what + " of AFF) is not supported");
        recovering_ = true;
        refused_block_ = true;
        return;
    }
    // Braces of a rejected block are not reported.
    if (recovering_ || (refused_block_ && (word == "{" || word == "}"))) return;
    recovering_ = true;
    error(start.location(file_),
          "expected a statement (v, b, l, f, c, s, p or pp), found " + start.shown_word());
}

bool NffReader::view() {
    if (++views_ == 2) warn_once("v", "another view: its lines replace those of the first");
    view_.location = statement_;
    return true;
}
bool NffReader::from() {
    warn_of_two(view_.from.has_value());
    return vector(view_.from.emplace());
}
bool NffReader::at() {
    warn_of_two(view_.at.has_value());
    return vector(view_.at.emplace());
}
bool NffReader::up() {
    warn_of_two(view_.up.has_value());
    return vector(view_.up.emplace());
}
bool NffReader::angle() {
    warn_of_two(view_.angle_deg.has_value());
    return numbers(&view_.angle_deg.emplace(), 1);
}
bool NffReader::hither() {
    double unused = 0.0;
    return numbers(&unused, 1);
}
bool NffReader::resolution() {
    warn_of_two(view_.resolution.has_value());
    double size[2];
    if (!numbers(size, 2)) return false;
    view_.resolution = Vec2{size[0], size[1]};
    return true;
}
bool NffReader::background() {
    warn_of_two(scene_.picture.background.has_value());
    return color(scene_.picture.background.emplace());
}

bool NffReader::light() {
    Vec3 position;
    if (!vector(position)) return false;
    std::optional<Rgb> intensity;
    if (at_number() && !color(intensity.emplace())) return false;
    builder_.add_light(position, intensity, statement_);
    return true;
}
bool NffReader::animated_light() {
    if (!cursor_.skip_to_word(kComments)) return numbers(nullptr, 0);
    cursor_.word();  // name, for key frames
    warn_once("la", "the light is taken where it is defined; its animation is ignored");
    return light();
}
bool NffReader::ambient() {
    Rgb c;
    if (!color(c)) return false;
    builder_.set_ambient(c);
    return true;
}
bool NffReader::animation() {
    double unused[3];
    warn_once("a", "the animation is ignored");
    return numbers(unused, 3);
}

bool NffReader::fill() {
    double n[8];
    if (!numbers(n, 8)) return false;
    const Rgb diffuse = n[3] * Rgb{n[0], n[1], n[2]};
    builder_.set_fill({diffuse, diffuse, {n[4], n[4], n[4]}, n[5], n[6], n[7]}, statement_);
    return true;
}
bool NffReader::fill_of_colors() {
    double n[12];
    if (!numbers(n, 12)) return false;
    if (n[10] > 0.0) {
        warn_once("fm",
                  "the transmission of 'fm' is per unit of length; it is applied per surface");
    }
    builder_.set_fill(
        {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}, n[9], n[10], n[11]},
        statement_);
    return true;
}

bool NffReader::sphere() {
    double n[4];
    if (!numbers(n, 4)) return false;
    builder_.add_sphere({n[0], n[1], n[2]}, n[3], statement_);
    return true;
}
bool NffReader::cone() {
    double n[8];
    if (!numbers(n, 8)) return false;
    builder_.add_cone({n[0], n[1], n[2]}, n[3], {n[4], n[5], n[6]}, n[7], statement_);
    return true;
}
bool NffReader::polygon() {
    return polygon_of(false);
}
bool NffReader::patch() {
    return polygon_of(true);
}
bool NffReader::polygon_of(bool with_normals) {
    double count = 0.0;
    if (!numbers(&count, 1)) return false;
    // A vertex takes at least six bytes: "0 0 0" and a separator.
    const double most = double(cursor_.bytes_left() / (with_normals ? 12 : 6) + 1);
    if (!(count >= 3.0 && count <= most) || count != std::floor(count)) {
        error(statement_, count < 3.0 || count != std::floor(count)
                              ? "the number of vertices must be a whole number of at least 3"
                              : "the file is too short for so many vertices");
        return false;
    }
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;
    for (double i = 0.0; i < count; i += 1.0) {
        if (!vector(vertices.emplace_back())) return false;
        if (with_normals && !vector(normals.emplace_back())) return false;
    }
    builder_.add_polygon(vertices, normals, statement_);
    return true;
}

bool NffReader::textured_triangle() {
    return triangle_of(5);
}
bool NffReader::textured_patch() {
    return triangle_of(8);
}
bool NffReader::triangle_of(int numbers_per_vertex) {
    if (!cursor_.skip_to_word(kComments)) return numbers(nullptr, 0);
    cursor_.word();
    warn_once("texture", "textures of AFF are ignored");
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;
    for (int i = 0; i < 3; ++i) {
        double n[8];
        if (!numbers(n, numbers_per_vertex)) return false;
        vertices.push_back({n[0], n[1], n[2]});
        if (numbers_per_vertex == 8) normals.push_back({n[3], n[4], n[5]});
    }
    builder_.add_polygon(vertices, normals, statement_);
    return true;
}

bool NffReader::vector(Vec3& v) {
    return numbers(&v.x, 3);
}
bool NffReader::color(Rgb& c) {
    return numbers(&c.r, 3);
}
bool NffReader::numbers(double* values, int count) {
    for (int i = 0; i < count; ++i) {
        const bool any = cursor_.skip_to_word(kComments);
        if (any && cursor_.number(values[i])) continue;
        error(cursor_.location(file_), "'" + statement_name_ + "' of line " +
                                           std::to_string(statement_.line) +
                                           ": expected a number, found " +
                                           (any ? cursor_.shown_word() : "the end of the file"));
        return false;
    }
    return true;
}
bool NffReader::at_number() {
    if (!cursor_.skip_to_word(kComments)) return false;
    const char c = cursor_.peek();
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

void NffReader::error(const FileLocation& where, const std::string& message) {
    diagnostics_.error(where, message);
    ++errors_;
}
void NffReader::warn_of_two(bool given) {
    // A second view was warned of as a whole.
    if (given && (views_ < 2 || statement_name_ == "b")) {
        warn_once(statement_name_, "'" + statement_name_ + "' is given twice; the last counts");
    }
}
void NffReader::warn_once(const std::string& what, const std::string& message) {
    if (std::find(warned_.begin(), warned_.end(), what) != warned_.end()) return;
    warned_.push_back(what);
    diagnostics_.warning(statement_, message);
}

}  // namespace alhazen
