#pragma once
/// A file as memory, read only: pages come in as they are touched, and are shared with whoever maps
/// the same file.
///
/// Regular files only. A file that is replaced as a whole (`write_file_atomically`) stays as it was
/// for who has it mapped; one that is cut short in place kills the process that reads beyond its
/// end.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace alhazen {

class MappedFile {
  public:
    /// Throws Error (File) when it cannot be opened, is not a regular file or cannot be mapped.
    [[nodiscard]] static std::shared_ptr<const MappedFile> open(const std::filesystem::path& path);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    /// Begins at a page.
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

  private:
    explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::span<const std::byte> bytes_;
};

}  // namespace alhazen
