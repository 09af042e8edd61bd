#include "alhazen/imaging/codecs/png_rows.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <span>
#include <utility>

#include <libdeflate.h>
#include <zlib.h>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/imaging/codecs/deflate_stream.h"
#include "alhazen/imaging/codecs/png_filter.h"
#include "alhazen/imaging/image/code_lanes.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

using PngBytes = std::vector<std::uint8_t>;

/// A row of bytes below a margin of zeros.
class MarginedRow {
  public:
    explicit MarginedRow(std::size_t bytes) : bytes_(kPngRowMargin + bytes) {}
    [[nodiscard]] std::span<std::uint8_t> bytes() {
        return std::span(bytes_).subspan(kPngRowMargin);
    }
    void swap(MarginedRow& other) { bytes_.swap(other.bytes_); }

  private:
    PngBytes bytes_;
};

/// Sets the bytes of a row, `bits` each, from its codes.
void set_bytes(std::span<const std::uint16_t> codes, int bits, std::uint8_t* bytes) {
    if (bits == 16) {
        for (const std::uint16_t code : codes) {
            *bytes++ = std::uint8_t(code >> 8);
            *bytes++ = std::uint8_t(code & 255);
        }
        return;
    }
    if (!narrow_codes(codes, bytes)) {
        throw Error(ErrorKind::Usage, "cannot write a PNG: a code does not fit 8 bits");
    }
}

/// Rows of a picture in pieces, each of fewer rows than the one before it: the last ones, which the
/// threads end with, are short.
class RowPieces {
  public:
    explicit RowPieces(const CodeRows& rows)
        : row_codes(std::size_t(rows.width) * std::size_t(rows.channels)),
          row_bytes(row_codes * std::size_t(rows.bits / 8)),
          pixel_bytes(std::size_t(rows.channels) * std::size_t(rows.bits / 8)) {
        constexpr std::size_t kPiece = std::size_t{256} << 10;
        const std::size_t height = std::size_t(rows.height), size = (1 + row_bytes) * height;
        const std::size_t wanted = std::clamp<std::size_t>((size + kPiece / 2) / kPiece, 1, height);
        for (std::size_t i = 0; i <= wanted; ++i) {
            const std::size_t begin = first_row(i, wanted, height);
            if (begins_.empty() || begin > begins_.back()) begins_.push_back(begin);
        }
        for (std::size_t i = 0; i < count(); ++i) most_bytes_ = std::max(most_bytes_, bytes(i));
    }

    [[nodiscard]] std::size_t count() const { return begins_.size() - 1; }
    [[nodiscard]] std::size_t begin(std::size_t piece) const { return begins_[piece]; }
    [[nodiscard]] std::size_t end(std::size_t piece) const { return begins_[piece + 1]; }
    [[nodiscard]] std::size_t bytes(std::size_t piece) const {
        return (end(piece) - begin(piece)) * (1 + row_bytes);
    }

    /// Of the largest piece.
    [[nodiscard]] std::size_t most_bytes() const { return most_bytes_; }

    std::size_t row_codes, row_bytes, pixel_bytes;

  private:
    /// The sizes of many pieces fall evenly from 1.6 to 0.4 of their mean; two are equal.
    [[nodiscard]] static std::size_t first_row(std::size_t piece, std::size_t count,
                                               std::size_t height) {
        constexpr double kFall = 0.6;
        const double part = double(piece) / double(count);
        const double fall = count > 2 ? kFall * part * (1.0 - part) : 0.0;
        return std::size_t(std::lround(double(height) * (part + fall)));
    }

    std::vector<std::size_t> begins_;  ///< [piece], and the height
    std::size_t most_bytes_ = 0;
};

/// What a thread compresses pieces with.
class PieceCompressor {
  public:
    PieceCompressor(const CodeRows& rows, const RowPieces& pieces)
        : rows_(rows),
          pieces_(pieces),
          codes_(pieces.row_codes),
          row_(pieces.row_bytes),
          above_(pieces.row_bytes),
          filtered_(pieces.most_bytes()),
          compressor_(libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor) {
        if (!compressor_) throw std::bad_alloc();
        room_.resize(libdeflate_deflate_compress_bound(compressor_.get(), filtered_.size()));
    }

    /// The blocks of a piece as a stream of deflate. Sets the checksum of the filtered bytes.
    [[nodiscard]] PngBytes compress(std::size_t piece, std::uint32_t& checksum) {
        const std::span<const std::uint8_t> bytes = filtered(piece);
        checksum = libdeflate_adler32(1, bytes.data(), bytes.size());
        const std::size_t size = libdeflate_deflate_compress(
            compressor_.get(), bytes.data(), bytes.size(), room_.data(), room_.size());
        return {room_.begin(), room_.begin() + std::ptrdiff_t(size)};
    }

  private:
    // Level 6 takes a third more time than level 4, for files smaller by a few percent.
    static constexpr int kLevel = 4;

    void set_row(std::size_t y) {
        rows_.fill(int(y), codes_);
        set_bytes(codes_, rows_.bits, row_.bytes().data());
    }

    /// The rows of a piece with their filters.
    [[nodiscard]] std::span<const std::uint8_t> filtered(std::size_t piece) {
        const std::size_t begin = pieces_.begin(piece), end = pieces_.end(piece);
        if (begin == 0) {
            std::ranges::fill(above_.bytes(), std::uint8_t{0});
        } else {
            set_row(begin - 1);
            row_.swap(above_);
        }
        std::uint8_t* to = filtered_.data();
        for (std::size_t y = begin; y < end; ++y) {
            set_row(y);
            const PngFilter filter =
                best_png_filter(row_.bytes(), above_.bytes(), pieces_.pixel_bytes);
            *to = std::uint8_t(filter);
            apply_png_filter(filter, row_.bytes(), above_.bytes(), pieces_.pixel_bytes, to + 1);
            to += 1 + pieces_.row_bytes;
            row_.swap(above_);
        }
        return {filtered_.data(), to};
    }

    const CodeRows& rows_;
    const RowPieces& pieces_;
    std::vector<std::uint16_t> codes_;
    MarginedRow row_, above_;
    PngBytes filtered_, room_;
    std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor_;
};

/// Compressors, at most one per active thread.
class CompressorPool {
  public:
    CompressorPool(const CodeRows& rows, const RowPieces& pieces) : rows_(rows), pieces_(pieces) {}

    [[nodiscard]] std::unique_ptr<PieceCompressor> take() {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) return std::make_unique<PieceCompressor>(rows_, pieces_);
        std::unique_ptr<PieceCompressor> taken = std::move(idle_.back());
        idle_.pop_back();
        return taken;
    }
    void give_back(std::unique_ptr<PieceCompressor> compressor) {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(compressor));
    }

  private:
    const CodeRows& rows_;
    const RowPieces& pieces_;
    std::vector<std::unique_ptr<PieceCompressor>> idle_;
    std::mutex mutex_;
};

}  // namespace

std::vector<PngBytes> compressed_rows(const CodeRows& rows) {
    const RowPieces pieces(rows);
    const std::size_t count = pieces.count();
    std::vector<PngBytes> parts(count);
    std::vector<std::uint32_t> checksums(count);
    CompressorPool pool(rows, pieces);
    const Interruptible whole(nullptr);
    std::atomic<std::size_t> next = 0;
    parallel_for(count, 1, [&](std::size_t, std::size_t) {
        std::unique_ptr<PieceCompressor> own = pool.take();
        const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);  // long ones first
        parts[i] = own->compress(i, checksums[i]);
        if (i + 1 < count) leave_open(parts[i]);
        pool.give_back(std::move(own));
    });

    std::uint32_t checksum = checksums[0];
    for (std::size_t i = 1; i < count; ++i) {
        checksum = std::uint32_t(adler32_combine(checksum, checksums[i], z_off_t(pieces.bytes(i))));
    }
    constexpr std::uint8_t kHeader[] = {0x78, 0x5e};  // deflate, window of 32 kB, a low level
    parts.front().insert(parts.front().begin(), kHeader, kHeader + 2);
    for (int shift = 24; shift >= 0; shift -= 8) {
        parts.back().push_back(std::uint8_t(checksum >> shift));
    }
    return parts;
}

}  // namespace alhazen
