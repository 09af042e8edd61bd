#pragma once
/// The rows of a PNG as they are in its file: filtered and compressed, by several threads.
///
/// Source: ISO/IEC 15948 (PNG), clauses 9 and 10; RFC 1950 (zlib).
/// Differs: large pictures are compressed in pieces of whole rows, 256 kB each on average, which do
/// not refer to the bytes before them: files are larger by up to 1 %, nearly empty ones by some 30
/// bytes a piece. The last pieces are the smallest, so that threads end together.
/// Conventions: the pieces follow from the sizes of the picture alone, so the bytes are the same
/// with any number of threads.

#include <cstdint>
#include <vector>

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

/// The zlib stream of the rows, in consecutive parts. Calls `rows.fill` from several threads.
/// Throws Error (Usage) if a code does not fit the bits.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> compressed_rows(const CodeRows& rows);

}  // namespace alhazen
