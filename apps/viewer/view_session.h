#pragma once
/// What the viewer's page asks for, answered: frames, explanations, what can be chosen, the state.
///
/// Conventions: requests and answers are JSON, but for pictures. What a client asks for ends what
/// it asked for before, which is answered by 204: the newest is first, none waits in a queue.
/// Threads: `answer` may be called from many.

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

namespace alhazen::viewer {

class ViewSession {
  public:
    /// Begins to read the scene.
    ViewSession(std::filesystem::path scene, LoadOptions options, int threads);
    ~ViewSession();

    [[nodiscard]] Response answer(const Request& request);
    /// Ends what is in hand; frames and explanations are answered by 503 from now on.
    void close();
    [[nodiscard]] const SceneStore& scenes() const { return scenes_; }

  private:
    using Json = nlohmann::ordered_json;
    /// The work of a client, while it lasts.
    class Turn;

    [[nodiscard]] Response state(const std::string& known) const;
    [[nodiscard]] Response frame(const Json& wish, Turn& turn);
    [[nodiscard]] Response explain(const Json& wish, Turn& turn);
    [[nodiscard]] Response blocks(const Json& wish);
    [[nodiscard]] Response stop(const Json& wish);
    /// `scene` as it is to be lit; none: as it is. `description` is that of the file.
    [[nodiscard]] std::optional<Scene> lit(const Scene& scene, const SceneDescription& description,
                                           Lighting lighting);

    SceneStore scenes_;
    const int threads_;
    std::mutex surroundings_mutex_;
    /// [name, up axis] that were made
    std::map<std::pair<std::string, UpAxis>, std::shared_ptr<const Environment>> surroundings_;
    mutable std::mutex turns_mutex_;
    std::map<std::string, Turn*> turns_;  ///< [client] in hand
    bool closing_ = false;
};

}  // namespace alhazen::viewer
