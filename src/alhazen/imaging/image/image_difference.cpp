#include "alhazen/imaging/image/image_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "alhazen/base/error.h"

namespace alhazen {

namespace {

/// 1/255, plus the rounding of samples divided by 255 in float.
constexpr double kOneStep = 1.0 / 255.0 + 1e-6;

double distance(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
    const double d = std::abs(a - b);
    return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

void check_comparable(const Image& a, const Image& b) {
    const auto size = [](const Image& image) {
        return std::to_string(image.width) + " x " + std::to_string(image.height);
    };
    if (a.width != b.width || a.height != b.height) {
        throw Error(ErrorKind::Usage,
                    "cannot compare pictures of different sizes, " + size(a) + " and " + size(b));
    }
    if (a.linear != b.linear) {
        throw Error(ErrorKind::Usage,
                    "cannot compare a linear picture with one that is encoded for display");
    }
}

int compared_channels(const Image& a, const Image& b) {
    return a.channels < 3 && b.channels < 3 ? 1 : 3;
}

}  // namespace

ImageDifference difference(const Image& a, const Image& b) {
    check_comparable(a, b);
    const int channels = compared_channels(a, b);
    ImageDifference result;
    double sum = 0, sum_of_squares = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const Rgb one = a.rgb(x, y), other = b.rgb(x, y);
            double largest = 0;
            for (int i = 0; i < channels; ++i) {
                const double d = distance(one[i], other[i]);
                largest = std::max(largest, d);
                sum += d;
                sum_of_squares += d * d;
            }
            ++result.pixels;
            result.identical += largest == 0 ? 1 : 0;
            result.within_one_step += largest <= kOneStep ? 1 : 0;
            result.max_absolute = std::max(result.max_absolute, largest);
        }
    }
    if (result.pixels > 0) {
        const double count = double(result.pixels) * channels;
        result.mean_absolute = sum / count;
        result.rmse = std::sqrt(sum_of_squares / count);
    }
    result.psnr_db = -20.0 * std::log10(result.rmse);
    return result;
}

Image difference_image(const Image& a, const Image& b) {
    check_comparable(a, b);
    const int channels = compared_channels(a, b);
    Image result(a.width, a.height, channels);
    result.linear = a.linear;
    float largest = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const Rgb one = a.rgb(x, y), other = b.rgb(x, y);
            for (int i = 0; i < channels; ++i) {
                const auto d = float(distance(one[i], other[i]));
                result.pixel(x, y)[i] = d;
                if (std::isfinite(d)) largest = std::max(largest, d);
            }
        }
    }
    for (float& sample : result.samples) {
        if (!std::isfinite(sample)) {
            sample = 1;
        } else if (largest > 0) {
            sample /= largest;
        }
    }
    return result;
}

}  // namespace alhazen
