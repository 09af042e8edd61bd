#pragma once
/// Safe reading and writing of whole files.
///
/// Reads accept regular files only (no FIFO or device can hang or flood a loader) and stop at a
/// byte limit. Writes go to a temporary name in the target's folder and are renamed: a killed run
/// leaves the old file or the new one, never half of it.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace alhazen {

/// Default limit of `read_file`: 4 GiB.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30;

/// Returns the bytes of `path`. Throws Error (File) if it cannot be opened, is not a regular file
/// or fails while it is read; Error (Resource) when it is larger than `max_bytes`.
[[nodiscard]] std::string read_file(const std::filesystem::path& path,
                                    std::uint64_t max_bytes = kMaxFileBytes);

/// Whether a written file waits for the disk.
enum class Sync {
    ToDisk,  ///< fsync of the file and its folder: holds after a loss of power, too
    Later    ///< when the system writes it; for what is made again in a moment
};

/// Replaces `path` by `bytes` in one step (temporary file, rename). Throws Error (File) and leaves
/// the old file unchanged when anything fails.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes,
                           Sync sync = Sync::ToDisk);

/// Writes the bytes of several pieces, in this order.
void write_file_atomically(const std::filesystem::path& path,
                           std::span<const std::span<const std::byte>> pieces,
                           Sync sync = Sync::ToDisk);
/// Writes a text.
void write_file_atomically(const std::filesystem::path& path, const std::string& text);

/// Throws Error (File) if `path` is known not to be writable: its folder is missing or not
/// writable, or it is a folder itself. For callers with long work before the write.
void check_writable(const std::filesystem::path& path);

/// Throws Error (Usage) if two of `paths` lead to one file, by whatever names and links, so that
/// one output would replace another. Devices may be named twice.
void check_distinct(std::span<const std::filesystem::path> paths);

/// Resolves `name`, as written in a scene file, against `folder`. Throws Error (Scene) if it is
/// empty, holds a NUL, or does not lie in one of the folders `roots` after all symbolic links are
/// followed; the same holds for absolute names.
[[nodiscard]] std::filesystem::path resolve_inside(std::span<const std::filesystem::path> roots,
                                                   const std::filesystem::path& folder,
                                                   const std::string& name);
/// Resolves `name` with a single root.
[[nodiscard]] std::filesystem::path resolve_inside(const std::filesystem::path& root,
                                                   const std::filesystem::path& folder,
                                                   const std::string& name);

}  // namespace alhazen
