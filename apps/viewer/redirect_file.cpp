#include "redirect_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "alhazen/base/error.h"

namespace alhazen::viewer {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path) {
    throw Error(ErrorKind::File, fmt::format("cannot write {}: {}", path.string(),
                                             std::generic_category().message(errno)));
}

std::filesystem::path parent_folder() {
    const char* const own = std::getenv("XDG_RUNTIME_DIR");
    std::error_code error;
    if (own != nullptr && access(own, W_OK) == 0 && std::filesystem::is_directory(own, error)) {
        return own;
    }
    return std::filesystem::temp_directory_path();
}

}  // namespace

RedirectFile::RedirectFile(const std::string& url) {
    std::string folder = (parent_folder() / "alhazen-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) fail(folder);
    path_ = std::filesystem::path(folder) / "view.html";
    const std::string page = fmt::format(
        "<!doctype html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" "
        "content=\"no-referrer\">\n<meta http-equiv=\"refresh\" content=\"0;url={0}\">\n"
        "<title>Alhazen</title>\n<a href=\"{0}\">To the viewer</a>\n",
        url);
    const int file = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    bool written =
        file >= 0 && write(file, page.data(), page.size()) == static_cast<ssize_t>(page.size());
    if (file >= 0) written = close(file) == 0 && written;
    if (written) return;
    const int reason = errno;
    remove();
    errno = reason;
    fail(path_);
}

RedirectFile::~RedirectFile() {
    remove();
}

void RedirectFile::remove() noexcept {
    std::call_once(removed_, [this] {
        (void)unlink(path_.c_str());
        (void)rmdir(path_.parent_path().c_str());
    });
}

}  // namespace alhazen::viewer
