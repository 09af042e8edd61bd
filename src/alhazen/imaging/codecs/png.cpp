#include "alhazen/imaging/codecs/png.h"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include <png.h>

#include "alhazen/imaging/codecs/image_size.h"
#include "alhazen/imaging/codecs/png_rows.h"

namespace alhazen {

namespace {

/// The state of libpng's callbacks. Errors return by longjmp, which must not leave a frame with
/// destructors: all calls of libpng are in the step functions below, which have no such objects.
struct PngState {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::jmp_buf jump;
    char message[200] = "";

    std::string_view input;
    std::vector<std::byte>* output = nullptr;

    png_bytep row = nullptr;
    const CodeRows* rows = nullptr;
    std::span<const std::vector<png_byte>> data;  ///< the compressed rows that are written
    png_textp texts = nullptr;
    int text_count = 0;
    int passes = 1;
    png_uint_32 width = 0, height = 0;
    std::size_t row_bytes = 0;
    int channels = 0, depth = 0;
    int max_side = 0;
};

using Step = void (*)(PngState&);

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    auto* state = static_cast<PngState*>(png_get_error_ptr(png));
    std::snprintf(state->message, sizeof state->message, "%s", message);
    std::longjmp(state->jump, 1);
}

void on_warning(png_structp, png_const_charp) {}

/// Runs `step`; false, with the message set, if libpng fails in it.
bool succeeds(PngState& state, Step step) {
    if (setjmp(state.jump) != 0) return false;
    step(state);
    return true;
}

// ---- reading

void read_bytes(png_structp png, png_bytep target, std::size_t count) {
    auto* state = static_cast<PngState*>(png_get_io_ptr(png));
    if (count > state->input.size()) png_error(png, "the data end too early");
    std::memcpy(target, state->input.data(), count);
    state->input.remove_prefix(count);
}

void open_reader(PngState& state) {
    state.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
    if (state.png != nullptr) state.info = png_create_info_struct(state.png);
}

void read_header(PngState& state) {
    png_set_read_fn(state.png, &state, read_bytes);
    png_set_user_limits(state.png, png_uint_32(state.max_side), png_uint_32(state.max_side));
    png_set_chunk_cache_max(state.png, 100);
    png_set_chunk_malloc_max(state.png, png_alloc_size_t{8} << 20);
    // Ignores chunks that are not needed: text and profiles can be decompression bombs.
    static const png_byte ignored[] = "iCCP\0iTXt\0zTXt\0tEXt\0eXIf\0sPLT\0hIST";
    png_set_keep_unknown_chunks(state.png, PNG_HANDLE_CHUNK_NEVER, ignored, 7);
    png_read_info(state.png, state.info);
    state.width = png_get_image_width(state.png, state.info);
    state.height = png_get_image_height(state.png, state.info);
    png_set_expand(state.png);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(state.png);
    state.passes = png_set_interlace_handling(state.png);
    png_read_update_info(state.png, state.info);
    state.row_bytes = png_get_rowbytes(state.png, state.info);
    state.channels = png_get_channels(state.png, state.info);
    state.depth = png_get_bit_depth(state.png, state.info);
}

void read_row(PngState& state) {
    png_read_row(state.png, state.row, nullptr);
}

void read_end(PngState& state) {
    png_read_end(state.png, nullptr);
}

class PngReader {
  public:
    PngReader(std::string_view bytes, const std::string& name, const ImageLimits& limits)
        : name_(name) {
        state_.input = bytes;
        state_.max_side = limits.max_side;
        check(open_reader);
        if (state_.info == nullptr) throw std::bad_alloc();
    }
    ~PngReader() { png_destroy_read_struct(&state_.png, &state_.info, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    void check(Step step) {
        if (!succeeds(state_, step)) {
            bad_image(name_, std::string("damaged PNG: ") + state_.message);
        }
    }
    PngState& state() { return state_; }

  private:
    PngState state_;
    const std::string& name_;
};

/// Checks the sizes in the fixed first chunk before libpng reads the file.
void check_first_chunk(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    constexpr std::size_t kWidthAt = 16;
    if (bytes.size() < kWidthAt + 8 || bytes.substr(12, 4) != "IHDR") {
        bad_image(name, "damaged PNG: there is no header");
    }
    const auto number = [&](std::size_t at) {
        std::int64_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value * 256 + std::uint8_t(bytes[at + i]);
        return value;
    };
    check_image_size(number(kWidthAt), number(kWidthAt + 4), limits, name);
}

/// Reads row by row, so that memory grows with the decoded data.
template <class Code>
std::vector<Code> read_rows(PngReader& reader) {
    PngState& state = reader.state();
    const std::size_t row_codes = state.row_bytes / sizeof(Code);
    std::vector<Code> codes;
    codes.reserve(row_codes * state.height);
    std::vector<Code> row(row_codes);
    state.row = reinterpret_cast<png_bytep>(row.data());
    for (std::size_t y = 0; y < state.height; ++y) {
        reader.check(read_row);
        codes.insert(codes.end(), row.begin(), row.end());
    }
    return codes;
}

/// Reads all codes into memory: the passes of an interlaced image reach all rows.
template <class Code>
std::vector<Code> read_interlaced(PngReader& reader) {
    PngState& state = reader.state();
    std::vector<Code> codes(state.row_bytes / sizeof(Code) * state.height);
    auto* const bytes = reinterpret_cast<png_bytep>(codes.data());
    for (int pass = 0; pass < state.passes; ++pass) {
        for (std::size_t y = 0; y < state.height; ++y) {
            state.row = bytes + y * state.row_bytes;
            reader.check(read_row);
        }
    }
    return codes;
}

template <class Code>
std::vector<Code> read_codes(PngReader& reader) {
    return reader.state().passes > 1 ? read_interlaced<Code>(reader) : read_rows<Code>(reader);
}

// ---- writing

void write_bytes(png_structp png, png_bytep source, std::size_t count) {
    auto* state = static_cast<PngState*>(png_get_io_ptr(png));
    bool written = true;
    try {
        const auto* bytes = reinterpret_cast<const std::byte*>(source);
        state->output->insert(state->output->end(), bytes, bytes + count);
    } catch (const std::bad_alloc&) {
        written = false;
    }
    if (!written) png_error(png, "not enough memory");
}

void flush_nothing(png_structp) {}

void open_writer(PngState& state) {
    state.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
    if (state.png != nullptr) state.info = png_create_info_struct(state.png);
}

void write_header(PngState& state) {
    static constexpr int kColourType[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                          PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    const CodeRows& rows = *state.rows;
    png_set_write_fn(state.png, &state, write_bytes, flush_nothing);
    png_set_user_limits(state.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(state.png, state.info, png_uint_32(rows.width), png_uint_32(rows.height),
                 rows.bits, kColourType[rows.channels], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (state.text_count > 0) {
        png_set_text(state.png, state.info, state.texts, state.text_count);
    }
    png_write_info(state.png, state.info);
}

/// Writes the rows and the end.
void write_data(PngState& state) {
    constexpr std::size_t kMost = std::size_t{1} << 30;  // of the bytes of a chunk
    static constexpr png_byte kRows[] = "IDAT", kEnd[] = "IEND";
    for (const std::vector<png_byte>& part : state.data) {
        for (std::size_t at = 0; at < part.size(); at += kMost) {
            png_write_chunk(state.png, kRows, part.data() + at, std::min(kMost, part.size() - at));
        }
    }
    png_write_chunk(state.png, kEnd, nullptr, 0);
}

class PngWriter {
  public:
    explicit PngWriter(std::vector<std::byte>& output) {
        state_.output = &output;
        check(open_writer);
        if (state_.info == nullptr) throw std::bad_alloc();
    }
    ~PngWriter() { png_destroy_write_struct(&state_.png, &state_.info); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    void check(Step step) {
        if (!succeeds(state_, step)) {
            throw Error(ErrorKind::Usage, std::string("cannot write a PNG: ") + state_.message);
        }
    }
    PngState& state() { return state_; }

  private:
    PngState state_;
};

[[noreturn]] void cannot_write(const std::string& why) {
    throw Error(ErrorKind::Usage, "cannot write a PNG: " + why);
}

void check_format(const CodeRows& rows) {
    if (rows.width <= 0 || rows.height <= 0) cannot_write("the picture is empty");
    if (rows.channels < 1 || rows.channels > 4) cannot_write("expected 1 to 4 channels");
    if (rows.bits != 8 && rows.bits != 16) cannot_write("expected 8 or 16 bits");
}

bool is_ascii(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c > 0; });
}

/// The chunks of the metadata, which they refer to. Text beyond ASCII is written as iTXt (UTF-8).
std::vector<png_text> text_chunks(const ImageMetadata& metadata) {
    std::vector<png_text> texts;
    for (const auto& [key, value] : metadata) {
        const auto printable = [](char c) { return c >= 32 && c < 127; };
        if (key.empty() || key.size() > 79 || !std::all_of(key.begin(), key.end(), printable)) {
            throw Error(ErrorKind::Usage, "cannot write the metadata key \"" + key +
                                              "\", expected 1 to 79 printable ASCII characters");
        }
        png_text text{};
        text.compression = is_ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        text.key = const_cast<char*>(key.c_str());
        text.text = const_cast<char*>(value.c_str());
        text.text_length = value.size();
        texts.push_back(text);
    }
    return texts;
}

}  // namespace

StoredImage decode_png(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    check_first_chunk(bytes, name, limits);
    PngReader reader(bytes, name, limits);
    reader.check(read_header);
    const PngState& state = reader.state();
    check_image_size(state.width, state.height, limits, name);
    // Deflate compresses at most 1032 : 1, so a larger size is false; expansion adds a factor of up
    // to 32.
    if (state.row_bytes * state.height / 32 > bytes.size() * 1032 + 4096) {
        bad_image(name, "damaged PNG: the data end too early");
    }
    check_image_memory(std::uint64_t{state.row_bytes} * (state.height + std::uint64_t{1}), limits,
                       name);
    StoredImage image{int(state.width), int(state.height), state.channels, false, {}};
    if (state.depth == 16) {
        image.samples = read_codes<std::uint16_t>(reader);
    } else {
        image.samples = read_codes<std::uint8_t>(reader);
    }
    reader.check(read_end);
    return image;
}

std::vector<std::byte> encode_png(const CodeRows& rows, const ImageMetadata& metadata) {
    check_format(rows);
    std::vector<png_text> texts = text_chunks(metadata);
    const std::vector<std::vector<std::uint8_t>> data = compressed_rows(rows);
    std::vector<std::byte> bytes;
    std::size_t size = 4096;
    for (const auto& part : data) size += part.size() + 12;
    bytes.reserve(size);
    PngWriter writer(bytes);
    PngState& state = writer.state();
    state.rows = &rows;
    state.texts = texts.data();
    state.text_count = int(texts.size());
    writer.check(write_header);
    state.data = data;
    writer.check(write_data);
    return bytes;
}

std::vector<std::byte> encode_png(const EncodedImage& image, const ImageMetadata& metadata) {
    CodeRows rows{image.width, image.height, image.channels, image.bits};
    check_format(rows);
    const std::size_t row_codes = std::size_t(image.width) * std::size_t(image.channels);
    if (image.samples.size() != std::size_t(image.height) * row_codes) {
        cannot_write("the samples do not fit the sizes");
    }
    rows.fill = [&](int y, std::span<std::uint16_t> codes) {
        std::copy_n(image.samples.data() + std::size_t(y) * row_codes, row_codes, codes.data());
    };
    return encode_png(rows, metadata);
}

}  // namespace alhazen
