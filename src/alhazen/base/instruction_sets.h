#pragma once
/// Functions of scalar arithmetic that are compiled twice, with and without fused multiply-add and
/// AVX; the one for the processor at hand is chosen when the program starts.
///
/// Source: GCC manual, "Common Function Attributes", target_clones and flatten. Differs: nothing.
/// Conventions: contraction is off in both copies, so that both give the same bits: what is gained
/// is that std::fma is an instruction and not a call. For functions that are large beside a call,
/// and free ones, for the copies are of one symbol. Elsewhere (other compilers, other machines,
/// with sanitizers, which run before the choice is made) it is empty.

#if defined(__x86_64__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ALHAZEN_FOR_EACH_INSTRUCTION_SET \
    __attribute__((flatten, target_clones("arch=x86-64-v3", "default")))
#else
#define ALHAZEN_FOR_EACH_INSTRUCTION_SET
#endif
