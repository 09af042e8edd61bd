#include "alhazen/formats/brlcad/brlcad_view.h"

#include <array>
#include <cmath>

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

/// Reads the statements of a script, separated by semicolons.
class ViewReader {
  public:
    ViewReader(std::string_view text, const std::string& file, const Box3& box,
               Diagnostics& diagnostics)
        : file_(file), fit_(box), diagnostics_(diagnostics) {
        // A shell script contains the input for `rt` in a here-document.
        std::int64_t line = 1;
        const std::size_t document = text.find("<<");
        if (document != std::string_view::npos) {
            std::size_t end = text.find('\n', document);
            if (end == std::string_view::npos) end = text.size();
            std::string_view mark = text.substr(document + 2, end - document - 2);
            while (!mark.empty() && TextCursor::is_space(mark.back())) mark.remove_suffix(1);
            for (const char c : text.substr(0, std::min(end + 1, text.size()))) line += c == '\n';
            text.remove_prefix(std::min(end + 1, text.size()));
            const std::size_t last = text.find("\n" + std::string(mark));
            if (!mark.empty() && last != std::string_view::npos) text = text.substr(0, last + 1);
        }
        text_ = text;
        line_ = line;
    }

    std::vector<CameraDescription> read() {
        while (!text_.empty()) {
            const std::size_t end = std::min(text_.find(';'), text_.size());
            statement(text_.substr(0, end));
            for (const char c : text_.substr(0, end)) line_ += c == '\n';
            text_.remove_prefix(std::min(end + 1, text_.size()));
        }
        if (changed_) finish_frame();
        if (cameras_.empty()) {
            diagnostics_.error({file_, 0, 0},
                               "no view in the script; expected viewsize, eye_pt, orientation, "
                               "viewrot or ae");
        }
        return std::move(cameras_);
    }

  private:
    void statement(std::string_view text) {
        TextCursor cursor(text, line_);
        if (!cursor.skip_to_word("#")) return;
        where_ = cursor.location(file_);
        const std::string_view command = cursor.word();
        std::array<double, 16> v{};
        const auto read = [&](std::size_t count) { return numbers(cursor, {v.data(), count}); };
        if (command == "viewsize") {
            if (read(1) && positive(v[0])) size_ = v[0];
        } else if (command == "eye_pt") {
            if (read(3)) eye_ = Vec3{v[0], v[1], v[2]};
        } else if (command == "orientation") {
            if (read(4)) set_orientation(v[0], v[1], v[2], v[3]);
        } else if (command == "viewrot") {
            if (read(16)) {
                frame_ = {{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, {v[8], v[9], v[10]}};
            }
        } else if (command == "ae") {
            if (read(2)) frame_ = brlcad_frame(v[0], v[1]);
        } else if (command == "lookat_pt") {
            if (numbers(cursor, {v.data(), 3})) look_at_ = Vec3{v[0], v[1], v[2]};
        } else if (command == "start") {
            frame_name_ = cursor.skip_to_word() ? std::string(cursor.word()) : "";
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
        perspective_deg_ = angle;
    }

    void set_orientation(double x, double y, double z, double w) {
        const double n = x * x + y * y + z * z + w * w;
        if (!(n > 0.0)) return diagnostics_.error(where_, "an orientation must not be zero");
        const double s = 2.0 / n;
        frame_.right = {1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)};
        frame_.up = {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)};
        frame_.to_eye = {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)};
    }

    void finish_frame() {
        changed_ = false;
        BrlcadFrame frame = frame_;
        const double size = size_.value_or(fit_.size);
        if (!(size > 0.0)) {
            return diagnostics_.error(where_, "neither the view nor the model has a size");
        }
        const Vec3 eye = eye_.value_or(fit_.eye(frame.to_eye, size));
        if (look_at_) {
            const Vec3 d = eye - *look_at_;
            if (!(length(d) > 0.0)) {
                return diagnostics_.error(where_, "lookat_pt is the position of the eye");
            }
            const double flat = std::hypot(d.x, d.y);
            frame = brlcad_frame(flat > 0.0 ? std::atan2(d.y, d.x) / kRadiansPerDegree : 0.0,
                                 std::atan2(d.z, flat) / kRadiansPerDegree);
        }
        CameraDescription camera;
        camera.name = "frame " + (frame_name_.empty() ? std::to_string(cameras_.size())
                                                      : frame_name_.substr(0, 40));
        camera.location = where_;
        if (perspective_deg_ > 0.0) {
            const double width = 2.0 * std::tan(0.5 * perspective_deg_ * kRadiansPerDegree);
            camera.camera =
                PerspectiveCamera{eye, -frame.to_eye, width * frame.right, width * frame.up};
        } else {
            camera.camera = parallel_camera(frame, eye, size);
        }
        cameras_.push_back(std::move(camera));
    }

    std::string_view text_;
    std::int64_t line_ = 1;
    const std::string& file_;
    Fit fit_;
    Diagnostics& diagnostics_;
    FileLocation where_;
    BrlcadFrame frame_ = brlcad_frame(35, 25);
    std::optional<double> size_;
    std::optional<Vec3> eye_, look_at_;
    double perspective_deg_ = 0;
    std::string frame_name_;
    bool changed_ = false;
    std::vector<CameraDescription> cameras_;
};

}  // namespace

std::vector<CameraDescription> read_brlcad_views(std::string_view text, const std::string& file,
                                                 const Box3& box, Diagnostics& diagnostics) {
    return ViewReader(text, file, box, diagnostics).read();
}

std::optional<Rgb> brlcad_view_background(std::string_view text) {
    const std::string_view command = text.substr(0, text.find("<<"));
    if (command.size() == text.size()) return std::nullopt;
    const std::size_t at = command.find(" -C");
    if (at == std::string_view::npos) return std::nullopt;
    std::string values(command.substr(at + 3, 100));
    for (char& c : values) c = c == '/' || c == ',' || c == '"' || c == '\'' || c == '\\' ? ' ' : c;
    TextCursor cursor(values);
    std::array<double, 3> c{};
    for (double& value : c) {
        if (!cursor.skip_to_word() || !cursor.number(value)) return std::nullopt;
    }
    return brlcad_color(c[0], c[1], c[2]);
}

}  // namespace alhazen
