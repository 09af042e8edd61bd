#pragma once
/// Makes the stream of one deflate compressor continue with that of another.
///
/// Source: RFC 1951 (deflate); M. Adler, pigz: streams end at a byte by an empty stored block.
/// Differs: libdeflate always marks its last block as final, so the codes of all blocks are read to
/// find this mark and the end of the last code.

#include <cstdint>
#include <vector>

namespace alhazen {

/// Removes the mark of the final block, and appends an empty block so that the next stream can
/// begin at a byte. Precondition: the stream is valid. Throws Error (Render) if it does not end
/// within its last byte.
void leave_open(std::vector<std::uint8_t>& stream);

}  // namespace alhazen
