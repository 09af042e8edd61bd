#pragma once
/// For tests and `verify`: the stream for small trees, too.
///
/// Threads: aggregates choose their schedules when they are built, so force it before, from one
/// thread.

namespace alhazen {

/// While one exists, rays that are not coherent are traced by the stream in every tree that is
/// built, except where there is none (Schedule::TreelessPackets).
class StreamOverride {
  public:
    StreamOverride();
    ~StreamOverride();
    StreamOverride(const StreamOverride&) = delete;
    StreamOverride& operator=(const StreamOverride&) = delete;
};

}  // namespace alhazen
