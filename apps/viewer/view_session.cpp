#include "view_session.h"

#include <atomic>
#include <chrono>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/explain/explanation.h"
#include "alhazen/explain/page/explanation_json.h"
#include "alhazen/imaging/codecs/jpeg.h"
#include "alhazen/imaging/codecs/png.h"
#include "alhazen/imaging/image/screen_pixels.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/session/environment_option.h"
#include "alhazen/session/picture.h"
#include "frame_protocol.h"
#include "wish_values.h"

namespace alhazen::viewer {

namespace {

using json = nlohmann::ordered_json;

std::string text_of(const json& value) {
    return value.dump(-1, ' ', true, json::error_handler_t::replace);
}
Response failure(int status, const std::string& message) {
    return {status, "application/json", text_of({{"error", message}}), "", ""};
}
Response closed() {
    return failure(503, "the viewer is closing");
}
Response overtaken() {
    return {204, "text/plain", "", "", ""};
}

/// Four bytes per pixel, in the format of a canvas.
std::string raw_pixels(const EncodedImage& image) {
    const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
    const std::size_t channels = image.channels;
    const int shift = image.bits - 8;
    std::string bytes(4 * pixels, '\xff');
    for (std::size_t i = 0; i < pixels; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t from = channels * i + (channels < 3 ? 0 : c);
            bytes[4 * i + c] = static_cast<char>(image.samples[from] >> shift);
        }
    }
    return bytes;
}
/// Four bytes per pixel, encoded from a film by all threads.
std::string raw_pixels(const Film& film, Encoding encoding, int threads) {
    constexpr std::size_t kAtOnce = 16384;  // pixels per task
    const std::size_t pixels = film.crop().area();
    std::string bytes(4 * pixels, '\0');
    const auto write = [&](std::size_t begin, std::size_t end) {
        write_screen_pixels(film.data() + 3 * begin, end - begin, encoding,
                            reinterpret_cast<std::uint8_t*>(bytes.data()) + 4 * begin);
    };
    ThreadLimit(threads).run([&] { parallel_for(pixels, kAtOnce, write); });
    return bytes;
}

Response picture_answer(const EncodedImage& image, const FrameWish& wish, const json& facts) {
    if (wish.raw) return {200, "application/octet-stream", raw_pixels(image), text_of(facts), ""};
    const std::vector<std::byte> bytes = wish.png ? encode_png(image, {}) : encode_jpeg(image, 85);
    return {200, wish.png ? "image/png" : "image/jpeg",
            std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), text_of(facts),
            ""};
}

/// The picture of a frame; facts of a layer are added.
EncodedImage picture_of(const RenderResult& result, const FrameWish& wish,
                        const FilmConventions& conventions, json& facts) {
    if (wish.layer == nullptr) {
        PictureOptions picture;
        picture.tone = wish.tone;
        return encoded_picture(result.film, conventions, picture);
    }
    LayerPicture layer = layer_picture(*wish.layer, result.layers, false);
    json scale{{"name", wish.layer->name}, {"meaning", layer.meaning}};
    if (layer.colors) {
        scale["low"] = layer.colors->low;
        scale["high"] = layer.colors->high;
        scale["colors"] = layer.colors->colors == ColorScale::Colors::Heat ? "heat" : "grey";
    }
    facts["layer"] = std::move(scale);
    return std::move(layer.image);
}

bool same(const PicturePlane& a, const PicturePlane& b) {
    return a.eye == b.eye && a.forward == b.forward && a.right == b.right && a.up == b.up;
}

/// A view that is still where a camera of the scene is becomes that camera, with its motion.
void take_camera(FrameWish& wish, const Scene& scene) {
    if (wish.of >= scene.cameras.size()) return;
    const CameraDescription& own = scene.cameras[wish.of];
    if (own.camera.index() != wish.camera.camera.index()) return;
    if (!same(picture_plane(own.camera), picture_plane(wish.camera.camera))) return;
    wish.camera = own;
}

/// The changes that may move surfaces. A scene without lights of its own has none; its headlight
/// depends on the camera.
std::vector<LightChange> surfaces_in(const FrameWish& wish, const AddedLights& added) {
    return added.of_cameras.empty() ? wish.lighting.changes : std::vector<LightChange>();
}

}  // namespace

/// Registers the work of a client until destruction, and ends its previous work.
class ViewSession::Turn final : public ProgressSink {
  public:
    using Clock = std::chrono::steady_clock;

    /// `flag` also ends the work; null: the turn has its own.
    Turn(ViewSession& session, const json& wish, std::string what, std::shared_ptr<StopFlag> flag)
        : session_(session),
          client_(text_in(wish, "client", "")),
          what_(std::move(what)),
          flag_(flag ? std::move(flag) : std::make_shared<StopFlag>()) {
        const std::lock_guard lock(session.turns_mutex_);
        Turn*& place = session.turns_[client_];
        if (place != nullptr) place->flag_->request();
        place = this;
        if (session.closing_) flag_->request();
    }
    ~Turn() override {
        const std::lock_guard lock(session_.turns_mutex_);
        const auto place = session_.turns_.find(client_);
        if (place != session_.turns_.end() && place->second == this) session_.turns_.erase(place);
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    void update(std::string_view, std::size_t done, std::size_t total) override {
        part_ = total == 0 ? 0.0 : static_cast<double>(done) / static_cast<double>(total);
    }

    [[nodiscard]] const StopFlag& flag() const { return *flag_; }
    void stop() { flag_->request(); }
    /// The response of a turn that was ended.
    [[nodiscard]] Response ended() const {
        const std::lock_guard lock(session_.turns_mutex_);
        return session_.closing_ ? closed() : overtaken();
    }
    /// Its description for pages.
    [[nodiscard]] json work() const {
        const std::chrono::duration<double> spent = Clock::now() - since_;
        json work{{"what", what_}, {"seconds", spent.count()}, {"client", client_}};
        if (const double part = part_; part > 0.0) work["part"] = part;
        return work;
    }

  private:
    ViewSession& session_;
    std::string client_, what_;
    std::shared_ptr<StopFlag> flag_;
    const Clock::time_point since_ = Clock::now();
    std::atomic<double> part_{0.0};  ///< fraction done
};

ViewSession::ViewSession(std::filesystem::path scene, LoadOptions options, int threads)
    : scenes_(std::move(scene), std::move(options)), threads_(threads) {}
ViewSession::~ViewSession() = default;

Response ViewSession::state(const std::string& known) const {
    const bool knows = !known.empty();
    json state = scenes_.state(knows ? std::stoull(known) : ~std::uint64_t{0});
    {
        const std::lock_guard lock(turns_mutex_);
        for (const auto& [client, turn] : turns_) state["work"].push_back(turn->work());
    }
    std::string version = std::to_string(state["version"].get<std::uint64_t>());
    return {200, "application/json", text_of(state), "", std::move(version)};
}

std::optional<Scene> ViewSession::lit(const Scene& scene, const SceneStore::Loaded& here,
                                      const FrameWish& wish) {
    Lighting lighting = wish.lighting;
    const SceneDescription& description = here.scene.description;
    const bool follows = follows_light(wish.options.renderer);
    if (follows && here.added.studio && lighting.environment.empty()) {
        lighting.environment = "studio";
    }
    if (lighting.is_that_of_the_scene() && !here.added.is_left_out(follows, lighting) &&
        !here.added.of_view(wish.camera.camera)) {
        return std::nullopt;
    }
    if (!lighting.environment.empty()) {
        const std::lock_guard lock(surroundings_mutex_);
        const auto [place, is_new] =
            surroundings_.try_emplace({lighting.environment, description.up_axis});
        if (is_new) place->second = make_environment(lighting.environment, description.up_axis);
        lighting.surroundings = place->second;
    }
    return with_lighting(scene, description, lighting, here.added, wish.camera.camera, follows);
}

Response ViewSession::frame(const json& request, Turn& turn) {
    FrameWish wish = frame_wish(request);
    const auto here = scenes_.with(text_in(request, "accelerator", ""), turn.flag());
    take_camera(wish, here->scene.scene);
    wish.options.view = &wish.camera;
    wish.options.threads = threads_;
    wish.options.stop = &turn.flag();
    wish.options.progress = &turn;
    if (turn.flag().requested()) return turn.ended();
    const auto placed = scenes_.moved(here, surfaces_in(wish, here->added), turn.flag());
    const std::optional<Scene> other = lit(placed->scene.scene, *here, wish);
    const RenderResult result = render_with_description(other ? *other : placed->scene.scene,
                                                        placed->scene.description, wish.options);
    if (!result.complete) return turn.ended();
    json facts{{"seconds", result.seconds},    {"rays", result.counters.total_cast()},
               {"threads", result.threads},    {"version", here->version},
               {"width", *wish.options.width}, {"height", *wish.options.height}};
    const FilmConventions& film = here->scene.scene.conventions.film;
    if (wish.raw && wish.layer == nullptr && wish.tone.changes_nothing()) {
        return {200, "application/octet-stream", raw_pixels(result.film, film.encoding(), threads_),
                text_of(facts), ""};
    }
    Response answer;
    ThreadLimit(threads_).run(
        [&] { answer = picture_answer(picture_of(result, wish, film, facts), wish, facts); });
    return answer;
}

Response ViewSession::explain(const json& request, Turn& turn) {
    FrameWish wish = frame_wish(request);
    const auto here = scenes_.with(text_in(request, "accelerator", ""), turn.flag());
    take_camera(wish, here->scene.scene);
    const auto placed = scenes_.moved(here, surfaces_in(wish, here->added), turn.flag());
    const std::optional<Scene> other = lit(placed->scene.scene, *here, wish);
    ExplainOptions options;
    options.scene = other ? &*other : nullptr;
    options.render = wish.options;
    options.render.aovs = {};
    options.render.antialias.reset();  // the tree is of one ray
    options.render.view = &wish.camera;
    options.render.threads = threads_;
    options.render.stop = &turn.flag();
    options.x = whole_in(request, "x", {}, 0, *wish.options.width - 1);
    options.y = whole_in(request, "y", {}, 0, *wish.options.height - 1);
    options.sample = whole_in(request, "sample", 0, 0, wish.options.samples_per_pixel - 1);
    options.accelerator = text_in(request, "steps", options.accelerator);
    const Interruptible ends(&turn.flag());  // further accelerators are built
    const Explanation explanation = explain_pixel(placed->scene, options);
    if (!explanation.complete) return turn.ended();
    return {200, "application/json", explanation_json(explanation, -1), "", ""};
}

Response ViewSession::blocks(const json& wish) {
    const StopFlag never;
    const auto here = scenes_.with("", never);
    const SceneDescription& description = here->scene.description;
    const std::size_t camera = camera_number(wish);
    const std::string text =
        here->added.is_another(camera)
            ? changed_light_blocks(lights_of(description, here->added.of_cameras[camera]),
                                   light_changes(wish))
            : changed_light_blocks(description, light_changes(wish));
    return {200, "application/json", text_of({{"text", text}}), "", ""};
}

Response ViewSession::stop(const json& wish) {
    scenes_.stop();
    const std::lock_guard lock(turns_mutex_);
    const auto turn = turns_.find(text_in(wish, "client", ""));
    if (turn != turns_.end()) turn->second->stop();
    return {200, "application/json", "{}", "", ""};
}

void ViewSession::close() {
    scenes_.stop();
    const std::lock_guard lock(turns_mutex_);
    closing_ = true;
    for (const auto& [client, turn] : turns_) turn->stop();
}

Response ViewSession::answer(const Request& request) {
    try {
        if (request.path == "/state" && request.body.empty()) return state(request.known);
        const json wish = wish_json(request.body);
        if (request.path == "/state") return state(request.known);
        const auto in_turn = [&](std::string what, auto answer) {
            Turn turn(*this, wish, std::move(what), request.stop);
            try {
                return (this->*answer)(wish, turn);
            } catch (const Interrupted&) {
                return turn.ended();
            }
        };
        if (request.path == "/frame") return in_turn("drawing", &ViewSession::frame);
        if (request.path == "/explain") return in_turn("explaining", &ViewSession::explain);
        if (request.path == "/blocks") return blocks(wish);
        if (request.path == "/stop") return stop(wish);
        if (request.path == "/read") {
            scenes_.read_again();
            return {200, "application/json", "{}", "", ""};
        }
        return failure(404, "there is no such question");
    } catch (const json::exception&) {
        return failure(400, "a value of the request has the wrong type");
    } catch (const Error& error) {
        return failure(error.kind() == ErrorKind::Usage ? 400 : 500, error.what());
    } catch (const std::exception& error) {
        return failure(500, error.what());
    }
}

}  // namespace alhazen::viewer
