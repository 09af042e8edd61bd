#pragma once
/// The scene of the viewer: read beside whoever looks at it, again when its files change, with the
/// accelerator that is wished for.
///
/// Conventions: while files have errors the last good scene is kept. Reading and building are work
/// that can be given up (alhazen/base/interruption.h): a newer change of the files ends reading,
/// `stop` does, and a build ends with the wish that it is for. Threads: all functions may be called
/// from many.

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

#include "alhazen/base/progress.h"
#include "alhazen/session/lighting.h"
#include "file_stamps.h"

namespace alhazen::viewer {

class SceneStore {
  public:
    using Json = nlohmann::ordered_json;
    /// A scene, never changed.
    struct Loaded {
        LoadedScene scene;
        std::string accelerator;
        std::uint64_t version = 0;  ///< of the files, from 1 on
    };

    /// Begins to read.
    SceneStore(std::filesystem::path scene, LoadOptions options);
    ~SceneStore();

    /// The scene with an accelerator; empty: the last one. Waits until there is a scene. Throws
    /// Error, and Interrupted after a request of `stop`.
    [[nodiscard]] std::shared_ptr<const Loaded> with(const std::string& accelerator,
                                                     const StopFlag& stop);
    /// That scene with the surfaces of its lights where these changes have them; itself where they
    /// move none. The last one is kept. Throws as `with`.
    [[nodiscard]] std::shared_ptr<const Loaded> moved(const std::shared_ptr<const Loaded>& here,
                                                      const std::vector<LightChange>& changes,
                                                      const StopFlag& stop);
    /// Ends reading.
    void stop();
    /// Reads again.
    void read_again();
    /// Waits, at most so long, until the first reading has ended. Rethrows its error.
    void wait_for_first(std::chrono::milliseconds most) const;
    /// Why there never was a scene; null while there is hope.
    [[nodiscard]] std::exception_ptr failure() const;

    /// What a page shows: menus, unless it knows those of version `known`, and the moment.
    [[nodiscard]] Json state(std::uint64_t known) const;

  private:
    using Clock = std::chrono::steady_clock;
    /// What a reading found out.
    struct Reading {
        std::set<std::filesystem::path> files;
        FileStamps::Time began = 0;
    };
    /// Work that is in hand.
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
    FileStamps stamps_;         ///< of the watcher
    mutable std::mutex mutex_;  ///< of what follows; held for moments only
    mutable std::condition_variable changed_;
    std::shared_ptr<const Loaded> loaded_;
    struct Moved {
        std::weak_ptr<const Loaded> from;
        std::vector<LightChange> changes;
        std::shared_ptr<const Loaded> scene;
    } moved_;            ///< the last that was asked for
    Json menus_;         ///< of `loaded_`
    std::string error_;  ///< of the last reading
    std::exception_ptr first_error_;
    std::optional<InHand> reading_, building_;
    std::optional<Reading> read_;  ///< ended, and not seen by the watcher
    bool stopped_ = false;         ///< the last reading, on request
    bool wanted_ = true;           ///< reading is to begin

    std::jthread reader_;   ///< of the watcher
    std::jthread watcher_;  ///< the last member: it ends first
};

}  // namespace alhazen::viewer
