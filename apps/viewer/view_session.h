#pragma once
/// The scene behind the viewer's page: frames, explanations, what can be chosen, changes of the
/// file.
///
/// Conventions: requests and answers are JSON, but for pictures. A frame that is asked for while
/// another is rendered ends that one, which is answered by 204: the newest is first, none waits in
/// a queue. A file that changes is read again; while it has errors the last good scene is kept.
/// Threads: `answer` may be called from many.

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "http_server.h"

namespace alhazen::viewer {

class ViewSession {
  public:
    /// Loads the scene. Throws Error.
    ViewSession(std::filesystem::path scene, LoadOptions options, int threads);

    [[nodiscard]] Response answer(const Request& request);
    /// Ends the frame in hand; every request is answered by 503 from now on.
    void close();

  private:
    using FileTimes = std::map<std::filesystem::path, std::filesystem::file_time_type>;

    void load_scene();
    [[nodiscard]] FileTimes file_times() const;
    void reload_if_changed();
    [[nodiscard]] RenderOptions options_of(const nlohmann::ordered_json& wish);
    [[nodiscard]] Response state();
    [[nodiscard]] Response frame(const nlohmann::ordered_json& wish);
    [[nodiscard]] Response explain(const nlohmann::ordered_json& wish);

    std::filesystem::path path_;
    LoadOptions load_;
    int threads_;
    std::mutex scene_mutex_;  ///< of what follows
    LoadedScene loaded_;
    std::size_t own_camera_ = 0;  ///< behind those of the file
    FileTimes times_;             ///< of the last attempt to read the files
    FileTimes seen_;              ///< of those that `loaded_` is made of
    std::uint64_t version_ = 0;   ///< of the files, counted as they change
    std::string error_;           ///< of the last attempt to read it
    std::mutex newest_mutex_;
    std::shared_ptr<StopFlag> newest_;  ///< of the frame that is rendered
    bool closing_ = false;
};

}  // namespace alhazen::viewer
