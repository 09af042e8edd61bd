#pragma once
/// A page in a file of the user alone that leads the browser on to another address.
///
/// Source: Jupyter's redirect file (jupyter_server, "use_redirect_file"): arguments of programs can
/// be read by every user of the machine, so an address with a key in it is none.
/// Conventions: the file lies in a new folder (mode 0700) of XDG_RUNTIME_DIR, or of the folder for
/// temporary files, and has mode 0600. Threads: `remove` may be called from any.

#include <filesystem>
#include <mutex>
#include <string>

namespace alhazen::viewer {

class RedirectFile {
  public:
    /// Throws Error (File) where it cannot be written.
    explicit RedirectFile(const std::string& url);
    ~RedirectFile();
    RedirectFile(const RedirectFile&) = delete;
    RedirectFile& operator=(const RedirectFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Deletes file and folder; nothing happens the second time.
    void remove() noexcept;

  private:
    std::filesystem::path path_;
    std::once_flag removed_;
};

}  // namespace alhazen::viewer
