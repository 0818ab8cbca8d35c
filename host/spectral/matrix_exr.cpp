#include "host/atomic_file.h"
#include "host/exr_limits.h"
#include "host/spectral/matrix_formats.h"
#include "host/spectral/matrix_io.h"
#include "host/spectral/text_reader.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

// Bispectral image of one pixel in the layout of Fichet, Pacanowski and Wilkie, "An OpenEXR
// Layout for Spectral Images", JCGT 10(3), 2021: channels T.<excitation>nm.<emission>nm, the
// diagonal T.<wavelength>nm, a comma for the decimal point. Channels are FLOAT: the file keeps
// about 7 digits, a CSV keeps all.

namespace reradiant {

namespace {

constexpr double name_rounding_nm = 1e-6;

struct Channel {
    std::string name;
    double excitation_nm = 0.0, emission_nm = 0.0;
    float value = 0.0f;
};

std::string wavelength_text(double nm) {
    std::string text = fmt::format("{:.6f}nm", nm); // fmt knows no locale
    std::replace(text.begin(), text.end(), '.', ',');
    return text;
}

std::string channel_name(double excitation_nm, double emission_nm, bool diagonal) {
    return diagonal ? "T." + wavelength_text(emission_nm)
                    : "T." + wavelength_text(excitation_nm) + "." + wavelength_text(emission_nm);
}

/// Takes "380,000000nm" from the front of the text; nothing when it is something else.
std::optional<double> take_wavelength(std::string_view& text) {
    const auto unit = text.find("nm");
    if (unit == std::string_view::npos || unit > 24)
        return std::nullopt;
    std::string number(text.substr(0, unit));
    std::replace(number.begin(), number.end(), ',', '.');
    double nm = 0.0;
    const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), nm);
    if (error != std::errc() || stop != number.data() + number.size() || !(nm > 0.0 && nm <= 1e6))
        return std::nullopt;
    text.remove_prefix(unit + 2);
    return nm;
}

std::optional<Channel> parse_channel(const std::string& name) {
    std::string_view rest = name;
    if (!rest.starts_with("T."))
        return std::nullopt;
    rest.remove_prefix(2);
    const auto first = take_wavelength(rest);
    if (first && rest.empty())
        return Channel{name, *first, *first, 0.0f};
    if (!first || !rest.starts_with('.'))
        return std::nullopt;
    rest.remove_prefix(1);
    const auto second = take_wavelength(rest);
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

/// Grid of one axis: from the exact attributes when they agree with the names, else from the names.
WavelengthGrid grid_of(const Imf::Header& header, const std::string& axis_name,
                       const std::map<double, int>& wavelengths_nm,
                       const SourcePosition& position) {
    std::vector<PlacedWavelength> axis;
    for (const auto& [nm, ignored] : wavelengths_nm)
        axis.push_back({nm, position});
    const std::string prefix = "reradiant:" + axis_name;
    const double step_nm = number_attribute(header, (prefix + "StepNm").c_str(), 0.0);
    const double from_nm = number_attribute(header, (prefix + "FromNm").c_str(), 0.0);
    if (axis.size() == 1 && !(step_nm > 0.0))
        throw_input_error(position,
                          fmt::format("the step of the only {} band is not given", axis_name),
                          fmt::format("add the attribute {}StepNm (double)", prefix));
    const WavelengthGrid named = axis_grid(axis, axis_name.c_str(), step_nm);
    const WavelengthGrid exact{from_nm, step_nm, named.count};
    const bool agree = step_nm > 0.0 && from_nm > 0.0 &&
                       std::abs(exact.from_nm - named.from_nm) <= name_rounding_nm &&
                       std::abs(exact.to_nm() - named.to_nm()) <= name_rounding_nm;
    return agree ? exact : named;
}

void read_values(Imf::InputFile& file, std::vector<Channel>& channels,
                 const SourcePosition& position) {
    const Imath::Box2i window = file.header().dataWindow();
    if (window.min != window.max)
        throw_input_error(position, "the image is not of one pixel",
                          "a re-radiation matrix is an image of 1 x 1");
    Imf::FrameBuffer buffer;
    for (Channel& channel : channels) {
        // OpenEXR addresses pixels from the origin of coordinates, not of the window.
        buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, &channel.value, window,
                                                     sizeof(float), sizeof(float)));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y);
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

ReradiationMatrix matrix_of(Imf::InputFile& file, const SourcePosition& position) {
    const Imf::Header& header = file.header();
    std::vector<Channel> channels = channels_of(header, position);
    std::map<double, int> emission_nm, excitation_nm;
    for (const Channel& channel : channels) {
        emission_nm.emplace(channel.emission_nm, 0);
        excitation_nm.emplace(channel.excitation_nm, 0);
    }
    require_matrix_size(position, emission_nm.size(), excitation_nm.size());
    const MatrixQuantity quantity = quantity_of(header, position);
    ReradiationMatrix matrix;
    matrix.emission = grid_of(header, "emission", emission_nm, position);
    matrix.excitation = grid_of(header, "excitation", excitation_nm, position);
    matrix.kind = text_attribute(header, "reradiant:kind") == "measured" ? MatrixKind::Measured
                                                                         : MatrixKind::Model;
    matrix.anti_stokes_allowed = text_attribute(header, "reradiant:antiStokes") == "allowed";
    matrix.geometry = text_attribute(header, "reradiant:geometry");
    read_values(file, channels, position);
    // Channels that the file leaves out are zero, as the layout says.
    matrix.values.setZero(matrix.emission.count, matrix.excitation.count);
    for (const Channel& channel : channels)
        matrix.values(matrix.emission.band_of(channel.emission_nm),
                      matrix.excitation.band_of(channel.excitation_nm)) = channel.value;
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
    number("reradiant:emissionFromNm", matrix.emission.from_nm);
    number("reradiant:emissionStepNm", matrix.emission.step_nm);
    number("reradiant:excitationFromNm", matrix.excitation.from_nm);
    number("reradiant:excitationStepNm", matrix.excitation.step_nm);
}

std::vector<Channel> channels_to_write(const ReradiationMatrix& matrix) {
    std::vector<Channel> channels;
    for (int i = 0; i < matrix.excitation.count; ++i) {
        const int diagonal = diagonal_row(matrix, i);
        for (int o = 0; o < matrix.emission.count; ++o) {
            const double li = matrix.excitation.centre_nm(i), lo = matrix.emission.centre_nm(o);
            channels.push_back({channel_name(li, lo, o == diagonal), li, lo,
                                static_cast<float>(matrix.values(o, i))});
        }
    }
    return channels;
}

} // namespace

ReradiationMatrix read_matrix_exr(const std::filesystem::path& file) {
    const SourcePosition position{file.string()};
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code))
        throw_input_error(position, "cannot be read", "name an existing file");
    refuse_hostile_exr(file);
    try {
        Imf::InputFile input(file.c_str());
        const ReradiationMatrix matrix = matrix_of(input, position);
        refuse_undeclared_anti_stokes(matrix, position);
        return matrix;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw_input_error(position, fmt::format("this is no whole EXR image: {}", error.what()),
                          "write it again");
    }
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
}

} // namespace reradiant
