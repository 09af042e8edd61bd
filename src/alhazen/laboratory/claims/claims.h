#pragma once
/// Reproduces claims of the ray tracing literature: each claim is an experiment that prints our
/// figure, the reference figure if there is one, and whether the claim holds (docs/claims.md).
///
/// Source: see each claim.
/// Differs: times are compared as ratios, never as seconds of other machines.
/// Conventions: an experiment without its scene or accelerator is not available, which never counts
/// as success. All runs use one thread; seeds are fixed. To add a claim: a function in claims_*.cpp
/// and an entry of the table in claims.cpp.

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
    const char* expected;  ///< condition for the claim to hold
    void (*run)(ClaimRun& run);
};

/// All claims, in the order of their ids.
[[nodiscard]] std::span<const ClaimEntry> claims();

enum class Verdict { Holds, Fails, NotAvailable };
[[nodiscard]] const char* verdict_name(Verdict verdict);

struct ClaimFinding {
    std::string what, ours, reference;
    std::optional<bool> holds;  ///< none: the finding is informational
};

struct ClaimReport {
    std::string id, claim, expected;
    Verdict verdict = Verdict::NotAvailable;
    std::vector<ClaimFinding> findings;
    std::string note;    ///< remarks; the reason if it is not available
    double seconds = 0;  ///< wall clock
};

struct ClaimOptions {
    double time_limit = 5;  ///< seconds for the rays of one accelerator on one scene
    ProgressSink* progress = nullptr;
    const StopFlag* stop = nullptr;
};

/// Splits "A1,B4" into ids; "all" is every claim. Throws Error (Usage) for an unknown id.
[[nodiscard]] std::vector<std::string> parse_claims(const std::string& list);

/// Runs experiments; calls `done` with each finished report. Throws Error (Render) when stopped.
[[nodiscard]] std::vector<ClaimReport> check_claims(
    const std::vector<std::string>& ids, const ClaimOptions& options,
    const std::function<void(const ClaimReport&)>& done = {});

[[nodiscard]] std::string claims_table(std::span<const ClaimReport> reports);  ///< for a terminal
[[nodiscard]] std::string claims_markdown(std::span<const ClaimReport> reports);  ///< for the docs

}  // namespace alhazen
