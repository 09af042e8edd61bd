#include "scene_store.h"

#include <fstream>
#include <set>
#include <utility>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/parallel/parallel.h"
#include "view_menus.h"

namespace alhazen::viewer {

namespace {

constexpr auto kPause = std::chrono::milliseconds(20);

/// Resident memory of the process, rounded to whole MiB.
std::uint64_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    file >> size >> resident;
    return resident * 4096 >> 20 << 20;
}

}  // namespace

SceneStore::SceneStore(std::filesystem::path scene, LoadOptions options)
    : path_(std::move(scene)), load_(std::move(options)) {
    stamps_.take({path_});
    watcher_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

SceneStore::~SceneStore() {
    stop();
}

void SceneStore::watch(const std::stop_token& stop) {
    constexpr int kLook = 5;  // pauses between checks of the files
    for (int pause = 0; !stop.stop_requested(); ++pause) {
        std::optional<Reading> ended;
        bool wanted = false, in_hand = false;
        {
            std::unique_lock lock(mutex_);
            ended = std::exchange(read_, std::nullopt);
            wanted = std::exchange(wanted_, false);
            in_hand = reading_.has_value();
        }
        if (ended) stamps_.add(ended->files, ended->began);
        // A change of known files ends the current reading.
        const bool look = ended || pause % kLook == 0;
        if (wanted || (look && stamps_.changed())) {
            if (in_hand) end_reading();
            begin_reading();
        }
        std::this_thread::sleep_for(kPause);
    }
    end_reading();
}

void SceneStore::begin_reading() {
    stamps_.take(stamps_.files());
    const auto flag = std::make_shared<StopFlag>();
    {
        const std::lock_guard lock(mutex_);
        read_.reset();
        stopped_ = false;
        reading_ = InHand{"reading " + path_.filename().string(), Clock::now(), flag};
    }
    reader_ = std::jthread([this, flag] { read(flag); });
}

void SceneStore::end_reading() {
    {
        const std::lock_guard lock(mutex_);
        if (reading_) reading_->stop->request();
    }
    if (reader_.joinable()) reader_.join();
}

/// Runs a reading from beginning to end.
void SceneStore::read(const std::shared_ptr<StopFlag>& stop) {
    const Interruptible ends(stop.get());
    Reading reading;
    std::string message;
    std::exception_ptr error;
    bool stopped = false;
    try {
        read_files(reading);
    } catch (const Interrupted&) {
        stopped = true;
    } catch (const std::exception& caught) {
        message = caught.what();
        error = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    read_ = std::move(reading);
    reading_.reset();
    stopped_ = stopped;
    error_ = std::move(message);
    if (!loaded_) first_error_ = error;
    changed_.notify_all();
}

void SceneStore::read_files(Reading& reading) {
    reading.began = FileStamps::now();
    auto next = std::make_shared<Loaded>();
    {
        const std::lock_guard lock(mutex_);
        next->accelerator = loaded_ ? loaded_->accelerator : load_.compile.accelerator;
        next->version = loaded_ ? loaded_->version + 1 : 1;
    }
    LoadOptions options = load_;
    options.compile.accelerator = next->accelerator;
    Diagnostics diagnostics;
    try {
        SceneDescription description = load_description(path_, options, diagnostics);
        reading.files = diagnostics.files();
        next->scene = load(std::move(description), std::move(diagnostics), options);
    } catch (...) {
        if (reading.files.empty()) reading.files = diagnostics.files();
        throw;
    }
    LoadedScene& scene = next->scene;
    next->added = complete(scene);
    Json menus = view_menus(scene, next->added, load_.compile.accelerator);
    // The previous scene is freed after the lock.
    std::shared_ptr<const Loaded> last = std::move(next);
    Moved last_moved;
    const std::lock_guard lock(mutex_);
    loaded_.swap(last);
    std::swap(moved_, last_moved);
    menus_.swap(menus);
}

std::shared_ptr<const SceneStore::Loaded> SceneStore::with(const std::string& accelerator,
                                                           const StopFlag& stop) {
    if (!accelerator.empty()) check_accelerator(accelerator);
    std::shared_ptr<const Loaded> here;
    {
        std::unique_lock lock(mutex_);
        const auto is_there = [&] {
            return loaded_ && (accelerator.empty() || loaded_->accelerator == accelerator);
        };
        // One build at a time.
        const auto ready = [&] { return is_there() || (loaded_ && !building_); };
        while (!changed_.wait_for(lock, kPause, ready)) {
            if (stop.requested()) throw Interrupted();
        }
        here = loaded_;
        if (is_there()) return here;
        building_ = InHand{"building " + accelerator, Clock::now(), nullptr};
    }
    struct Ended {
        SceneStore& store;
        ~Ended() {
            const std::lock_guard lock(store.mutex_);
            store.building_.reset();
            store.changed_.notify_all();
        }
    } const ended{*this};
    std::shared_ptr<const Loaded> next = built(*here, accelerator, stop);
    const std::lock_guard lock(mutex_);
    if (loaded_->version == next->version) loaded_ = next;
    return next;
}

std::shared_ptr<const SceneStore::Loaded> SceneStore::built(const Loaded& source,
                                                            const std::string& accelerator,
                                                            const StopFlag& stop) {
    auto next = std::make_shared<Loaded>();
    next->scene.scene = source.scene.scene;
    next->scene.scene.aggregate = nullptr;
    next->added = source.added;
    next->accelerator = accelerator;
    next->version = source.version;
    CompileOptions options = load_.compile;
    options.accelerator = accelerator;
    const Interruptible ends(&stop);
    ThreadLimit(load_.threads).run([&] {
        build_aggregate(source.scene.description, options, next->scene.scene);
    });
    // Last, so that an interrupted build has copied nothing that must be freed.
    next->scene.description = source.scene.description;
    return next;
}

std::shared_ptr<const SceneStore::Loaded> SceneStore::moved(
    const std::shared_ptr<const Loaded>& here, const std::vector<LightChange>& changes,
    const StopFlag& stop) {
    const std::vector<LightChange> surfaces = surface_changes(here->scene.description, changes);
    if (surfaces.empty()) return here;
    {
        const std::lock_guard lock(mutex_);
        if (moved_.from.lock() == here && moved_.changes == surfaces) return moved_.scene;
    }
    auto next = std::make_shared<Loaded>();
    next->added = here->added;
    next->accelerator = here->accelerator;
    next->version = here->version;
    CompileOptions options = load_.compile;
    options.accelerator = here->accelerator;
    const Interruptible ends(&stop);
    ThreadLimit(load_.threads).run([&] {
        next->scene = with_moved_surfaces(here->scene, surfaces, options);
    });
    // The previous result is freed after the lock.
    Moved last{here, surfaces, next};
    const std::lock_guard lock(mutex_);
    std::swap(moved_, last);
    return next;
}

void SceneStore::stop() {
    const std::lock_guard lock(mutex_);
    if (reading_) reading_->stop->request();
}

void SceneStore::read_again() {
    const std::lock_guard lock(mutex_);
    wanted_ = true;
}

void SceneStore::wait_for_first(std::chrono::milliseconds most) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, most, [&] { return loaded_ || first_error_; });
    if (!loaded_ && first_error_) std::rethrow_exception(first_error_);
}

std::exception_ptr SceneStore::failure() const {
    const std::lock_guard lock(mutex_);
    return loaded_ ? nullptr : first_error_;
}

SceneStore::Json SceneStore::state(std::uint64_t known) const {
    Json state = Json::object(), work = Json::array();
    {
        const std::lock_guard lock(mutex_);
        const std::uint64_t version = loaded_ ? loaded_->version : 0;
        if (version != known) state = menus_;
        state["version"] = version;
        state["accelerator"] = loaded_ ? loaded_->accelerator : load_.compile.accelerator;
        state["error"] = error_;
        state["stopped"] = stopped_;
        for (const std::optional<InHand>* in_hand : {&reading_, &building_}) {
            if (!*in_hand) continue;
            const std::chrono::duration<double> spent = Clock::now() - (*in_hand)->since;
            work.push_back({{"what", (*in_hand)->what}, {"seconds", spent.count()}});
        }
    }
    state["memory"] = resident_bytes();
    state["work"] = std::move(work);
    return state;
}

}  // namespace alhazen::viewer
