#pragma once
/// Handles the requests of the viewer's page: frames, explanations, choices and the state.
///
/// Conventions: requests and responses are JSON, except pictures. A request of a client ends its
/// previous request, which gets status 204; none waits in a queue.
/// Threads: `answer` may be called from many threads.

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "alhazen/session/lighting.h"
#include "http_server.h"
#include "scene_store.h"
#include "view_wishes.h"

namespace alhazen::viewer {

class ViewSession {
  public:
    /// Starts to read the scene.
    ViewSession(std::filesystem::path scene, LoadOptions options, int threads);
    ~ViewSession();

    [[nodiscard]] Response answer(const Request& request);
    /// Ends running work; frames and explanations then get status 503.
    void close();
    [[nodiscard]] const SceneStore& scenes() const { return scenes_; }

  private:
    using Json = nlohmann::ordered_json;
    /// The running work of a client.
    class Turn;

    [[nodiscard]] Response state(const std::string& known) const;
    [[nodiscard]] Response frame(const Json& wish, Turn& turn);
    [[nodiscard]] Response explain(const Json& wish, Turn& turn);
    [[nodiscard]] Response blocks(const Json& wish);
    [[nodiscard]] Response stop(const Json& wish);
    /// `scene` with the lighting of a frame; none if unchanged. `here`: as the file has it.
    [[nodiscard]] std::optional<Scene> lit(const Scene& scene, const SceneStore::Loaded& here,
                                           const FrameWish& wish);

    SceneStore scenes_;
    const int threads_;
    std::mutex surroundings_mutex_;
    /// [name, up axis] environments made so far
    std::map<std::pair<std::string, UpAxis>, std::shared_ptr<const Environment>> surroundings_;
    mutable std::mutex turns_mutex_;
    std::map<std::string, Turn*> turns_;  ///< [client] running work
    bool closing_ = false;
};

}  // namespace alhazen::viewer
