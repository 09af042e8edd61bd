#pragma once
/// Instructions of a call, counted by single steps of the processor: the same number in every run,
/// for all instruction sets.

#include <cstdint>
#include <functional>

namespace alhazen::bench {

/// Runs `call` and returns the number of its instructions in this thread, the call of the function
/// object included; a repeated string instruction counts once. A step takes about a microsecond.
/// Throws Error (Usage) where the system has no single steps (other than Linux on x86-64).
[[nodiscard]] std::uint64_t count_instructions(const std::function<void()>& call);

/// Throws Error (Render) if a loop of known length is counted wrong.
void check_instruction_count();

}  // namespace alhazen::bench
