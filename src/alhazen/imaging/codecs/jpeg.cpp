#include "alhazen/imaging/codecs/jpeg.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <span>

#include <jpeglib.h>

#include <jerror.h>

#include "alhazen/imaging/codecs/image_size.h"

namespace alhazen {

namespace {

/// Maximum number of scans of a progressive file; encoders write about ten. A file of many tiny
/// scans would take very long to decode.
constexpr int kMaxScans = 100;

/// The state of libjpeg's callbacks. Errors return by longjmp, which must not leave a frame with
/// destructors: all calls of libjpeg are in the step functions below, which have no such objects.
struct ErrorState {
    jpeg_error_mgr manager;  // first, so that cinfo->err points to the whole struct
    std::jmp_buf jump;
    bool lacks_end = false;  ///< the data end without the marker of the end
    char message[JMSG_LENGTH_MAX] = "";
};

void on_error(j_common_ptr cinfo) {
    auto* state = reinterpret_cast<ErrorState*>(cinfo->err);
    (*cinfo->err->format_message)(cinfo, state->message);
    std::longjmp(state->jump, 1);
}

/// Level -1 is a warning. Warnings that leave every pixel unchanged are ignored, all others end the
/// reading. After the end of the data libjpeg reads a marker of the end; another warning follows if
/// the scan needs more, except with arithmetic codes, whose last zeros may be left out.
void on_message(j_common_ptr cinfo, int level) {
    if (level >= 0) return;
    switch (cinfo->err->msg_code) {
        case JWRN_ADOBE_XFORM:
        case JWRN_EXTRANEOUS_DATA:
        case JWRN_TOO_MUCH_DATA:
            return;
        case JWRN_JPEG_EOF: {
            auto* state = reinterpret_cast<ErrorState*>(cinfo->err);
            if (reinterpret_cast<j_decompress_ptr>(cinfo)->arith_code != 0) on_error(cinfo);
            state->lacks_end = true;
            return;
        }
        default:
            on_error(cinfo);
    }
}

void no_output(j_common_ptr) {}

void prepare(ErrorState& error) {
    jpeg_std_error(&error.manager);
    error.manager.error_exit = on_error;
    error.manager.emit_message = on_message;
    error.manager.output_message = no_output;
}

struct Decompression {
    ErrorState error;
    jpeg_decompress_struct cinfo{};
    jpeg_progress_mgr progress{};
    std::string_view input;
    JSAMPROW row = nullptr;
};

struct Compression {
    ErrorState error;
    jpeg_compress_struct cinfo{};
    const EncodedImage* image = nullptr;
    int quality = 0;
    int channels = 0;
    unsigned char* output = nullptr;
    unsigned long output_size = 0;
    JSAMPROW row = nullptr;
};

/// Runs `step`; false, with the message set, if libjpeg fails in it.
template <class State>
bool succeeds(State& state, void (*step)(State&)) {
    if (setjmp(state.error.jump) != 0) return false;
    step(state);
    return true;
}

void limit_scans(j_common_ptr cinfo) {
    if (reinterpret_cast<j_decompress_ptr>(cinfo)->input_scan_number > kMaxScans) {
        auto* state = reinterpret_cast<ErrorState*>(cinfo->err);
        std::snprintf(state->message, sizeof state->message, "more than %d scans", kMaxScans);
        std::longjmp(state->jump, 1);
    }
}

void read_header(Decompression& state) {
    jpeg_create_decompress(&state.cinfo);
    state.progress.progress_monitor = limit_scans;
    state.cinfo.progress = &state.progress;
    jpeg_mem_src(&state.cinfo, reinterpret_cast<const unsigned char*>(state.input.data()),
                 static_cast<unsigned long>(state.input.size()));
    jpeg_read_header(&state.cinfo, TRUE);
}

void start_reading(Decompression& state) {
    switch (state.cinfo.jpeg_color_space) {
        case JCS_GRAYSCALE:
            state.cinfo.out_color_space = JCS_GRAYSCALE;
            break;
        case JCS_CMYK:
        case JCS_YCCK:
            state.cinfo.out_color_space = JCS_CMYK;
            break;
        default:
            state.cinfo.out_color_space = JCS_RGB;
    }
    jpeg_start_decompress(&state.cinfo);
}

void read_row(Decompression& state) {
    jpeg_read_scanlines(&state.cinfo, &state.row, 1);
}

void finish_reading(Decompression& state) {
    jpeg_finish_decompress(&state.cinfo);
}

void start_writing(Compression& state) {
    jpeg_create_compress(&state.cinfo);
    jpeg_mem_dest(&state.cinfo, &state.output, &state.output_size);
    state.cinfo.image_width = JDIMENSION(state.image->width);
    state.cinfo.image_height = JDIMENSION(state.image->height);
    state.cinfo.input_components = state.channels;
    state.cinfo.in_color_space = state.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&state.cinfo);
    jpeg_set_quality(&state.cinfo, state.quality, TRUE);
    for (int i = 0; i < state.cinfo.num_components; ++i) {
        state.cinfo.comp_info[i].h_samp_factor = state.cinfo.comp_info[i].v_samp_factor = 1;
    }
    jpeg_start_compress(&state.cinfo, TRUE);
}

void write_row(Compression& state) {
    jpeg_write_scanlines(&state.cinfo, &state.row, 1);
}

void finish_writing(Compression& state) {
    jpeg_finish_compress(&state.cinfo);
}

class Reader {
  public:
    Reader(std::string_view bytes, const std::string& name) : name_(name) {
        prepare(state_.error);
        state_.cinfo.err = &state_.error.manager;
        state_.input = bytes;
    }
    ~Reader() { jpeg_destroy_decompress(&state_.cinfo); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    void check(void (*step)(Decompression&)) {
        if (!succeeds(state_, step)) {
            bad_image(name_, std::string("damaged JPEG: ") + state_.error.message);
        }
    }
    Decompression& state() { return state_; }

  private:
    Decompression state_;
    const std::string& name_;
};

class Writer {
  public:
    Writer(const EncodedImage& image, int quality) {
        prepare(state_.error);
        state_.cinfo.err = &state_.error.manager;
        state_.image = &image;
        state_.quality = quality;
        state_.channels = image.channels < 3 ? 1 : 3;
    }
    ~Writer() {
        jpeg_destroy_compress(&state_.cinfo);
        std::free(state_.output);
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void check(void (*step)(Compression&)) {
        if (!succeeds(state_, step)) {
            // libjpeg may have moved the buffer: this pointer is invalid.
            state_.output = nullptr;
            throw Error(ErrorKind::Usage,
                        std::string("cannot write a JPEG: ") + state_.error.message);
        }
    }
    Compression& state() { return state_; }

  private:
    Compression state_;
};

/// True if a file of several scans has all of them: each component, and of a progressive file each
/// bit of each coefficient. Call it between start and end of the decompression.
bool has_all_scans(const jpeg_decompress_struct& cinfo) {
    for (int i = 0; i < cinfo.num_components; ++i) {
        if (cinfo.comp_info[i].quant_table == nullptr) return false;
        if (cinfo.progressive_mode == 0) continue;
        const auto& missing = cinfo.coef_bits[i];
        if (std::any_of(missing, missing + DCTSIZE2, [](int bits) { return bits != 0; })) {
            return false;
        }
    }
    return true;
}

/// Memory that libjpeg uses for an image whose data come in several scans: a short for each
/// coefficient of each component, in whole blocks of 8 x 8 and whole groups of blocks.
std::uint64_t coefficient_bytes(jpeg_decompress_struct& cinfo) {
    if (!jpeg_has_multiple_scans(&cinfo)) return 0;
    std::uint64_t blocks = 0;
    for (int i = 0; i < cinfo.num_components; ++i) {
        const jpeg_component_info& c = cinfo.comp_info[i];
        const auto whole = [](std::uint64_t n, int group) {
            const auto g = std::uint64_t(group);
            return (n + g - 1) / g * g;
        };
        blocks +=
            whole(c.width_in_blocks, c.h_samp_factor) * whole(c.height_in_blocks, c.v_samp_factor);
    }
    return blocks * sizeof(JBLOCK);
}

/// Adobe stores 255 - ink.
void append_cmyk_row(std::vector<std::uint8_t>& codes, std::span<const JSAMPLE> row,
                     bool inverted) {
    for (std::size_t x = 0; x + 3 < row.size(); x += 4) {
        const auto light = [&](std::size_t i) {
            return unsigned(inverted ? row[x + i] : 255 - row[x + i]);
        };
        for (std::size_t i = 0; i < 3; ++i) {
            codes.push_back(std::uint8_t((light(i) * light(3) + 127) / 255));
        }
    }
}

void check_codes(const EncodedImage& image, int quality) {
    const auto fail = [](const std::string& why) {
        throw Error(ErrorKind::Usage, "cannot write a JPEG: " + why);
    };
    if (image.width <= 0 || image.height <= 0) fail("the picture is empty");
    if (image.width > JPEG_MAX_DIMENSION || image.height > JPEG_MAX_DIMENSION) {
        fail("a side is longer than " + std::to_string(JPEG_MAX_DIMENSION) + " pixels");
    }
    if (image.channels < 1 || image.channels > 4) fail("expected 1 to 4 channels");
    if (image.bits != 8) fail("expected 8 bits");
    if (quality < 1 || quality > 100) fail("expected a quality of 1 to 100");
    if (image.samples.size() !=
        std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels)) {
        fail("the samples do not fit the sizes");
    }
}

}  // namespace

StoredImage decode_jpeg(std::string_view bytes, const std::string& name,
                        const ImageLimits& limits) {
    Reader reader(bytes, name);
    reader.check(read_header);
    Decompression& state = reader.state();
    const auto width = std::int64_t(state.cinfo.image_width);
    const auto height = std::int64_t(state.cinfo.image_height);
    check_image_size(width, height, limits, name);
    // A block of 64 pixels takes at least one bit; a larger size is false.
    if (std::uint64_t(width) * std::uint64_t(height) > bytes.size() * 2048 + (1u << 20)) {
        bad_image(name, "damaged JPEG: the data end too early");
    }
    // At most three channels are kept; the coefficients are in memory too.
    const std::uint64_t kept = state.cinfo.num_components == 1 ? 1 : 3;
    check_image_memory(sample_bytes(width, height, kept, 1) + coefficient_bytes(state.cinfo),
                       limits, name);
    reader.check(start_reading);
    // Then all scans have been read.
    if (state.error.lacks_end && !has_all_scans(state.cinfo)) {
        bad_image(name, "damaged JPEG: the data end too early");
    }
    const int channels = state.cinfo.out_color_components;
    StoredImage image{int(width), int(height), channels == 1 ? 1 : 3, false, {}};
    std::vector<std::uint8_t> codes;
    codes.reserve(std::size_t(width) * std::size_t(height) * std::size_t(image.channels));
    std::vector<JSAMPLE> row(std::size_t(width) * std::size_t(channels));
    state.row = row.data();
    for (std::int64_t y = 0; y < height; ++y) {
        reader.check(read_row);
        if (channels == 4) {
            append_cmyk_row(codes, row, state.cinfo.saw_Adobe_marker != 0);
        } else {
            codes.insert(codes.end(), row.begin(), row.end());
        }
    }
    reader.check(finish_reading);
    image.samples = std::move(codes);
    return image;
}

std::vector<std::byte> encode_jpeg(const EncodedImage& image, int quality) {
    check_codes(image, quality);
    Writer writer(image, quality);
    Compression& state = writer.state();
    writer.check(start_writing);
    const auto width = std::size_t(image.width);
    const auto in_channels = std::size_t(image.channels), channels = std::size_t(state.channels);
    std::vector<JSAMPLE> row(width * channels);
    state.row = row.data();
    for (std::size_t y = 0; y < std::size_t(image.height); ++y) {
        const std::uint16_t* codes = image.samples.data() + y * width * in_channels;
        for (std::size_t x = 0; x < width; ++x) {
            for (std::size_t i = 0; i < channels; ++i) {
                row[x * channels + i] = JSAMPLE(codes[x * in_channels + i]);
            }
        }
        writer.check(write_row);
    }
    writer.check(finish_writing);
    const auto* begin = reinterpret_cast<const std::byte*>(state.output);
    return {begin, begin + state.output_size};
}

}  // namespace alhazen
