#pragma once
/// What is read from one file together, against `max_elements` of the options: a small file may
/// name the same accessor many times.

#include <cstdint>
#include <string>

#include "alhazen/base/error.h"

namespace alhazen::gltf {

class ElementBudget {
  public:
    explicit ElementBudget(std::uint64_t limit) : limit_(limit) {}

    /// Throws Error (Resource) when the limit is exceeded.
    void take(std::uint64_t count) {
        if (count > limit_ - taken_) {
            throw Error(ErrorKind::Resource,
                        "the file has more than " + std::to_string(limit_) + " elements");
        }
        taken_ += count;
    }

  private:
    std::uint64_t limit_;
    std::uint64_t taken_ = 0;
};

}  // namespace alhazen::gltf
