#pragma once
/// The scene of the viewer: read in a thread of its own, again when its files change, and built
/// with the requested accelerator.
///
/// Conventions: while files have errors the last valid scene is kept. Reading and building can be
/// interrupted (alhazen/base/interruption.h): a newer change of the files or `stop` ends reading,
/// and a build ends with the request that it belongs to.
/// Threads: all functions may be called from many threads.

#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "added_lights.h"
#include "alhazen/base/progress.h"
#include "alhazen/session/lighting.h"
#include "file_stamps.h"

namespace alhazen::viewer {

class SceneStore {
  public:
    using Json = nlohmann::ordered_json;
    /// An immutable scene.
    struct Loaded {
        LoadedScene scene;
        AddedLights added;
        std::string accelerator;
        std::uint64_t version = 0;  ///< of the files, from 1
    };

    /// Starts to read.
    SceneStore(std::filesystem::path scene, LoadOptions options);
    ~SceneStore();

    /// The scene with an accelerator; empty: the last one used. Waits until there is a scene.
    /// Throws Error; Interrupted after a request of `stop`.
    [[nodiscard]] std::shared_ptr<const Loaded> with(const std::string& accelerator,
                                                     const StopFlag& stop);
    /// The scene `here` with the surfaces of its lights changed; `here` itself if no surface
    /// changes. The last result is cached. Throws as `with`.
    [[nodiscard]] std::shared_ptr<const Loaded> moved(const std::shared_ptr<const Loaded>& here,
                                                      const std::vector<LightChange>& changes,
                                                      const StopFlag& stop);
    /// Ends reading.
    void stop();
    /// Starts to read again.
    void read_again();
    /// Waits, at most this long, until the first reading has ended. Rethrows its error.
    void wait_for_first(std::chrono::milliseconds most) const;
    /// The error of the last reading if there has never been a scene; otherwise null.
    [[nodiscard]] std::exception_ptr failure() const;

    /// The state for a page: menus, unless it knows those of version `known`, and current work.
    [[nodiscard]] Json state(std::uint64_t known) const;

  private:
    using Clock = std::chrono::steady_clock;
    /// The result of a reading.
    struct Reading {
        std::set<std::filesystem::path> files;
        FileStamps::Time began = 0;
    };
    /// Running work.
    struct InHand {
        std::string what;
        Clock::time_point since;
        std::shared_ptr<StopFlag> stop;
    };

    void watch(const std::stop_token& stop);
    void begin_reading();
    void end_reading();
    void read(const std::shared_ptr<StopFlag>& stop);
    void read_files(Reading& reading);
    [[nodiscard]] std::shared_ptr<const Loaded> built(const Loaded& source,
                                                      const std::string& accelerator,
                                                      const StopFlag& stop);

    const std::filesystem::path path_;
    const LoadOptions load_;
    FileStamps stamps_;         ///< used by the watcher only
    mutable std::mutex mutex_;  ///< guards the following members; held briefly
    mutable std::condition_variable changed_;
    std::shared_ptr<const Loaded> loaded_;
    struct Moved {
        std::weak_ptr<const Loaded> from;
        std::vector<LightChange> changes;
        std::shared_ptr<const Loaded> scene;
    } moved_;            ///< last result of `moved`
    Json menus_;         ///< of `loaded_`
    std::string error_;  ///< of the last reading
    std::exception_ptr first_error_;
    std::optional<InHand> reading_, building_;
    std::optional<Reading> read_;  ///< result of a reading, not yet seen by the watcher
    bool stopped_ = false;         ///< the last reading was stopped on request
    bool wanted_ = true;           ///< a reading is requested

    std::jthread reader_;   ///< used by the watcher only
    std::jthread watcher_;  ///< last member, so that it ends first
};

}  // namespace alhazen::viewer
