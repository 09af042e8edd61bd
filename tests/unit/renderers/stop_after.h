#pragma once
/// Pictures that are stopped while they are rendered.

#include <cstddef>
#include <string_view>

#include "alhazen/base/progress.h"

namespace alhazen::testing {

/// Requests a stop after some parts.
class StopAfter final : public ProgressSink {
  public:
    explicit StopAfter(std::size_t parts) : parts_(parts) {}
    StopFlag stop;

    void update(std::string_view, std::size_t done, std::size_t) override {
        if (done == parts_) stop.request();
    }

  private:
    std::size_t parts_;
};

}  // namespace alhazen::testing
