#pragma once
/// Compiles functions of scalar arithmetic twice, with and without fused multiply-add and AVX; the
/// version for the processor is chosen when the program starts.
///
/// Source: GCC manual, "Common Function Attributes", target_clones and flatten.
/// Conventions: contraction is off in both versions, so that both give the same bits; the gain is
/// that std::fma is an instruction and not a call. For large, free functions only: a call costs,
/// and both versions share one symbol. Empty for other compilers, other machines, and with
/// sanitizers, which run before the choice is made.

#if defined(__x86_64__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ALHAZEN_FOR_EACH_INSTRUCTION_SET \
    __attribute__((flatten, target_clones("arch=x86-64-v3", "default")))
#else
#define ALHAZEN_FOR_EACH_INSTRUCTION_SET
#endif
