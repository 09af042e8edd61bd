#pragma once
/// A read-only memory map of a file: pages are loaded when they are touched, and are shared by all
/// processes that map the file.
///
/// Regular files only. A file that is replaced as a whole (`write_file_atomically`) stays unchanged
/// for existing maps. A file that is truncated in place kills the process that reads beyond its
/// end.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace alhazen {

class MappedFile {
  public:
    /// Throws Error (File) if the file cannot be opened, is not a regular file or cannot be
    /// mapped.
    [[nodiscard]] static std::shared_ptr<const MappedFile> open(const std::filesystem::path& path);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    /// The bytes of the file; the first lies at a page boundary.
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

  private:
    explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::span<const std::byte> bytes_;
};

}  // namespace alhazen
