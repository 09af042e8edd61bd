#include "file_stamps.h"

#include <sys/stat.h>
#include <time.h>

#include <fstream>
#include <functional>
#include <string>
#include <string_view>

namespace alhazen::viewer {

namespace {

/// Longer than the resolution of file times.
constexpr FileStamps::Time kFresh = 100'000'000;

/// Hash of at most 64 MiB: edits of larger files take longer than `kFresh`.
std::uint64_t content_of(const std::filesystem::path& file) {
    constexpr std::size_t kMost = std::size_t{64} << 20;
    std::ifstream stream(file, std::ios::binary);
    std::string bytes(1 << 16, '\0');
    std::uint64_t content = 0;
    for (std::size_t read = 0; stream && read < kMost;) {
        stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        const auto count = static_cast<std::size_t>(stream.gcount());
        content = 31 * content + std::hash<std::string_view>{}({bytes.data(), count});
        read += count;
    }
    return content;
}

bool is_fresh(FileStamps::Time time) {
    const FileStamps::Time age = FileStamps::now() - time;
    return age < kFresh && age > -kFresh;
}

FileStamps::Time in_nanoseconds(const timespec& time) {
    return FileStamps::Time{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

FileStamps::Time FileStamps::now() {
    timespec time{};
    (void)clock_gettime(CLOCK_REALTIME, &time);
    return in_nanoseconds(time);
}

FileStamps::Stamp FileStamps::stamp_of(const std::filesystem::path& file) {
    struct stat facts {};
    Stamp stamp;
    // Only regular files are opened: a FIFO would block.
    stamp.exists = stat(file.c_str(), &facts) == 0 && S_ISREG(facts.st_mode);
    if (!stamp.exists) return stamp;
    stamp.written = in_nanoseconds(facts.st_mtim);
    stamp.touched = in_nanoseconds(facts.st_ctim);
    stamp.size = facts.st_size;
    stamp.number = facts.st_ino;
    return stamp;
}

void FileStamps::take(const std::set<std::filesystem::path>& files) {
    stamps_.clear();
    for (const auto& file : files) {
        Stamp stamp = stamp_of(file);
        if (stamp.exists && is_fresh(stamp.touched)) stamp.content = content_of(file);
        stamps_[file] = stamp;
    }
}

void FileStamps::add(const std::set<std::filesystem::path>& files, Time began) {
    for (const auto& file : files) {
        if (stamps_.contains(file)) continue;
        Stamp stamp = stamp_of(file);
        stamp.suspect = stamp.exists && stamp.touched > began - kFresh;
        stamps_[file] = stamp;
    }
}

bool FileStamps::changed() {
    for (auto& [file, stamp] : stamps_) {
        const Stamp now = stamp_of(file);
        if (stamp.suspect || now.exists != stamp.exists || now.written != stamp.written ||
            now.touched != stamp.touched || now.size != stamp.size || now.number != stamp.number) {
            return true;
        }
        if (!stamp.content) continue;
        const bool fresh = is_fresh(stamp.touched);
        if (content_of(file) != *stamp.content) return true;
        if (!fresh) stamp.content.reset();
    }
    return false;
}

std::set<std::filesystem::path> FileStamps::files() const {
    std::set<std::filesystem::path> files;
    for (const auto& [file, stamp] : stamps_) files.insert(file);
    return files;
}

}  // namespace alhazen::viewer
