#pragma once
/// Limits for one glTF file: elements read, against `max_elements` of the import options (a small
/// file may refer to the same accessor many times), and bytes made from them, against
/// `max_made_bytes` (morph weights, skins and instances multiply the data of the file).

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "alhazen/base/error.h"

namespace alhazen::gltf {

class Budget {
  public:
    explicit Budget(std::uint64_t elements,
                    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max())
        : elements_(elements), bytes_(bytes) {}

    /// Counts elements before they are read. Throws Error (Resource) above the limit.
    void take(std::uint64_t count) {
        if (count > elements_ - taken_) {
            throw Error(ErrorKind::Resource,
                        "the file has more than " + std::to_string(elements_) + " elements");
        }
        taken_ += count;
    }

    /// Counts memory before it is allocated: `count` items of `size` bytes. Throws as `take`.
    void make(std::uint64_t count, std::uint64_t size) {
        expect(count, size);
        made_ += count * size;
    }

    /// Throws if `make` would throw; counts nothing.
    void expect(std::uint64_t count, std::uint64_t size) const {
        if (size != 0 && count > (bytes_ - made_) / size) {
            throw Error(ErrorKind::Resource,
                        "the meshes, morphs, skins and instances of the file "
                        "need more than " +
                            std::to_string(bytes_ >> 20) +
                            " MiB (--max-import-mib, or max_made_bytes of the import options)");
        }
    }

    /// Default limit of bytes for a file of `file_bytes` including its buffers. Real files stay far
    /// below it: a vertex of 12 bytes becomes one of 24, a node of 20 bytes a part of 500. The
    /// result of a small file fits into memory together with its acceleration structure.
    [[nodiscard]] static std::uint64_t default_bytes(std::uint64_t file_bytes) {
        constexpr std::uint64_t kMiB = std::uint64_t{1} << 20, kPerByte = 64;
        constexpr std::uint64_t kLeast = 64 * kMiB, kMost = 16384 * kMiB;
        return std::min(kLeast + kPerByte * std::min(file_bytes, kMost / kPerByte), kMost);
    }

  private:
    std::uint64_t elements_, bytes_;
    std::uint64_t taken_ = 0, made_ = 0;
};

}  // namespace alhazen::gltf
