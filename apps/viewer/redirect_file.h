#pragma once
/// A page in a file readable only by the user that redirects the browser to another address.
///
/// Source: Jupyter's redirect file (jupyter_server, "use_redirect_file"): every user of the machine
/// can read arguments of programs, so an address that contains a key must not be one.
/// Conventions: the file has mode 0600 and is in a new folder (mode 0700) in XDG_RUNTIME_DIR, or in
/// the folder for temporary files.
/// Threads: `remove` may be called from any thread.

#include <filesystem>
#include <mutex>
#include <string>

namespace alhazen::viewer {

class RedirectFile {
  public:
    /// Writes the file. Throws Error (File) if it cannot be written.
    explicit RedirectFile(const std::string& url);
    ~RedirectFile();
    RedirectFile(const RedirectFile&) = delete;
    RedirectFile& operator=(const RedirectFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Deletes file and folder; has no effect the second time.
    void remove() noexcept;

  private:
    std::filesystem::path path_;
    std::once_flag removed_;
};

}  // namespace alhazen::viewer
