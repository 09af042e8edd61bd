#include "view_session.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/explain/explanation.h"
#include "alhazen/explain/page/explanation_json.h"
#include "alhazen/imaging/codecs/jpeg.h"
#include "alhazen/imaging/codecs/png.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/framing.h"
#include "alhazen/session/picture.h"

namespace alhazen::viewer {

namespace {

using json = nlohmann::ordered_json;

std::string text_of(const json& value) {
    return value.dump(-1, ' ', true, json::error_handler_t::replace);
}
Response failure(int status, const std::string& message) {
    return {status, "application/json", text_of({{"error", message}}), ""};
}

Response closed() {
    return failure(503, "the viewer is closing");
}

Vec3 vector_in(const json& wish, const char* key) {
    const json& v = wish.at(key);
    const Vec3 vector{v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
    if (!is_finite(vector)) throw Error(ErrorKind::Usage, "the camera is not finite");
    return vector;
}

Camera camera_in(const json& wish) {
    const Vec3 eye = vector_in(wish, "eye"), look = vector_in(wish, "look");
    const Vec3 right = vector_in(wish, "right"), up = vector_in(wish, "up");
    if (look == Vec3{} || right == Vec3{} || up == Vec3{}) {
        throw Error(ErrorKind::Usage, "the camera has no extent");
    }
    if (wish.value("parallel", false)) return OrthographicCamera{eye, look, right, up};
    return PerspectiveCamera{eye, look, right, up};
}

json camera_json(const CameraDescription& described) {
    const PicturePlane plane = picture_plane(described.camera);
    const auto list = [](const Vec3& v) { return json{v.x, v.y, v.z}; };
    return {{"name", described.name},
            {"eye", list(plane.eye)},
            {"look", list(plane.forward)},
            {"right", list(plane.right)},
            {"up", list(plane.up)},
            {"aspect", described.aspect},
            {"parallel", std::holds_alternative<OrthographicCamera>(described.camera)}};
}

/// Resident memory of the process.
std::uint64_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    file >> size >> resident;
    return resident * 4096;
}

int whole_in(const json& wish, const char* key, int fallback, int least, int most) {
    const int value = wish.value(key, fallback);
    if (value < least || value > most) {
        throw Error(ErrorKind::Usage,
                    fmt::format("{} must be {} to {}, found {}", key, least, most, value));
    }
    return value;
}

/// Of those in the table, the ones that need no other geometry than is loaded.
json renderer_menu() {
    json menu = json::array();
    for (const RendererEntry& entry : renderers()) {
        const auto renderer = make_renderer(entry.name);
        if (renderer->takes_triangles_within() > 0.0) continue;
        menu.push_back({{"name", entry.name}, {"what", entry.description}});
    }
    return menu;
}

}  // namespace

ViewSession::ViewSession(std::filesystem::path scene, LoadOptions options, int threads)
    : path_(std::move(scene)), load_(std::move(options)), threads_(threads) {
    load_scene();
}

void ViewSession::load_scene() {
    LoadedScene loaded = load(path_, load_);
    FramingOptions framing;
    framing.aspect = free_aspect(loaded.description.picture, {});
    (void)complete_view(loaded.description, loaded.scene, framing);
    own_camera_ = loaded.scene.cameras.size();
    loaded.scene.cameras.push_back(loaded.scene.cameras.front());
    loaded_ = std::move(loaded);
    error_.clear();
    FileTimes now = file_times();
    if (now != seen_) ++version_;
    seen_ = times_ = std::move(now);
}

ViewSession::FileTimes ViewSession::file_times() const {
    FileTimes times;
    std::error_code none;
    times[path_] = std::filesystem::last_write_time(path_, none);
    for (const auto& file : loaded_.description.files) {
        times[file] = std::filesystem::last_write_time(file, none);
    }
    return times;
}

void ViewSession::reload_if_changed() {
    const FileTimes now = file_times();
    if (now == times_) return;
    times_ = now;
    try {
        load_scene();
    } catch (const Error& error) {
        error_ = error.what();
    }
}

Response ViewSession::state() {
    const std::lock_guard lock(scene_mutex_);
    reload_if_changed();
    json cameras = json::array(), accelerators = json::array();
    for (std::size_t i = 0; i < own_camera_; ++i) {
        cameras.push_back(camera_json(loaded_.scene.cameras[i]));
    }
    for (const AcceleratorEntry& entry : accelerator_table()) {
        accelerators.push_back({{"name", entry.name}, {"what", entry.description}});
    }
    const FrameSize frame =
        frame_size(loaded_.description.picture, {}, loaded_.scene.cameras.front().aspect);
    return {200, "application/json",
            text_of({{"scene", path_.filename().string()},
                     {"version", version_},
                     {"error", error_},
                     {"memory", resident_bytes()},
                     {"width", frame.width},
                     {"height", frame.height},
                     {"up", loaded_.description.up_axis == UpAxis::Z ? "z" : "y"},
                     {"depth", loaded_.scene.conventions.shading.max_depth},
                     {"accelerator", load_.compile.accelerator},
                     {"cameras", std::move(cameras)},
                     {"renderers", renderer_menu()},
                     {"accelerators", std::move(accelerators)},
                     {"curves", kToneCurveNames},
                     {"steps", traceable_accelerators()}}),
            ""};
}

/// Also puts the camera of the page into the scene, and changes the accelerator.
RenderOptions ViewSession::options_of(const json& wish) {
    const std::string accelerator = wish.value("accelerator", load_.compile.accelerator);
    if (accelerator != load_.compile.accelerator) {
        check_accelerator(accelerator);
        const std::string before = std::exchange(load_.compile.accelerator, accelerator);
        try {
            load_scene();
        } catch (const Error&) {
            load_.compile.accelerator = before;
            throw;
        }
    }
    RenderOptions options;
    options.width = whole_in(wish, "width", 640, 1, 4096);
    options.height = whole_in(wish, "height", 360, 1, 4096);
    CameraDescription& own = loaded_.scene.cameras[own_camera_];
    own.camera = camera_in(wish.at("camera"));
    own.aspect = static_cast<double>(*options.width) / *options.height;
    own.keys.clear();
    options.camera = std::to_string(own_camera_);
    options.renderer = wish.value("renderer", "whitted");
    options.samples_per_pixel = whole_in(wish, "samples", 1, 1, 1024);
    if (wish.contains("depth")) options.max_depth = whole_in(wish, "depth", 5, 0, 100);
    options.threads = threads_;
    return options;
}

Response ViewSession::frame(const json& wish) {
    const auto own = std::make_shared<StopFlag>();
    {
        const std::lock_guard lock(newest_mutex_);
        if (closing_) return closed();
        if (newest_) newest_->request();
        newest_ = own;
    }
    const std::lock_guard lock(scene_mutex_);
    if (own->requested()) return {204, "text/plain", "", ""};
    RenderOptions options = options_of(wish);
    options.stop = own.get();
    const RenderResult result = render(loaded_, options);
    if (!result.complete) return {204, "text/plain", "", ""};
    PictureOptions picture;
    picture.tone.stops = wish.value("exposure", 0.0);
    if (!(std::abs(picture.tone.stops) <= 64.0)) throw Error(ErrorKind::Usage, "bad exposure");
    const std::string curve = wish.value("curve", "none");
    const auto* const names = std::begin(kToneCurveNames);
    const auto* const found = std::find(names, std::end(kToneCurveNames), curve);
    if (found == std::end(kToneCurveNames)) throw Error(ErrorKind::Usage, "no such curve");
    picture.tone.curve = static_cast<ToneCurve>(found - names);
    const EncodedImage image =
        encoded_picture(result.film, loaded_.scene.conventions.film, picture);
    const bool png = wish.value("png", false);
    const std::vector<std::byte> bytes = png ? encode_png(image, {}) : encode_jpeg(image, 85);
    return {200, png ? "image/png" : "image/jpeg",
            std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
            text_of({{"seconds", result.seconds},
                     {"rays", result.counters.total_cast()},
                     {"threads", result.threads},
                     {"version", version_}})};
}

Response ViewSession::explain(const json& wish) {
    {  // The frame in hand can be rendered again.
        const std::lock_guard lock(newest_mutex_);
        if (closing_) return closed();
        if (newest_) newest_->request();
    }
    const std::lock_guard lock(scene_mutex_);
    ExplainOptions options;
    options.render = options_of(wish);
    options.x = wish.at("x").get<int>();
    options.y = wish.at("y").get<int>();
    options.accelerator = wish.value("steps", options.accelerator);
    return {200, "application/json", explanation_json(explain_pixel(loaded_, options), -1), ""};
}

void ViewSession::close() {
    const std::lock_guard lock(newest_mutex_);
    closing_ = true;
    if (newest_) newest_->request();
}

Response ViewSession::answer(const Request& request) {
    try {
        if (request.path == "/state") return state();
        const json wish = json::parse(request.body);
        if (request.path == "/frame") return frame(wish);
        if (request.path == "/explain") return explain(wish);
        return failure(404, "there is no such question");
    } catch (const json::exception& error) {
        return failure(400, error.what());
    } catch (const Error& error) {
        return failure(error.kind() == ErrorKind::Usage ? 400 : 500, error.what());
    } catch (const std::exception& error) {
        return failure(500, error.what());
    }
}

}  // namespace alhazen::viewer
