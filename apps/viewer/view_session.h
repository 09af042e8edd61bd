#pragma once
/// The scene behind the viewer's page: frames, explanations, what can be chosen, changes of the
/// file.
///
/// Conventions: requests and answers are JSON, but for pictures. What a client asks for ends what
/// it asked for before, which is answered by 204: the newest is first, none waits in a queue. Files
/// are watched, and read again when they change, beside the frames; while they have errors the last
/// good scene is kept. Threads: `answer` may be called from many.

#include <condition_variable>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "file_stamps.h"
#include "http_server.h"

namespace alhazen::viewer {

class ViewSession {
  public:
    /// Loads the scene. Throws Error.
    ViewSession(std::filesystem::path scene, LoadOptions options, int threads);
    ~ViewSession();

    [[nodiscard]] Response answer(const Request& request);
    /// Ends what is in hand; frames and explanations are answered by 503 from now on.
    void close();

  private:
    using Json = nlohmann::ordered_json;
    /// A scene, never changed.
    struct Loaded {
        LoadedScene scene;
        std::string accelerator;
        std::uint64_t version = 0;
    };
    /// The work of a client, while it lasts.
    class Turn;

    void read_files();
    void watch(const std::stop_token& stop);
    [[nodiscard]] std::shared_ptr<const Loaded> loaded() const;
    /// With the accelerator that is wished for. Throws Error.
    [[nodiscard]] std::shared_ptr<const Loaded> loaded_with(const std::string& accelerator);
    [[nodiscard]] Response state() const;
    [[nodiscard]] Response frame(const Json& wish, std::shared_ptr<StopFlag> stop);
    [[nodiscard]] Response explain(const Json& wish);
    [[nodiscard]] Response stop(const Json& wish);

    const std::filesystem::path path_;
    const LoadOptions load_;
    const int threads_;
    FileStamps stamps_;               ///< of the last attempt to read the files; of the watcher
    mutable std::mutex shown_mutex_;  ///< of what follows; held for moments only
    std::shared_ptr<const Loaded> loaded_;
    Json menus_;              ///< of `loaded_`: all of /state that does not change with the moment
    std::string error_;       ///< of the last attempt to read the files
    std::mutex build_mutex_;  ///< held while an accelerator is built
    std::mutex turns_mutex_;
    std::map<std::string, std::shared_ptr<StopFlag>> turns_;  ///< [client] in hand
    bool closing_ = false;
    std::mutex watch_mutex_;
    std::condition_variable_any watch_ends_;
    std::jthread watcher_;  ///< the last member: it ends first
};

}  // namespace alhazen::viewer
