#include "view_session.h"

#include <fstream>
#include <utility>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/explain/explanation.h"
#include "alhazen/explain/page/explanation_json.h"
#include "alhazen/imaging/codecs/jpeg.h"
#include "alhazen/imaging/codecs/png.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/session/framing/framing.h"
#include "alhazen/session/picture.h"
#include "view_menus.h"
#include "view_wishes.h"

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
Response overtaken() {
    return {204, "text/plain", "", ""};
}

/// Resident memory of the process.
std::uint64_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    file >> size >> resident;
    return resident * 4096;
}

/// Four bytes a pixel, as a canvas takes them.
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

Response picture_answer(const EncodedImage& image, const FrameWish& wish, const json& facts) {
    if (wish.raw) return {200, "application/octet-stream", raw_pixels(image), text_of(facts)};
    const std::vector<std::byte> bytes = wish.png ? encode_png(image, {}) : encode_jpeg(image, 85);
    return {200, wish.png ? "image/png" : "image/jpeg",
            std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), text_of(facts)};
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

}  // namespace

/// Ends the work that the client has in hand, and is in its place until it is destroyed.
class ViewSession::Turn {
  public:
    /// `flag` ends it, too; null: one of its own.
    Turn(ViewSession& session, const json& wish, std::shared_ptr<StopFlag> flag = nullptr)
        : session_(session),
          client_(wish.value("client", "")),
          flag_(flag ? std::move(flag) : std::make_shared<StopFlag>()) {
        const std::lock_guard lock(session.turns_mutex_);
        std::shared_ptr<StopFlag>& place = session.turns_[client_];
        if (place) place->request();
        place = flag_;
        if (session.closing_) flag_->request();
    }
    ~Turn() {
        const std::lock_guard lock(session_.turns_mutex_);
        const auto place = session_.turns_.find(client_);
        if (place->second == flag_) session_.turns_.erase(place);
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    [[nodiscard]] const StopFlag* flag() const { return flag_.get(); }
    /// The answer of a turn that was ended.
    [[nodiscard]] Response ended() const {
        const std::lock_guard lock(session_.turns_mutex_);
        return session_.closing_ ? closed() : overtaken();
    }

  private:
    ViewSession& session_;
    std::string client_;
    std::shared_ptr<StopFlag> flag_;
};

ViewSession::ViewSession(std::filesystem::path scene, LoadOptions options, int threads)
    : path_(std::move(scene)), load_(std::move(options)), threads_(threads) {
    stamps_.take({path_});
    read_files();
    watcher_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}
ViewSession::~ViewSession() = default;

/// Reads the files and takes their stamps. Throws Error, with the stamps taken.
void ViewSession::read_files() {
    std::set<std::filesystem::path> known = stamps_.files();
    stamps_.take(known);
    const auto began = FileStamps::now();
    const std::shared_ptr<const Loaded> before = loaded();
    auto next = std::make_shared<Loaded>();
    next->accelerator = before ? before->accelerator : load_.compile.accelerator;
    next->version = before ? before->version + 1 : 1;
    LoadOptions options = load_;
    options.compile.accelerator = next->accelerator;
    Diagnostics diagnostics;
    try {
        SceneDescription description = load_description(path_, options, diagnostics);
        stamps_.add(diagnostics.files(), began);
        next->scene = load(std::move(description), std::move(diagnostics), options);
    } catch (const Error&) {
        stamps_.add(diagnostics.files(), began);
        throw;
    }
    LoadedScene& scene = next->scene;
    FramingOptions framing;
    framing.aspect = free_aspect(scene.description.picture, {});
    (void)complete_view(scene.description, scene.scene, framing);
    json menus = view_menus(scene, next->accelerator);
    const std::lock_guard lock(shown_mutex_);
    loaded_ = std::move(next);
    menus_ = std::move(menus);
    error_.clear();
}

void ViewSession::watch(const std::stop_token& stop) {
    constexpr auto kPause = std::chrono::milliseconds(100);
    while (!stop.stop_requested()) {
        {
            std::unique_lock lock(watch_mutex_);
            (void)watch_ends_.wait_for(lock, stop, kPause, [] { return false; });
        }
        if (stop.stop_requested() || !stamps_.changed()) continue;
        std::string message;
        try {
            read_files();
            continue;
        } catch (const std::exception& error) {
            message = error.what();
        }
        const std::lock_guard lock(shown_mutex_);
        error_ = std::move(message);
    }
}

std::shared_ptr<const ViewSession::Loaded> ViewSession::loaded() const {
    const std::lock_guard lock(shown_mutex_);
    return loaded_;
}

std::shared_ptr<const ViewSession::Loaded> ViewSession::loaded_with(
    const std::string& accelerator) {
    std::shared_ptr<const Loaded> here = loaded();
    if (accelerator.empty() || here->accelerator == accelerator) return here;
    check_accelerator(accelerator);
    const std::lock_guard building(build_mutex_);
    here = loaded();
    if (here->accelerator == accelerator) return here;
    auto next = std::make_shared<Loaded>();
    next->scene.description = here->scene.description;
    next->scene.scene = here->scene.scene;
    next->scene.scene.aggregate = nullptr;
    next->accelerator = accelerator;
    next->version = here->version;
    LoadOptions options = load_;
    options.compile.accelerator = accelerator;
    build_aggregate(next->scene, options);
    const std::lock_guard lock(shown_mutex_);
    if (loaded_->version == next->version) {
        loaded_ = next;
        menus_["accelerator"] = accelerator;
    }
    return next;
}

Response ViewSession::state() const {
    json state;
    {
        const std::lock_guard lock(shown_mutex_);
        state = menus_;
        state["version"] = loaded_->version;
        state["error"] = error_;
    }
    state["memory"] = resident_bytes();
    return {200, "application/json", text_of(state), ""};
}

Response ViewSession::frame(const json& request, std::shared_ptr<StopFlag> stop) {
    const Turn turn(*this, request, std::move(stop));
    FrameWish wish = frame_wish(request);
    const std::shared_ptr<const Loaded> here = loaded_with(request.value("accelerator", ""));
    wish.options.view = &wish.camera;
    wish.options.threads = threads_;
    wish.options.stop = turn.flag();
    if (turn.flag()->requested()) return turn.ended();
    const RenderResult result = render(here->scene, wish.options);
    if (!result.complete) return turn.ended();
    json facts{{"seconds", result.seconds},
               {"rays", result.counters.total_cast()},
               {"threads", result.threads},
               {"version", here->version},
               {"width", *wish.options.width},
               {"height", *wish.options.height}};
    const EncodedImage image = picture_of(result, wish, here->scene.scene.conventions.film, facts);
    return picture_answer(image, wish, facts);
}

Response ViewSession::explain(const json& request) {
    const Turn turn(*this, request);
    const FrameWish wish = frame_wish(request);
    const std::shared_ptr<const Loaded> here = loaded_with(request.value("accelerator", ""));
    ExplainOptions options;
    options.render = wish.options;
    options.render.aovs = {};
    options.render.view = &wish.camera;
    options.render.threads = threads_;
    options.render.stop = turn.flag();
    options.x = request.at("x").get<int>();
    options.y = request.at("y").get<int>();
    options.sample = request.value("sample", 0);
    options.accelerator = request.value("steps", options.accelerator);
    const Explanation explanation = explain_pixel(here->scene, options);
    if (!explanation.complete) return turn.ended();
    return {200, "application/json", explanation_json(explanation, -1), ""};
}

Response ViewSession::stop(const json& wish) {
    const std::lock_guard lock(turns_mutex_);
    const auto turn = turns_.find(wish.value("client", ""));
    if (turn != turns_.end()) turn->second->request();
    return {200, "application/json", "{}", ""};
}

void ViewSession::close() {
    watcher_.request_stop();
    const std::lock_guard lock(turns_mutex_);
    closing_ = true;
    for (const auto& [client, flag] : turns_) flag->request();
}

Response ViewSession::answer(const Request& request) {
    try {
        if (request.path == "/state") return state();
        const json wish = json::parse(request.body);
        if (request.path == "/frame") return frame(wish, request.stop);
        if (request.path == "/explain") return explain(wish);
        if (request.path == "/stop") return stop(wish);
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
