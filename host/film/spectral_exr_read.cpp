#include "host/error.h"
#include "host/film/exr_input.h"
#include "host/film/exr_layout.h"
#include "host/film/spectral_channels.h"
#include "host/film/spectral_image.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unistd.h>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

/// A band's channel in a file.
struct BandChannel {
    double wavelength_nm;
    std::string name;
};

[[noreturn]] void refuse(const fs::path& file, const std::string& wrong,
                         const std::string& remedy) {
    throw_input_error({file.string()}, wrong, remedy);
}

int width_of(const Imath::Box2i& window) {
    return window.max.x - window.min.x + 1;
}
int height_of(const Imath::Box2i& window) {
    return window.max.y - window.min.y + 1;
}

std::vector<BandChannel> band_channels(const Imf::Header& header) {
    std::vector<BandChannel> bands;
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        if (const auto wavelength_nm = wavelength_of_channel(channel.name()))
            bands.push_back({*wavelength_nm, channel.name()});
    std::sort(bands.begin(), bands.end(), [](const BandChannel& a, const BandChannel& b) {
        return a.wavelength_nm < b.wavelength_nm;
    });
    return bands;
}

void check_channel(const fs::path& file, const Imf::Header& header, const std::string& name) {
    const Imf::Channel* const channel = header.channels().findChannel(name);
    if (!channel)
        refuse(file, fmt::format("channel {} is missing", name), "render the image again");
    if (channel->type != Imf::FLOAT)
        refuse(file, fmt::format("channel {} is not of type FLOAT", name),
               "radiance does not fit half floats or integers; write it as 32-bit float");
    if (channel->xSampling != 1 || channel->ySampling != 1)
        refuse(file, fmt::format("channel {} is subsampled", name),
               "write one value for every pixel");
}

/// The size is known before any pixel: refuses what this machine cannot hold.
void check_memory(const fs::path& file, const Imf::Header& header, std::size_t channels) {
    const Imath::Box2i window = header.dataWindow();
    const double bytes = static_cast<double>(width_of(window)) * height_of(window) *
                         static_cast<double>(channels) * sizeof(float);
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
        for (int band = 0; band < grid.count; ++band)
            agrees =
                agrees && std::abs(grid.centre_nm(band) -
                                   bands[static_cast<std::size_t>(band)].wavelength_nm) <= 1e-6;
        if (agrees)
            return grid;
    }
    std::vector<double> centres_nm;
    for (const BandChannel& band : bands)
        centres_nm.push_back(band.wavelength_nm);
    try {
        return grid_from_centres(centres_nm);
    } catch (const std::invalid_argument& error) {
        refuse(file, fmt::format("spectral channels are missing or uneven: {}", error.what()),
               "the S0 channels must ascend in equal steps");
    }
}

/// Where one channel's values go: `stride` floats from one pixel to the next.
struct Target {
    std::string channel;
    float* first;
    int stride;
};

void read_rows(Imf::MultiPartInputFile& input, int part, const std::vector<Target>& targets) {
    const Imf::Header& header = input.header(part);
    const Imath::Box2i window = header.dataWindow();
    const auto width = static_cast<std::size_t>(width_of(window));
    Imf::FrameBuffer frame;
    for (const Target& target : targets) {
        const std::size_t x_stride = static_cast<std::size_t>(target.stride) * sizeof(float);
        frame.insert(target.channel, Imf::Slice::Make(Imf::FLOAT, target.first, window, x_stride,
                                                      x_stride * width));
    }
    Imf::InputPart reader(input, part);
    reader.setFrameBuffer(frame);
    reader.readPixels(window.min.y, window.max.y);
}

void read_image(Imf::MultiPartInputFile& input, const fs::path& file, SpectralImage& image) {
    const Imf::Header& header = input.header(0);
    if (header.hasType() && Imf::isDeepData(header.type()))
        refuse(file, "holds deep data", "give a flat spectral image");
    const std::vector<BandChannel> bands = band_channels(header);
    if (bands.empty())
        refuse(file, "has no spectral channels (S0.<nm>nm)",
               "give a spectral image as `reradiant render` writes it");
    check_memory(file, header, bands.size());
    for (const BandChannel& band : bands)
        check_channel(file, header, band.name);

    image.width = width_of(header.dataWindow());
    image.height = height_of(header.dataWindow());
    image.bands = grid_of(file, header, bands);
    image.values.resize(static_cast<std::size_t>(image.width) *
                        static_cast<std::size_t>(image.height) * bands.size());
    std::vector<Target> targets;
    for (std::size_t band = 0; band < bands.size(); ++band)
        targets.push_back({bands[band].name, image.values.data() + band, image.bands.count});
    read_rows(input, 0, targets);
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const auto* const text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
        if (text && std::string_view(attribute.name()).starts_with(exr_layout::attribute_prefix))
            image.attributes[attribute.name()] = text->value();
    }
}

void read_statistics(Imf::MultiPartInputFile& input, int part, const fs::path& file,
                     SpectralImage& image) {
    const Imf::Header& header = input.header(part);
    if (header.dataWindow() != input.header(0).dataWindow())
        refuse(file, "the data windows of image and statistics differ", "render the image again");
    const std::size_t pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::vector<Target> targets;
    const auto want = [&](const char* name, std::vector<float>& values) {
        if (!header.channels().findChannel(name))
            return;
        values.resize(pixels);
        targets.push_back({name, values.data(), 1});
    };
    want(exr_layout::sample_count_channel, image.sample_count);
    want(exr_layout::variance_y_channel, image.variance_y);
    const std::string first_band =
        exr_layout::variance_prefix + spectral_channel_name(image.bands.centre_nm(0));
    if (header.channels().findChannel(first_band)) {
        check_memory(file, header, static_cast<std::size_t>(image.bands.count));
        image.variance_bands.resize(image.values.size());
        for (int band = 0; band < image.bands.count; ++band)
            targets.push_back(
                {exr_layout::variance_prefix + spectral_channel_name(image.bands.centre_nm(band)),
                 image.variance_bands.data() + band, image.bands.count});
    }
    for (const Target& target : targets)
        check_channel(file, header, target.channel);
    if (!targets.empty())
        read_rows(input, part, targets);
}

} // namespace

SpectralImage read_spectral_exr(const fs::path& file) {
    return with_exr_input(file, [&](Imf::MultiPartInputFile& input) {
        SpectralImage image;
        read_image(input, file, image);
        for (int part = 1; part < input.parts(); ++part)
            if (input.header(part).hasName() &&
                input.header(part).name() == exr_layout::statistics_part)
                read_statistics(input, part, file, image);
        return image;
    });
}

} // namespace reradiant
