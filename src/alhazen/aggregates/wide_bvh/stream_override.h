#pragma once
/// Forces the stream for small trees, for tests and `verify`.
///
/// Threads: aggregates choose their schedules when they are built; construct it before, from one
/// thread.

namespace alhazen {

/// During its lifetime, every tree that is built traces incoherent rays by the stream, unless its
/// schedule is TreelessPackets.
class StreamOverride {
  public:
    StreamOverride();
    ~StreamOverride();
    StreamOverride(const StreamOverride&) = delete;
    StreamOverride& operator=(const StreamOverride&) = delete;
};

}  // namespace alhazen
