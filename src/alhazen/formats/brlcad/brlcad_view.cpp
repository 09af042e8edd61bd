#include "alhazen/formats/brlcad/brlcad_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

#include "alhazen/formats/brlcad/brlcad_database.h"
#include "alhazen/formats/text/text_cursor.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

/// Cosine and sine of an angle; exact at quarter turns.
Vec2 turn(double degrees) {
    const double rest = std::fmod(degrees, 360.0);
    const double positive = rest < 0.0 ? rest + 360.0 : rest;
    if (positive == 0.0) return {1, 0};
    if (positive == 90.0) return {0, 1};
    if (positive == 180.0) return {-1, 0};
    if (positive == 270.0) return {0, -1};
    return {std::cos(degrees * kRadiansPerDegree), std::sin(degrees * kRadiansPerDegree)};
}

/// The model's box rounded out to whole millimetres, and the view that fits it.
struct Fit {
    Vec3 center;
    double size = 0;

    explicit Fit(const Box3& box) {
        if (box.empty()) return;
        const Vec3 lo{std::floor(box.lo.x), std::floor(box.lo.y), std::floor(box.lo.z)};
        const Vec3 hi{std::ceil(box.hi.x), std::ceil(box.hi.y), std::ceil(box.hi.z)};
        center = 0.5 * (lo + hi);
        size = length(hi - lo);
    }
    [[nodiscard]] bool exists() const { return size > 0.0 && std::isfinite(size); }
    [[nodiscard]] Vec3 eye(const Vec3& to_eye, double view_size) const {
        return center + (std::sqrt(2.0) * 0.5 * view_size) * to_eye;
    }
};

OrthographicCamera parallel_camera(const BrlcadFrame& frame, const Vec3& eye, double size) {
    return {eye, -frame.to_eye, size * frame.right, size * frame.up};
}

}  // namespace

BrlcadFrame brlcad_frame(double azimuth_deg, double elevation_deg) {
    const Vec2 a = turn(azimuth_deg);
    const Vec2 e = turn(elevation_deg);
    BrlcadFrame frame;
    frame.right = {-a.y, a.x, 0.0};
    frame.up = {-a.x * e.y, -a.y * e.y, e.x};
    frame.to_eye = {a.x * e.x, a.y * e.x, e.y};
    return frame;
}

std::vector<CameraDescription> brlcad_cameras(const Box3& box, const FileLocation& where) {
    struct Named {
        const char* name;
        double azimuth, elevation;
    };
    static constexpr Named kViews[] = {{"35,25", 35, 25}, {"45,45", 45, 45},   {"front", 0, 0},
                                       {"left", 90, 0},   {"rear", 180, 0},    {"right", 270, 0},
                                       {"top", 270, 90},  {"bottom", 270, -90}};
    std::vector<CameraDescription> cameras;
    const Fit fit(box);
    if (!fit.exists()) return cameras;
    for (const Named& view : kViews) {
        const BrlcadFrame frame = brlcad_frame(view.azimuth, view.elevation);
        cameras.push_back({view.name,
                           parallel_camera(frame, fit.eye(frame.to_eye, fit.size), fit.size), 1.0,
                           where});
    }
    return cameras;
}

namespace {

/// A script of `rt`, and the command with which a shell script calls `rt` for it.
struct ViewScript {
    std::string_view command, text;
    std::int64_t line = 1;  ///< of the first line of `text`
};

/// The mark of a here-document, the first word behind `<<` without `-` and quotes.
std::string here_mark(std::string_view word) {
    std::string mark;
    bool begun = false;
    for (const char c : word) {
        if (TextCursor::is_space(c)) {
            if (begun) break;
        } else if (begun || c != '-') {
            begun = true;
            if (c != '\'' && c != '"' && c != '\\') mark += c;
        }
    }
    return mark;
}

/// The place of the line that is `mark`, or the size of the text.
std::size_t line_of_mark(std::string_view text, const std::string& mark) {
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        std::string_view line = text.substr(at, end - at);
        while (!line.empty() && TextCursor::is_space(line.back())) line.remove_suffix(1);
        while (!line.empty() && line.front() == '\t') line.remove_prefix(1);
        if (!mark.empty() && line == mark) return at;
        at = end + 1;
    }
    return text.size();
}

/// The here-documents of a shell script (`saveview` adds one for each view), or the text itself.
std::vector<ViewScript> view_scripts(std::string_view text) {
    std::vector<ViewScript> scripts;
    std::int64_t line = 1;
    const auto pass = [&](std::size_t size) {
        line += std::count(text.begin(), text.begin() + std::ptrdiff_t(size), '\n');
        text.remove_prefix(size);
    };
    for (;;) {
        const std::size_t document = text.find("<<");
        if (document == std::string_view::npos) break;
        const std::size_t end = std::min(text.find('\n', document), text.size() - 1);
        const std::string mark = here_mark(text.substr(document + 2, end - document - 1));
        const std::string_view command = text.substr(0, document);
        pass(end + 1);
        const std::size_t size = line_of_mark(text, mark);
        scripts.push_back({command, text.substr(0, size), line});
        pass(std::min(size + mark.size(), text.size()));
    }
    if (scripts.empty()) scripts.push_back({{}, text, 1});
    return scripts;
}

/// The numbers of an option `-xN`, `-x N`, `-x N/N/N` of a command.
bool option_numbers(std::string_view command, char letter, std::span<double> values) {
    std::size_t at = command.find(std::string(" -") + letter);
    if (at == std::string_view::npos) return false;
    std::string text(command.substr(at + 3, 100));
    for (char& c : text) c = c == '/' || c == ',' || c == '"' || c == '\'' || c == '\\' ? ' ' : c;
    TextCursor cursor(text);
    return std::all_of(values.begin(), values.end(), [&](double& value) {
        return cursor.skip_to_word() && cursor.number(value);
    });
}

/// Reads the statements of a script, separated by semicolons.
class ViewReader {
  public:
    ViewReader(const std::string& file, const Box3& box, Diagnostics& diagnostics)
        : file_(file), fit_(box), diagnostics_(diagnostics) {}

    /// Adds the cameras of a script. Each run of `rt` begins with its own defaults.
    void read(const ViewScript& script) {
        state_ = State{};
        ++scripts_;
        double angle = 0.0;
        if (option_numbers(script.command, 'p', {&angle, 1}) && angle >= 0.0 && angle < 180.0) {
            state_.perspective_deg = angle;
        }
        std::string_view text = script.text;
        std::int64_t line = script.line;
        while (!text.empty()) {
            const std::size_t end = std::min(text.find(';'), text.size());
            statement(text.substr(0, end), line);
            line += std::count(text.begin(), text.begin() + std::ptrdiff_t(end), '\n');
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (changed_) finish_frame();
    }

    std::vector<CameraDescription> cameras() {
        if (cameras_.empty()) {
            diagnostics_.error({file_, 0, 0},
                               "no view in the script; expected viewsize, eye_pt, orientation, "
                               "viewrot or ae");
        }
        return std::move(cameras_);
    }

  private:
    void statement(std::string_view text, std::int64_t line) {
        TextCursor cursor(text, line);
        if (!cursor.skip_to_word("#")) return;
        where_ = cursor.location(file_);
        const std::string_view command = cursor.word();
        std::array<double, 16> v{};
        const auto read = [&](std::size_t count) { return numbers(cursor, {v.data(), count}); };
        if (command == "viewsize") {
            if (read(1) && positive(v[0])) state_.size = v[0];
        } else if (command == "eye_pt") {
            if (read(3)) state_.eye = Vec3{v[0], v[1], v[2]};
        } else if (command == "orientation") {
            if (read(4)) set_orientation(v[0], v[1], v[2], v[3]);
        } else if (command == "viewrot") {
            if (read(16)) {
                state_.frame = {{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, {v[8], v[9], v[10]}};
            }
        } else if (command == "ae") {
            if (read(2)) state_.frame = brlcad_frame(v[0], v[1]);
        } else if (command == "lookat_pt") {
            if (read(3)) look_at({v[0], v[1], v[2]}, cursor);
        } else if (command == "start") {
            state_.name = cursor.skip_to_word() ? std::string(cursor.word()) : "";
            return;
        } else if (command == "end") {
            finish_frame();
            return;
        } else if (command == "set") {
            set(cursor);
        } else if (command != "clean" && command != "attr") {
            diagnostics_.warning(where_, "'" + std::string(command.substr(0, 40)) +
                                             "' of a view script is not read");
            return;
        }
        changed_ = true;
    }

    bool numbers(TextCursor& cursor, std::span<double> values) {
        for (double& value : values) {
            if (cursor.skip_to_word() && cursor.number(value)) continue;
            diagnostics_.error(where_, "expected " + std::to_string(values.size()) +
                                           " numbers, found " + cursor.shown_word());
            return false;
        }
        return true;
    }
    bool positive(double value) {
        if (value > 0.0) return true;
        diagnostics_.error(where_, "the size of a view must be positive");
        return false;
    }

    /// Reads set perspective=ANGLE.
    void set(TextCursor& cursor) {
        if (!cursor.skip_to_word()) return;
        const std::string_view word = cursor.word();
        const std::size_t equals = word.find('=');
        if (word.substr(0, equals) != "perspective") return;
        TextCursor value(equals == std::string_view::npos ? "" : word.substr(equals + 1));
        double angle = 0.0;
        const bool given =
            value.at_end() ? cursor.skip_to_word() && cursor.number(angle) : value.number(angle);
        if (!given || !(angle >= 0.0 && angle < 180.0)) {
            diagnostics_.error(where_, "expected set perspective=ANGLE, 0 to 180 degrees");
            return;
        }
        state_.perspective_deg = angle;
    }

    /// Turns the view towards `point` from the present eye, `rt`'s mat_lookat: the projection of
    /// the x axis points to the right. A fourth number other than 0 keeps the z axis upwards by a
    /// reflection.
    void look_at(const Vec3& point, TextCursor& cursor) {
        double flip = 0.0;
        if (cursor.skip_to_word() && !cursor.number(flip)) {
            return diagnostics_.error(where_,
                                      "expected the number yflip, found " + cursor.shown_word());
        }
        const Vec3 d = point - state_.eye.value_or(Vec3{});
        const double least = 1e-10;  // rt's limit for the projection
        if (!(length(d) > 0.0)) {
            state_.frame = brlcad_frame(0, 0);  // rt's orientation for this case, from the front
            return;
        }
        const Vec3 to_eye = -normalize(d);
        const Vec3 right = Vec3{1, 0, 0} - to_eye.x * to_eye;
        BrlcadFrame& frame = state_.frame;
        frame.to_eye = to_eye;
        frame.right = length(right) < least ? Vec3{0, 0, 1} : normalize(right);
        frame.up = cross(to_eye, frame.right);
        if (flip != 0.0 && frame.up.z < 0.0) frame.up = -frame.up;
    }

    void set_orientation(double x, double y, double z, double w) {
        const double n = x * x + y * y + z * z + w * w;
        if (!(n > 0.0)) return diagnostics_.error(where_, "an orientation must not be zero");
        const double s = 2.0 / n;
        state_.frame.right = {1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)};
        state_.frame.up = {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)};
        state_.frame.to_eye = {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)};
    }

    void finish_frame() {
        changed_ = false;
        const BrlcadFrame& frame = state_.frame;
        const double size = state_.size.value_or(fit_.size);
        if (!(size > 0.0)) {
            return diagnostics_.error(where_, "neither the view nor the model has a size");
        }
        const Vec3 eye = state_.eye.value_or(fit_.eye(frame.to_eye, size));
        CameraDescription camera;
        camera.name = unused_name();
        camera.location = where_;
        if (state_.perspective_deg > 0.0) {
            const double width = 2.0 * std::tan(0.5 * state_.perspective_deg * kRadiansPerDegree);
            camera.camera =
                PerspectiveCamera{eye, -frame.to_eye, width * frame.right, width * frame.up};
        } else {
            camera.camera = parallel_camera(frame, eye, size);
        }
        cameras_.push_back(std::move(camera));
    }

    /// The name of the frame, or its number, with that of its script where another has the name.
    std::string unused_name() {
        const std::string number = std::to_string(cameras_.size());
        std::string name = "frame " + (state_.name.empty() ? number : state_.name.substr(0, 40));
        if (names_.contains(name)) name += " of view " + std::to_string(scripts_ - 1);
        if (names_.contains(name)) name += ", camera " + number;
        names_.insert(name);
        return name;
    }

    /// What commands set, for all frames that follow.
    struct State {
        BrlcadFrame frame = brlcad_frame(35, 25);
        std::optional<double> size;
        std::optional<Vec3> eye;
        double perspective_deg = 0;
        std::string name;
    };

    const std::string& file_;
    Fit fit_;
    Diagnostics& diagnostics_;
    FileLocation where_;
    State state_;
    std::size_t scripts_ = 0;  ///< read so far
    std::set<std::string> names_;
    bool changed_ = false;
    std::vector<CameraDescription> cameras_;
};

}  // namespace

std::vector<CameraDescription> read_brlcad_views(std::string_view text, const std::string& file,
                                                 const Box3& box, Diagnostics& diagnostics) {
    ViewReader reader(file, box, diagnostics);
    for (const ViewScript& script : view_scripts(text)) reader.read(script);
    return reader.cameras();
}

std::optional<Rgb> brlcad_view_background(std::string_view text) {
    std::array<double, 3> c{};
    if (!option_numbers(view_scripts(text).front().command, 'C', c)) return std::nullopt;
    return brlcad_color(c[0], c[1], c[2]);
}

}  // namespace alhazen
