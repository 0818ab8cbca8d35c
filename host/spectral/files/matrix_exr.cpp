#include "host/spectral/files/matrix_formats.h"

#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/exr/exr_input.h"
#include "host/exr/exr_window.h"
#include "host/spectral/spectrum/spectral_names.h"
#include "reradiant/spectral_files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

// Bispectral image of one pixel in the layout of Fichet, Pacanowski and Wilkie, "An OpenEXR
// Layout for Spectral Images", JCGT 10(3), 2021: channels T.<excitation>nm.<emission>nm, the
// diagonal T.<wavelength>nm, a comma for the decimal point. Channels that are not there are zero.
// Those that are written are FLOAT: the file keeps about 7 digits, a CSV keeps all.

namespace reradiant {

namespace {

constexpr double name_rounding_nm = 1e-6;

/// OpenImageIO refuses more unless told otherwise.
constexpr std::size_t most_channels_elsewhere = 1024;

struct Channel {
    std::string name;
    RoundedWavelength excitation, emission;
    float value = 0.0f;
};
/// Wavelengths of an axis, ascending.
using Axis = std::map<double, RoundedWavelength>;

std::string channel_name(double excitation_nm, double emission_nm, bool diagonal) {
    return diagonal ? "T." + wavelength_name(emission_nm)
                    : "T." + wavelength_name(excitation_nm) + "." + wavelength_name(emission_nm);
}

std::optional<Channel> parse_channel(const std::string& name) {
    std::string_view rest = name;
    if (!rest.starts_with("T."))
        return std::nullopt;
    rest.remove_prefix(2);
    const auto first = take_named_wavelength(rest);
    if (first && rest.empty())
        return Channel{name, *first, *first, 0.0f};
    if (!first || !rest.starts_with('.'))
        return std::nullopt;
    rest.remove_prefix(1);
    const auto second = take_named_wavelength(rest);
    if (!second || !rest.empty())
        return std::nullopt;
    return Channel{name, *first, *second, 0.0f};
}

std::string text_attribute(const Imf::Header& header, const char* name) {
    const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
    return attribute ? attribute->value() : std::string();
}

double number_attribute(const Imf::Header& header, const char* name, double otherwise) {
    const auto* attribute = header.findTypedAttribute<Imf::DoubleAttribute>(name);
    return attribute ? attribute->value() : otherwise;
}

std::vector<Channel> channels_of(const Imf::Header& header, const SourcePosition& position) {
    std::vector<Channel> channels;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const auto channel = parse_channel(it.name());
        if (!channel && std::string_view(it.name()).starts_with("T."))
            throw_input_error(position, fmt::format("channel {} names no wavelengths", it.name()),
                              "name it like T.380,000000nm.520,000000nm");
        if (!channel)
            continue;
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            throw_input_error(position, fmt::format("channel {} is subsampled", it.name()),
                              "every channel of a matrix holds one pixel");
        channels.push_back(*channel);
    }
    if (channels.empty())
        throw_input_error(position, "no channels of a bispectral image",
                          "they are named like T.380,000000nm.520,000000nm");
    return channels;
}

/// The grid that the attributes give, where every name lies on it.
std::optional<WavelengthGrid> exact_grid(const Imf::Header& header, const std::string& prefix,
                                         const Axis& axis) {
    const auto* const count = header.findTypedAttribute<Imf::IntAttribute>(prefix + "Count");
    const WavelengthGrid grid{number_attribute(header, (prefix + "FromNm").c_str(), 0.0),
                              number_attribute(header, (prefix + "StepNm").c_str(), 0.0),
                              count ? count->value() : static_cast<int>(axis.size())};
    if (!(grid.step_nm > 0.0 && grid.from_nm > 0.0 && std::isfinite(grid.to_nm())))
        return std::nullopt;
    for (const auto& [nm, ignored] : axis) {
        const int band = grid.band_of(nm);
        if (band < 0 || std::abs(grid.centre_nm(band) - nm) > name_rounding_nm)
            return std::nullopt;
    }
    return grid;
}

/// Grid of one axis: from the exact attributes when they agree with the names, else from the names.
WavelengthGrid grid_of(const Imf::Header& header, const std::string& axis_name, const Axis& axis,
                       const SourcePosition& position) {
    const std::string prefix = "reradiant:" + axis_name;
    if (const auto exact = exact_grid(header, prefix, axis))
        return *exact;
    const double step_nm = number_attribute(header, (prefix + "StepNm").c_str(), 0.0);
    if (axis.size() == 1 && !(step_nm > 0.0))
        throw_input_error(position,
                          fmt::format("the step of the only {} band is not given", axis_name),
                          fmt::format("add the attribute {}StepNm (double)", prefix));
    std::vector<RoundedWavelength> wavelengths;
    for (const auto& [ignored, wavelength] : axis)
        wavelengths.push_back(wavelength);
    try {
        return grid_from_rounded_centres(wavelengths, step_nm);
    } catch (const std::invalid_argument& error) {
        throw_input_error(position, fmt::format("{} wavelengths: {}", axis_name, error.what()),
                          "bands must be equally spaced");
    }
}

void read_values(Imf::MultiPartInputFile& file, int part, std::vector<Channel>& channels,
                 const SourcePosition& position) {
    const ExrWindow window(file.header(part));
    if (window.data.min != window.data.max || window.display != window.data)
        throw_input_error(position, "the image is not of one pixel",
                          "a re-radiation matrix is an image of 1 x 1");
    Imf::FrameBuffer buffer;
    for (Channel& channel : channels) {
        // OpenEXR addresses pixels from the origin of coordinates, not of the window.
        buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, &channel.value, window.data,
                                                     sizeof(float), sizeof(float)));
    }
    Imf::InputPart reader(file, part);
    reader.setFrameBuffer(buffer);
    reader.readPixels(window.data.min.y);
    for (const Channel& channel : channels)
        if (!std::isfinite(channel.value))
            throw_input_error(position, fmt::format("channel {} is not finite", channel.name),
                              "every value of a matrix is a number");
}

MatrixQuantity quantity_of(const Imf::Header& header, const SourcePosition& position) {
    const std::string quantity = text_attribute(header, "reradiant:quantity");
    if (quantity != "per-band" && quantity != "density-per-nm")
        throw_input_error(position,
                          quantity.empty() ? "the quantity is not declared"
                                           : fmt::format("quantity '{}' is not known", quantity),
                          "set the attribute reradiant:quantity to per-band or density-per-nm");
    return quantity == "per-band" ? MatrixQuantity::PerBand : MatrixQuantity::DensityPerNm;
}

/// Channels that the file leaves out are zero.
void fill(ReradiationMatrix& matrix, const std::vector<Channel>& channels,
          const SourcePosition& position) {
    matrix.values.setZero(matrix.emission.count, matrix.excitation.count);
    std::map<std::pair<int, int>, const Channel*> given;
    for (const Channel& channel : channels) {
        const std::pair entry{matrix.emission.band_of(channel.emission.nm),
                              matrix.excitation.band_of(channel.excitation.nm)};
        const auto [other, is_new] = given.try_emplace(entry, &channel);
        if (!is_new)
            throw_input_error(position,
                              fmt::format("channels {} and {} hold the same entry",
                                          other->second->name, channel.name),
                              "give it once");
        matrix.values(entry.first, entry.second) = channel.value;
    }
}

/// The first part with channels of a matrix; the first of all where none has any.
int matrix_part(const Imf::MultiPartInputFile& file) {
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::ChannelList& channels = file.header(part).channels();
        for (auto channel = channels.begin(); channel != channels.end(); ++channel)
            if (parse_channel(channel.name()))
                return part;
    }
    return 0;
}

ReradiationMatrix matrix_of(Imf::MultiPartInputFile& file, const SourcePosition& position) {
    const int part = matrix_part(file);
    const Imf::Header& header = file.header(part);
    if (header.hasType() && Imf::isDeepData(header.type()))
        throw_input_error(position, "the image is deep", "a re-radiation matrix is a flat image");
    std::vector<Channel> channels = channels_of(header, position);
    Axis emission, excitation;
    for (const Channel& channel : channels) {
        emission.emplace(channel.emission.nm, channel.emission);
        excitation.emplace(channel.excitation.nm, channel.excitation);
    }
    const MatrixQuantity quantity = quantity_of(header, position);
    ReradiationMatrix matrix;
    matrix.emission = grid_of(header, "emission", emission, position);
    matrix.excitation = grid_of(header, "excitation", excitation, position);
    require_matrix_size(position, static_cast<std::size_t>(matrix.emission.count),
                        static_cast<std::size_t>(matrix.excitation.count));
    matrix.kind = text_attribute(header, "reradiant:kind") == "measured" ? MatrixKind::Measured
                                                                         : MatrixKind::Model;
    matrix.anti_stokes_allowed = text_attribute(header, "reradiant:antiStokes") == "allowed";
    matrix.geometry = text_attribute(header, "reradiant:geometry");
    read_values(file, part, channels, position);
    fill(matrix, channels, position);
    if (quantity == MatrixQuantity::DensityPerNm)
        scale_off_diagonal(matrix, matrix.excitation.step_nm);
    return matrix;
}

void set_attributes(Imf::Header& header, const ReradiationMatrix& matrix) {
    const auto text = [&](const char* name, const std::string& value) {
        header.insert(name, Imf::StringAttribute(value));
    };
    const auto number = [&](const char* name, double value) {
        header.insert(name, Imf::DoubleAttribute(value));
    };
    text("spectralLayoutVersion", "1.0");
    text("reradiant:quantity", "per-band");
    text("reradiant:kind", matrix.kind == MatrixKind::Model ? "model" : "measured");
    text("reradiant:antiStokes", matrix.anti_stokes_allowed ? "allowed" : "refused");
    text("reradiant:geometry", matrix.geometry);
    const auto grid = [&](const std::string& prefix, const WavelengthGrid& bands) {
        number((prefix + "FromNm").c_str(), bands.from_nm);
        number((prefix + "StepNm").c_str(), bands.step_nm);
        header.insert(prefix + "Count", Imf::IntAttribute(bands.count));
    };
    grid("reradiant:emission", matrix.emission);
    grid("reradiant:excitation", matrix.excitation);
}

/// Returns the channels of a matrix without entries that are impossible: emission below the
/// excitation, and zero.
std::vector<Channel> channels_to_write(const ReradiationMatrix& matrix) {
    std::vector<Channel> channels;
    for (int i = 0; i < matrix.excitation.count; ++i) {
        const int diagonal = diagonal_row(matrix, i);
        for (int o = 0; o < matrix.emission.count; ++o) {
            const double li = matrix.excitation.centre_nm(i), lo = matrix.emission.centre_nm(o);
            const auto value = static_cast<float>(matrix.values(o, i));
            if (o != diagonal && lo < li && value == 0.0f)
                continue;
            channels.push_back({channel_name(li, lo, o == diagonal), {li, 0.0}, {lo, 0.0}, value});
        }
    }
    // An image has a channel, though it be an impossible one.
    if (channels.empty()) {
        const double li = matrix.excitation.centre_nm(0), lo = matrix.emission.centre_nm(0);
        channels.push_back({channel_name(li, lo, false), {li, 0.0}, {lo, 0.0}, 0.0f});
    }
    return channels;
}

void warn_of_count(const std::filesystem::path& file, std::size_t channels) {
    if (channels > most_channels_elsewhere)
        logging::warn(
            "{}: {} channels; OpenImageIO, and colour-science by it, reads up to {} until "
            "its attribute limits:channels is set higher (rr.colour_science does so)",
            file.string(), channels, most_channels_elsewhere);
}

} // namespace

ReradiationMatrix read_matrix_exr(const std::filesystem::path& file) {
    const SourcePosition position{file.string()};
    const ReradiationMatrix matrix = with_exr_input(
        file, [&](Imf::MultiPartInputFile& input) { return matrix_of(input, position); });
    refuse_undeclared_anti_stokes(matrix, position);
    return matrix;
}

void write_matrix_exr(const std::filesystem::path& file, const ReradiationMatrix& matrix) {
    const std::vector<Channel> channels = channels_to_write(matrix);
    Imf::Header header(1, 1);
    header.compression() = Imf::NO_COMPRESSION;
    set_attributes(header, matrix);
    Imf::FrameBuffer buffer;
    for (const Channel& channel : channels) {
        header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
        // The library only reads through this pointer when it writes a file.
        buffer.insert(channel.name,
                      Imf::Slice(Imf::FLOAT,
                                 reinterpret_cast<char*>(const_cast<float*>(&channel.value)),
                                 sizeof(float), sizeof(float)));
    }
    write_atomically(file, [&](const std::filesystem::path& target) {
        Imf::OutputFile output(target.c_str(), header);
        output.setFrameBuffer(buffer);
        output.writePixels(1);
    });
    warn_of_count(file, channels.size());
}

} // namespace reradiant
