#include "alhazen/simd/targets.h"

#include <atomic>

#include <hwy/highway.h>

#include "alhazen/base/error.h"
#include "alhazen/simd/dispatch.h"

#if HWY_ARCH_X86
#include <cpuid.h>
#endif

namespace alhazen {
namespace {

#if HWY_ARCH_X86

/// True if a bit of ECX of a leaf of `cpuid` is set, for features that the compiler's builtin has
/// no name for.
bool has_cpuid_bit(unsigned leaf, int bit) {
    unsigned a = 0, b = 0, c = 0, d = 0;
    return __get_cpuid(leaf, &a, &b, &c, &d) != 0 && (c >> bit & 1U) != 0;
}

/// The targets that this machine and its operating system support. Highway's own function is not
/// used: it measures the timer for some milliseconds whenever a program is loaded.
std::int64_t targets_of_machine() {
    __builtin_cpu_init();
    std::int64_t targets = HWY_EMU128 | HWY_SCALAR;
    const bool sse4 = __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.1") &&
                      __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul") &&
                      __builtin_cpu_supports("aes");
    if (__builtin_cpu_supports("ssse3")) targets |= HWY_SSSE3;
    if (!sse4) return targets;
    targets |= HWY_SSE4;
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                      has_cpuid_bit(1, 29) /* F16C */ && has_cpuid_bit(0x80000001U, 5) /* LZCNT */;
    if (!avx2) return targets;
    targets |= HWY_AVX2;
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512cd");
    if (avx512) targets |= HWY_AVX3;
    return targets;
}

#else

std::int64_t targets_of_machine() {
    return HWY_STATIC_TARGET | HWY_EMU128 | HWY_SCALAR;
}

#endif

/// What a processor must have for the weakest compiled target.
std::string least_instructions() {
#if HWY_ARCH_X86
    if (HWY_STATIC_TARGET == HWY_SSE4) return "SSE4.2, AES and PCLMUL";
#endif
    return hwy::TargetName(HWY_STATIC_TARGET);
}

/// The compiled targets that this machine supports. Throws Error (Usage) if there are none.
std::int64_t usable_targets() {
    const std::int64_t targets = targets_of_machine() & HWY_TARGETS;
    if (targets == 0) {
        throw Error(ErrorKind::Usage,
                    "this processor lacks instructions that this build of Alhazen needs (" +
                        least_instructions() + "); build with -DALHAZEN_KERNELS=portable");
    }
    return targets;
}

/// The targets to choose among; a lower bit is a better target.
struct Choice {
    std::int64_t of_machine = usable_targets();
    std::atomic<std::int64_t> targets = of_machine;
    hwy::ChosenTarget chosen;

    Choice() { set(targets); }
    void set(std::int64_t new_targets) {
        targets = new_targets;
        // Includes the weaker targets, for kernels that are not compiled for the best one.
        chosen.Update(of_machine & -(new_targets & -new_targets));
    }
};

Choice& choice() {
    static Choice choice;
    return choice;
}

std::int64_t best_of(std::int64_t targets) {
    return targets & -targets;
}

}  // namespace

const hwy::ChosenTarget& chosen_simd_target() {
    return choice().chosen;
}

std::vector<std::string> simd_targets() {
    std::vector<std::string> names;
    for (std::int64_t rest = choice().targets; rest != 0; rest &= rest - 1) {
        names.emplace_back(hwy::TargetName(best_of(rest)));
    }
    return names;
}

std::string simd_target() {
    return hwy::TargetName(best_of(choice().targets));
}

SimdTargetOverride::SimdTargetOverride(const std::string& name) : before_(choice().targets) {
    std::string names;
    for (std::int64_t rest = choice().of_machine; rest != 0; rest &= rest - 1) {
        const std::int64_t target = best_of(rest);
        if (name == hwy::TargetName(target)) {
            choice().set(target);
            return;
        }
        names += names.empty() ? "" : ", ";
        names += hwy::TargetName(target);
    }
    throw Error(ErrorKind::Usage,
                "no instruction set '" + name + "' on this machine; the valid names are: " + names);
}

SimdTargetOverride::~SimdTargetOverride() {
    choice().set(before_);
}

}  // namespace alhazen
