#pragma once
/// The instruction sets that kernels are compiled for, and a way to force one of them.
///
/// Conventions: names are Highway's ("AVX3" is AVX-512, "EMU128" plain C++). Every target gives
/// the same bits.
/// Threads: objects that hold kernels choose them when they are built, so a target should be
/// forced before, and by one thread.

#include <string>
#include <vector>

namespace alhazen {

/// Targets that are compiled in and that this machine can run, the best first.
[[nodiscard]] std::vector<std::string> simd_targets();

/// The target that kernels built from now on use.
[[nodiscard]] std::string simd_target();

/// Forces a target for its life; an unknown name throws Error(Usage). They nest.
class SimdTargetOverride {
  public:
    explicit SimdTargetOverride(const std::string& name);
    ~SimdTargetOverride();
    SimdTargetOverride(const SimdTargetOverride&) = delete;
    SimdTargetOverride& operator=(const SimdTargetOverride&) = delete;

  private:
    long long before_;
};

}  // namespace alhazen
