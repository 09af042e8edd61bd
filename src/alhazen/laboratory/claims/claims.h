#pragma once
/// What the literature says of ray tracing, measured again: each claim is an experiment that prints
/// ours, the reference figure where there is one, and whether it holds (docs/claims.md).
///
/// Source: with each claim. Differs: times are compared as ratios only, never as seconds of other
/// machines.
/// Conventions: an experiment whose scene or accelerator does not exist is not available, which is
/// never a success. All runs on one thread; seeds are fixed.
/// To add one: a function in claims_*.cpp and a line of the table in claims.cpp.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alhazen/base/progress.h"

namespace alhazen {

class ClaimRun;

struct ClaimEntry {
    const char* id;
    const char* claim;     ///< one line
    const char* expected;  ///< when it holds
    void (*run)(ClaimRun& run);
};

/// In the order of their ids.
[[nodiscard]] std::span<const ClaimEntry> claims();

enum class Verdict { Holds, Fails, NotAvailable };
[[nodiscard]] const char* verdict_name(Verdict verdict);

struct ClaimFinding {
    std::string what, ours, reference;
    std::optional<bool> holds;  ///< none: told for information
};

struct ClaimReport {
    std::string id, claim, expected;
    Verdict verdict = Verdict::NotAvailable;
    std::vector<ClaimFinding> findings;
    std::string note;    ///< what a reader should know; why it is not available
    double seconds = 0;  ///< wall clock
};

struct ClaimOptions {
    double time_limit = 5;  ///< seconds for the rays of one accelerator on one scene
    ProgressSink* progress = nullptr;
    const StopFlag* stop = nullptr;
};

/// Cuts "A1,B4"; "all" is every one. Throws Error (Usage) for an id that is none.
[[nodiscard]] std::vector<std::string> parse_claims(const std::string& list);

/// Calls `done` with each report when it is there. Throws Error (Render) when it is stopped.
[[nodiscard]] std::vector<ClaimReport> check_claims(
    const std::vector<std::string>& ids, const ClaimOptions& options,
    const std::function<void(const ClaimReport&)>& done = {});

[[nodiscard]] std::string claims_table(std::span<const ClaimReport> reports);  ///< for a terminal
[[nodiscard]] std::string claims_markdown(std::span<const ClaimReport> reports);  ///< for the docs

}  // namespace alhazen
