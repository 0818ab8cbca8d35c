#include "reradiant/spectral_image.h"

#include "host/base/atomic_file.h"
#include "host/film/checked_stream.h"
#include "host/film/exr_layout.h"
#include "host/film/light_layer_header.h"
#include "host/film/spectral_channels.h"
#include "reradiant/error.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace reradiant {

namespace {

std::size_t pixel_count(const SpectralImage& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

/// The arrays must fit together, or the writer would read beyond them.
void check_shape(const SpectralImage& image) {
    const std::size_t pixels = pixel_count(image);
    const std::size_t entries = pixels * static_cast<std::size_t>(std::max(image.bands.count, 0));
    const auto fits = [](std::size_t size, std::size_t wanted) {
        return size == 0 || size == wanted;
    };
    if (image.width < 1 || image.height < 1 || image.bands.count < 1 ||
        image.values.size() != entries || !fits(image.sample_count.size(), pixels) ||
        !fits(image.variance_y.size(), pixels) || !fits(image.variance_bands.size(), entries))
        throw_runtime_error(fmt::format("the image's arrays do not fit its {} x {} pixels of {} "
                                        "bands",
                                        image.width, image.height, image.bands.count));
    if (image.bands.step_nm < 1e-5)
        throw_input_error({},
                          fmt::format("bands {} nm apart cannot be told apart in an EXR file",
                                      image.bands.step_nm),
                          "take steps of at least 1e-5 nm");
}

Imf::Header part_header(const SpectralImage& image, const char* name) {
    const Imath::V2i first(image.left, image.top);
    const Imath::Box2i window(first, first + Imath::V2i(image.width - 1, image.height - 1));
    Imf::Header header(window, window);
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = 1; // a tenth less time, files half a per cent larger
    return header;
}

void add_spectral_attributes(Imf::Header& header, const SpectralImage& image) {
    header.insert("spectralLayoutVersion", Imf::StringAttribute("1.0"));
    header.insert("emissiveUnits", Imf::StringAttribute("W.m^-2.sr^-1"));
    header.insert(exr_layout::quantity_attribute, Imf::StringAttribute("radiance per nm"));
    header.insert(exr_layout::first_band_attribute, Imf::DoubleAttribute(image.bands.from_nm));
    header.insert(exr_layout::band_step_attribute, Imf::DoubleAttribute(image.bands.step_nm));
}

void add_attributes(Imf::Header& header, const SpectralImage& image, double exposure_ev) {
    add_spectral_attributes(header, image);
    header.insert("EV", Imf::FloatAttribute(static_cast<float>(exposure_ev)));
    for (const auto& [key, text] : image.attributes) {
        const bool has_prefix = key.find(':') != std::string::npos;
        const std::string name = has_prefix ? key : exr_layout::attribute_prefix + key;
        header.insert(name, Imf::StringAttribute(text));
    }
}

/// One part under construction: its channels and where their values lie.
struct Part {
    Imf::Header header;
    Imf::FrameBuffer frame;

    /// Adds a FLOAT channel; `stride` is the count of floats from one pixel to the next.
    void add(const std::string& name, const SpectralImage& image, const float* first, int stride) {
        const std::size_t x_stride = static_cast<std::size_t>(stride) * sizeof(float);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, first, header.dataWindow(), x_stride,
                                            x_stride * static_cast<std::size_t>(image.width)));
    }
    void add_bands(const SpectralImage& image, const std::vector<float>& values) {
        for (int band = 0; band < image.bands.count; ++band)
            add(spectral_channel_name(image.bands.centre_nm(band)), image, values.data() + band,
                image.bands.count);
    }
};

Part image_part(const SpectralImage& image, const std::vector<float>& rgb, double exposure_ev) {
    Part part{part_header(image, exr_layout::image_part), {}};
    add_attributes(part.header, image, exposure_ev);
    part.add_bands(image, image.values);
    const char* const names[] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel)
        part.add(names[channel], image, rgb.data() + channel, 3);
    return part;
}

Part statistics_part(const SpectralImage& image) {
    Part part{part_header(image, exr_layout::statistics_part), {}};
    if (!image.sample_count.empty())
        part.add(exr_layout::sample_count_channel, image, image.sample_count.data(), 1);
    if (!image.variance_y.empty())
        part.add(exr_layout::variance_y_channel, image, image.variance_y.data(), 1);
    if (!image.variance_bands.empty())
        for (int band = 0; band < image.bands.count; ++band)
            part.add(exr_layout::variance_prefix +
                         spectral_channel_name(image.bands.centre_nm(band)),
                     image, image.variance_bands.data() + band, image.bands.count);
    return part;
}

Part layer_part(const SpectralImage& image, const LightLayer& layer) {
    Part part{part_header(image, (exr_layout::light_prefix + layer.name()).c_str()), {}};
    add_spectral_attributes(part.header, image);
    describe_layer(part.header, layer);
    part.add_bands(image, layer.values);
    return part;
}

void write_parts(const std::filesystem::path& file, const std::vector<Part>& parts) {
    std::vector<Imf::Header> headers;
    for (const Part& part : parts)
        headers.push_back(part.header);
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    if (Imf::globalThreadCount() < threads)
        Imf::setGlobalThreadCount(threads);
    CheckedStream stream(file);
    {
        Imf::MultiPartOutputFile output(stream, headers.data(), static_cast<int>(headers.size()),
                                        false, threads);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            Imf::OutputPart writer(output, static_cast<int>(i));
            writer.setFrameBuffer(parts[i].frame);
            const Imath::Box2i& window = parts[i].header.dataWindow();
            writer.writePixels(window.max.y - window.min.y + 1);
        }
    }
    stream.finish();
}

} // namespace

void write_spectral_exr(const std::filesystem::path& file, const SpectralImage& image,
                        double exposure_ev) {
    write_spectral_exr(file, image, exposure_ev, {});
}

void write_spectral_exr(const std::filesystem::path& file, const SpectralImage& image,
                        double exposure_ev, std::span<const LightLayer> layers) {
    check_shape(image);
    for (const LightLayer& layer : layers)
        if (layer.values.size() != image.values.size())
            throw_runtime_error(
                fmt::format("the light layer {} does not fit the image", layer.name()));
    std::vector<float> rgb = linear_srgb(image);
    const double gain = std::exp2(exposure_ev);
    for (float& value : rgb)
        value = static_cast<float>(value * gain);

    std::vector<Part> parts{image_part(image, rgb, exposure_ev)};
    if (!image.sample_count.empty() || !image.variance_y.empty() || !image.variance_bands.empty())
        parts.push_back(statistics_part(image));
    for (const LightLayer& layer : layers)
        parts.push_back(layer_part(image, layer));
    write_atomically(file,
                     [&](const std::filesystem::path& target) { write_parts(target, parts); });
}

} // namespace reradiant
