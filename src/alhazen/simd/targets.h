#pragma once
/// The instruction sets that kernels are compiled for, and an override that forces one.
///
/// Conventions: names are Highway's ("AVX3" is AVX-512, "SCALAR" plain C++). Every target gives the
/// same bits. Throws Error (Usage) if the processor supports none of the compiled targets. Threads:
/// objects choose their kernels when they are constructed; force a target before, from one thread.

#include <string>
#include <vector>

namespace alhazen {

/// The compiled targets that this machine supports, the best first.
[[nodiscard]] std::vector<std::string> simd_targets();

/// The target of kernels chosen from here on.
[[nodiscard]] std::string simd_target();

/// Forces a target for the lifetime of the object; an unknown name throws Error (Usage). Overrides
/// nest.
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
