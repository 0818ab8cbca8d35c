#include "reradiant/spectral_image.h"

#include "host/exr/exr_input.h"
#include "host/exr/exr_window.h"
#include "host/film/exr_layout.h"
#include "host/film/spectral_channels.h"
#include "host/film/spectral_part.h"
#include "reradiant/error.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <unistd.h>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

/// A band's channel in a file.
struct BandChannel {
    RoundedWavelength wavelength;
    std::string name;
};

[[noreturn]] void refuse(const fs::path& file, const std::string& wrong,
                         const std::string& remedy) {
    throw_input_error({file.string()}, wrong, remedy);
}

std::vector<BandChannel> band_channels(const Imf::Header& header) {
    std::vector<BandChannel> bands;
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        if (const auto wavelength = band_of_channel(channel.name()))
            bands.push_back({*wavelength, channel.name()});
    std::sort(bands.begin(), bands.end(), [](const BandChannel& a, const BandChannel& b) {
        return a.wavelength.nm < b.wavelength.nm;
    });
    return bands;
}

void check_channel(const fs::path& file, const Imf::Header& header, const std::string& name) {
    const Imf::Channel* const channel = header.channels().findChannel(name);
    if (!channel)
        refuse(file, fmt::format("channel {} is missing", name), "render the image again");
    if (channel->type != Imf::FLOAT && channel->type != Imf::HALF)
        refuse(file, fmt::format("channel {} holds integers", name),
               "write radiance as 32-bit float");
    if (channel->xSampling != 1 || channel->ySampling != 1)
        refuse(file, fmt::format("channel {} is subsampled", name),
               "write one value for every pixel");
}

/// The size is known before any pixel: refuses what this machine cannot hold.
void check_memory(const fs::path& file, const ExrWindow& window, std::size_t channels) {
    check_display_window(file, window, channels);
    const std::size_t pixels =
        window.pixels() + (window.data == window.display ? 0 : window.data_pixels());
    const double bytes =
        static_cast<double>(pixels) * static_cast<double>(channels) * sizeof(float);
    const double memory = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                          static_cast<double>(::sysconf(_SC_PAGESIZE));
    if (bytes > 0.8 * memory)
        refuse(file,
               fmt::format("needs {:.3g} GB of memory, this machine has {:.3g} GB", bytes * 1e-9,
                           memory * 1e-9),
               "crop the image or use fewer bands");
}

/// The grid of the bands: the exact one from the attributes where it agrees with the names.
WavelengthGrid grid_of(const fs::path& file, const Imf::Header& header,
                       const std::vector<BandChannel>& bands) {
    const auto* const first =
        header.findTypedAttribute<Imf::DoubleAttribute>(exr_layout::first_band_attribute);
    const auto* const step =
        header.findTypedAttribute<Imf::DoubleAttribute>(exr_layout::band_step_attribute);
    if (first && step && std::isfinite(step->value()) && step->value() > 0) {
        const WavelengthGrid grid{first->value(), step->value(), static_cast<int>(bands.size())};
        bool agrees = true;
        for (int band = 0; band < grid.count; ++band) {
            const RoundedWavelength& named = bands[static_cast<std::size_t>(band)].wavelength;
            agrees = agrees && std::abs(grid.centre_nm(band) - named.nm) <= 1e-6;
        }
        if (agrees)
            return grid;
    }
    std::vector<RoundedWavelength> centres;
    for (const BandChannel& band : bands)
        centres.push_back(band.wavelength);
    try {
        return grid_from_rounded_centres(centres);
    } catch (const std::invalid_argument& error) {
        refuse(file, fmt::format("spectral channels are missing or uneven: {}", error.what()),
               "the S0 channels must ascend in equal steps");
    }
}

/// A `Target` says where the values of one channel go; `stride` is the number of floats from one
/// pixel to the next.
struct Target {
    std::string channel;
    float* first;
    int stride;
};

void read_rows(Imf::MultiPartInputFile& input, int part, const std::vector<Target>& targets) {
    const ExrWindow window(input.header(part));
    Imf::FrameBuffer frame;
    for (const Target& target : targets) {
        const std::size_t x_stride = static_cast<std::size_t>(target.stride) * sizeof(float);
        frame.insert(target.channel,
                     Imf::Slice::Make(Imf::FLOAT, target.first, window.data, x_stride,
                                      x_stride * static_cast<std::size_t>(window.data_width())));
    }
    Imf::InputPart reader(input, part);
    reader.setFrameBuffer(frame);
    reader.readPixels(window.data.min.y, window.data.max.y);
}

[[noreturn]] void refuse_no_spectrum(const fs::path& file, const Imf::Header& header) {
    constexpr std::size_t most_names = 8;
    std::vector<std::string> names;
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        if (std::string_view(channel.name()).starts_with("T."))
            refuse(file, "holds reflectance or re-radiation (T channels), no radiance",
                   "give an image with channels S0.<nm>nm");
        else if (names.size() < most_names)
            names.emplace_back(channel.name());
    refuse(file,
           fmt::format("has no spectral channels (S0.<nm>nm), but {}", fmt::join(names, ", ")),
           "give a spectral image as `reradiant render` writes it");
}

/// A band whose name is not understood would leave the spectrum without it.
void check_names(const fs::path& file, const Imf::Header& header) {
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        if (std::string_view(channel.name()).starts_with("S0.") && !band_of_channel(channel.name()))
            refuse(file, fmt::format("channel {} names no wavelength", channel.name()),
                   "name it like S0.380,000000nm");
}

void read_statistics(Imf::MultiPartInputFile& input, int part, int image_part, const fs::path& file,
                     SpectralImage& image) {
    const Imf::Header& header = input.header(part);
    if (header.dataWindow() != input.header(image_part).dataWindow())
        refuse(file, "the data windows of image and statistics differ", "render the image again");
    const ExrWindow window(header);
    std::vector<Target> targets;
    const auto want = [&](const char* name, std::vector<float>& values) {
        if (!header.channels().findChannel(name))
            return;
        values.resize(window.data_pixels());
        targets.push_back({name, values.data(), 1});
    };
    want(exr_layout::sample_count_channel, image.sample_count);
    want(exr_layout::variance_y_channel, image.variance_y);
    const std::string first_band =
        exr_layout::variance_prefix + spectral_channel_name(image.bands.centre_nm(0));
    if (header.channels().findChannel(first_band)) {
        check_memory(file, window, static_cast<std::size_t>(image.bands.count));
        image.variance_bands.resize(window.data_pixels() *
                                    static_cast<std::size_t>(image.bands.count));
        for (int band = 0; band < image.bands.count; ++band)
            targets.push_back(
                {exr_layout::variance_prefix + spectral_channel_name(image.bands.centre_nm(band)),
                 image.variance_bands.data() + band, image.bands.count});
    }
    for (const Target& target : targets)
        check_channel(file, header, target.channel);
    if (!targets.empty())
        read_rows(input, part, targets);
    for (std::vector<float>* const values : {&image.sample_count, &image.variance_y})
        *values = fit_to_display(std::move(*values), window, 1);
    image.variance_bands = fit_to_display(std::move(image.variance_bands), window,
                                          static_cast<std::size_t>(image.bands.count));
}

} // namespace

int spectral_part(const Imf::MultiPartInputFile& input) {
    for (int part = 0; part < input.parts(); ++part)
        if (!band_channels(input.header(part)).empty())
            return part;
    return 0;
}

SpectralImage read_spectral_part(Imf::MultiPartInputFile& input, int part, const fs::path& file) {
    const Imf::Header& header = input.header(part);
    if (header.hasType() && Imf::isDeepData(header.type()))
        refuse(file, "holds deep data", "give a flat spectral image");
    const std::vector<BandChannel> bands = band_channels(header);
    if (bands.empty())
        refuse_no_spectrum(file, header);
    check_names(file, header);
    const ExrWindow window(header);
    check_memory(file, window, bands.size());
    for (const BandChannel& band : bands)
        check_channel(file, header, band.name);

    SpectralImage image;
    image.width = static_cast<int>(window.width());
    image.height = static_cast<int>(window.height());
    image.left = window.display.min.x;
    image.top = window.display.min.y;
    image.bands = grid_of(file, header, bands);
    std::vector<float> values(window.data_pixels() * bands.size());
    std::vector<Target> targets;
    for (std::size_t band = 0; band < bands.size(); ++band)
        targets.push_back({bands[band].name, values.data() + band, image.bands.count});
    read_rows(input, part, targets);
    image.values = fit_to_display(std::move(values), window, bands.size());
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const auto* const text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
        if (text && std::string_view(attribute.name()).starts_with(exr_layout::attribute_prefix))
            image.attributes[attribute.name()] = text->value();
    }
    return image;
}

SpectralImage read_spectral_exr(const fs::path& file) {
    return with_exr_input(file, [&](Imf::MultiPartInputFile& input) {
        const int image_part = spectral_part(input);
        SpectralImage image = read_spectral_part(input, image_part, file);
        for (int part = 0; part < input.parts(); ++part)
            if (part != image_part && input.header(part).hasName() &&
                input.header(part).name() == exr_layout::statistics_part)
                read_statistics(input, part, image_part, file, image);
        return image;
    });
}

} // namespace reradiant
