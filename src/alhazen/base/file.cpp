#include "alhazen/base/file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <map>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "alhazen/base/error.h"

namespace alhazen {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error_number) {
    throw Error(ErrorKind::File, what + ": " + std::strerror(error_number), {path.string(), 0, 0});
}

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
    throw Error(ErrorKind::File, what, {path.string(), 0, 0});
}

class FileDescriptor {
  public:
    explicit FileDescriptor(int fd) : fd_(fd) {}
    ~FileDescriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;

    [[nodiscard]] int get() const { return fd_; }
    /// Closes the file; returns the result of close(2), which may report the failure of an earlier
    /// write.
    [[nodiscard]] int close() { return ::close(std::exchange(fd_, -1)); }

  private:
    int fd_;
};

/// Removes a temporary file unless it was renamed into place.
class TemporaryName {
  public:
    explicit TemporaryName(fs::path path) : path_(std::move(path)) {}
    ~TemporaryName() {
        if (!kept_) ::unlink(path_.c_str());
    }
    TemporaryName(const TemporaryName&) = delete;
    TemporaryName& operator=(const TemporaryName&) = delete;

    [[nodiscard]] const fs::path& path() const { return path_; }
    void keep() { kept_ = true; }

  private:
    fs::path path_;
    bool kept_ = false;
};

void check_path(const fs::path& path) {
    if (path.empty()) fail(path, "the name of the file is empty");
    // The system would read the name up to the NUL and open another file.
    if (path.native().find('\0') != std::string::npos) fail(path, "the file name contains a NUL");
}

/// The file that `path` names, through symbolic links, so that a link stays a link. The file need
/// not exist.
fs::path target_of(const fs::path& path) {
    std::error_code error, missing;
    if (!fs::is_symlink(path, missing)) return path;
    const bool exists = fs::exists(path, error);  // without an error: or the links have an end
    fs::path target = path;
    if (exists) target = fs::weakly_canonical(path, error);
    while (!exists && !error && fs::is_symlink(target, missing)) {
        target = target.parent_path() / fs::read_symlink(target, error);
    }
    if (error) fail(path, "cannot follow the link: " + error.message());
    return target;
}

/// Creates a file with the mode that a plain open would give. The name is short, whatever the
/// length of the target's name.
int create_temporary(const fs::path& folder, fs::path& name) {
    static std::atomic<unsigned> counter{0};
    int fd = -1;
    for (int attempt = 0; attempt < 1000; ++attempt) {
        name = folder / (".alhazen-" + std::to_string(::getpid()) + "-" +
                         std::to_string(counter.fetch_add(1)) + ".tmp");
        fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || (errno != EEXIST && errno != EINTR)) break;
    }
    return fd;
}

void write_all(int fd, std::span<const std::byte> bytes, const fs::path& path) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written < 0) {
            if (errno == EINTR) continue;
            fail(path, "cannot write the file", errno);
        }
        bytes = bytes.subspan(std::size_t(written));
    }
}

/// Syncs a file; true if that succeeds or the file system does not support it (EINVAL, ENOTSUP).
bool synced(int fd) {
    int result = 0;
    do {
        result = ::fsync(fd);
    } while (result != 0 && errno == EINTR);
    return result == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

void sync_folder(const fs::path& folder) {
    const FileDescriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    // The rename is done and both names refer to whole files: a failure here needs no undoing.
    if (fd.get() >= 0) (void)synced(fd.get());
}

}  // namespace

std::string read_file(const fs::path& path, std::uint64_t max_bytes) {
    check_path(path);
    // O_NONBLOCK: opening a FIFO without a writer would otherwise wait forever.
    const FileDescriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (fd.get() < 0) fail(path, "cannot open the file", errno);
    struct stat status {};
    if (::fstat(fd.get(), &status) != 0) fail(path, "cannot read the file", errno);
    if (S_ISDIR(status.st_mode)) fail(path, "is a folder, expected a file");
    if (!S_ISREG(status.st_mode)) fail(path, "is not a regular file");

    const auto check_size = [&](std::uint64_t size) {
        if (size <= max_bytes) return;
        throw Error(ErrorKind::Resource,
                    "the file has more than " + std::to_string(max_bytes) + " bytes",
                    {path.string(), 0, 0});
    };
    check_size(std::uint64_t(status.st_size));
    // The size is only a hint: a file may grow while it is read, and some report 0.
    std::string bytes(std::size_t(status.st_size) + 1, '\0');
    std::size_t size = 0;
    while (true) {
        if (size == bytes.size()) bytes.resize(bytes.size() + std::max<std::size_t>(size, 4096));
        const ssize_t got = ::read(fd.get(), bytes.data() + size, bytes.size() - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(path, "cannot read the file", errno);
        if (got == 0) break;
        size += std::size_t(got);
        check_size(size);
    }
    bytes.resize(size);
    return bytes;
}

void write_file_atomically(const fs::path& path, std::span<const std::byte> bytes, Sync sync) {
    write_file_atomically(path, std::span(&bytes, 1), sync);
}

void write_file_atomically(const fs::path& path, std::span<const std::span<const std::byte>> pieces,
                           Sync sync) {
    check_path(path);
    const fs::path target = target_of(path);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    struct stat old {};
    const bool exists = ::stat(target.c_str(), &old) == 0;
    // A rename would replace a device.
    if (exists && !S_ISREG(old.st_mode)) fail(path, "exists and is not a regular file");

    fs::path temporary_path;
    FileDescriptor fd(create_temporary(folder, temporary_path));
    if (fd.get() < 0) fail(path, "cannot write into the folder " + folder.string(), errno);
    TemporaryName temporary(std::move(temporary_path));
    // Keeps the permissions of the old file where that is allowed.
    if (exists) (void)!::fchmod(fd.get(), old.st_mode & 07777);
    for (const std::span<const std::byte> bytes : pieces) write_all(fd.get(), bytes, path);
    if (sync == Sync::ToDisk && !synced(fd.get())) fail(path, "cannot write the file", errno);
    if (fd.close() != 0) fail(path, "cannot write the file", errno);
    if (::rename(temporary.path().c_str(), target.c_str()) != 0) {
        fail(path, "cannot replace the file", errno);
    }
    temporary.keep();
    if (sync == Sync::ToDisk) sync_folder(folder);
}

void write_file_atomically(const fs::path& path, const std::string& text) {
    write_file_atomically(path, std::as_bytes(std::span<const char>(text.data(), text.size())));
}

void check_writable(const fs::path& path) {
    const fs::path target = target_of(path);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    const auto refuse = [&](const std::string& why) {
        throw Error(ErrorKind::File, "cannot write " + path.string() + ": " + why);
    };
    std::error_code failed;
    if (!fs::is_directory(folder, failed)) refuse("there is no folder " + folder.string());
    if (::access(folder.c_str(), W_OK) != 0) refuse("the folder may not be written to");
    if (fs::is_directory(path, failed)) refuse("it is a folder");
}

void check_distinct(std::span<const fs::path> paths) {
    std::map<fs::path, fs::path> name_of;
    for (const fs::path& path : paths) {
        std::error_code failed;
        const fs::path target = target_of(path);
        const fs::path whole = fs::weakly_canonical(fs::absolute(target, failed), failed);
        if (fs::exists(whole, failed) && !fs::is_regular_file(whole, failed)) continue;
        const auto [other, is_new] = name_of.emplace(failed ? target : whole, path);
        if (is_new) continue;
        throw Error(ErrorKind::Usage, "two outputs are one file: " + other->second.string() +
                                          " and " + path.string());
    }
}

fs::path resolve_inside(std::span<const fs::path> roots, const fs::path& folder,
                        const std::string& name) {
    const auto refuse = [&](const std::string& why) {
        throw Error(ErrorKind::Scene, "the file name \"" + name + "\" " + why);
    };
    if (name.empty()) refuse("is empty");
    if (name.find('\0') != std::string::npos) refuse("contains a NUL");
    const auto whole = [](const fs::path& path) {
        return fs::absolute(path.empty() ? fs::path(".") : path).lexically_normal();
    };
    const auto is_inside = [](const fs::path& path, const fs::path& root) {
        const fs::path inside = path.lexically_relative(root);
        return !inside.empty() && *inside.begin() != "..";
    };
    const fs::path place = (folder / name).lexically_normal();
    std::error_code failed;
    const fs::path real = fs::weakly_canonical(whole(place), failed);
    bool led_out = false;  // the name as written lies in a root, but leads out of it through a link
    for (const fs::path& root : roots) {
        if (failed) break;
        const fs::path real_root = fs::weakly_canonical(whole(root), failed);
        if (!failed && is_inside(real, real_root)) return place;
        led_out = led_out || is_inside(whole(place), whole(root));
    }
    std::string allowed;
    for (const fs::path& root : roots) allowed += (allowed.empty() ? "" : ", ") + root.string();
    refuse(led_out ? "leads out of the folder " + allowed + " through a symbolic link"
                   : "leaves the folder " + allowed +
                         " that the scene may read (--allow-path adds another)");
    return {};
}

fs::path resolve_inside(const fs::path& root, const fs::path& folder, const std::string& name) {
    return resolve_inside(std::span(&root, 1), folder, name);
}

}  // namespace alhazen
