#include "host/scene/toml/spectrum_reader.h"

#include "host/scene/model/textured_value.h"
#include "host/spectral/spectrum/spectrum_operations.h"
#include "host/spectral/text/wavelength_unit.h"
#include "reradiant/colour.h"
#include "reradiant/spectral_files.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace reradiant {

namespace {

const std::vector<std::string> FORMS{
    "nm",      "file",        "rgb",     "illuminant", "blackbody_kelvin",
    "line_nm", "gaussian_nm", "product", "sum"};
const NumberRange ANY_VALUE = NumberRange::within(-1e18, 1e18);
const NumberRange SCALE = NumberRange::within(0.0, 1e18);
const NumberRange WAVELENGTH = NumberRange::within(1.0, 1e5);
constexpr double MAX_RGB = 1e9;
constexpr double CHECKED_FROM_NM = 200.0, CHECKED_TO_NM = 1000.0;
/// Lamps are given with lines in the near infrared, such as mercury's at 1014 nm.
constexpr double LONGEST_PEAK_NM = 2500.0;
constexpr std::size_t MAX_TERMS = 1000;

std::vector<std::string> keys_of_form(const std::string& form) {
    std::vector<std::string> keys{form, "scale", "min", "max"};
    if (form == "nm")
        keys.insert(keys.begin() + 1, "value");
    if (form == "line_nm")
        keys.insert(keys.begin() + 1, "width_nm");
    if (form == "gaussian_nm")
        keys.insert(keys.begin() + 1, "sigma_nm");
    return keys;
}

/// Returns the form that a table is in: the one key of FORMS that it holds.
std::string form_of(const toml::table& table, const std::string& file, const std::string& name) {
    const SourcePosition at = position_of(file, table);
    std::vector<std::string> found;
    for (const auto& form : FORMS)
        if (table.contains(form))
            found.push_back(form);
    if (found.size() > 1)
        throw_input_error(at,
                          fmt::format("{} has both \"{}\" and \"{}\"", name, found[0], found[1]),
                          "add spectra by a list: [ {...}, {...} ]");
    if (found.size() == 1)
        return found[0];
    std::vector<std::string> known = FORMS;
    known.insert(known.end(), {"value", "scale", "width_nm", "sigma_nm", "min", "max"});
    for (const auto& [key, node] : table)
        if (std::find(known.begin(), known.end(), key.str()) == known.end())
            throw_input_error(position_of(file, key.source()),
                              fmt::format("unknown key \"{}\" in {}", key.str(), name),
                              suggestion(std::string(key.str()), FORMS));
    throw_input_error(at, fmt::format("{} does not say what spectrum it is", name),
                      "give one of nm and value, file, rgb, illuminant, blackbody_kelvin, line_nm, "
                      "gaussian_nm, product, sum");
}

Spectrum read_table(const TableReader& reader) {
    reader.describe("nm", fmt::format("array of numbers, ascending, {}", WAVELENGTH.text()));
    reader.describe("value", "array of numbers, as many");
    const auto nm = numbers_at(reader.required("nm"), reader.file(), reader.position_of_key("nm"),
                               "nm", 0, WAVELENGTH);
    const auto value = numbers_at(reader.required("value"), reader.file(),
                                  reader.position_of_key("value"), "value", 0, ANY_VALUE);
    if (nm.empty())
        reader.fail("nm", "nm is empty", "give at least one wavelength");
    if (nm.size() != value.size())
        reader.fail("value", fmt::format("value has {} numbers and nm {}", value.size(), nm.size()),
                    "give one value for each wavelength");
    const toml::array& nodes = *reader.required("nm").as_array();
    for (std::size_t i = 1; i < nm.size(); ++i)
        if (!(nm[i] > nm[i - 1]))
            throw_input_error(position_of(reader.file(), nodes[i], reader.position_of_key("nm")),
                              fmt::format("nm[{}] = {} does not follow {}", i, nm[i], nm[i - 1]),
                              "wavelengths must ascend, each once");
    require_plausible_range(nm.front(), nm.back(), UnitSource::Fixed, reader.position_of_key("nm"));
    return Spectrum::table(nm, value);
}

Spectrum read_illuminant(const TableReader& reader) {
    const std::string name = reader.text("illuminant");
    const double scale = reader.number_or("scale", 1.0, SCALE);
    try {
        return illuminant_with_luminance(name, scale);
    } catch (const std::invalid_argument& error) {
        reader.fail("illuminant", error.what());
    }
}

Spectrum read_blackbody(const TableReader& reader) {
    const double kelvin = reader.number("blackbody_kelvin", NumberRange::within(500.0, 1e6));
    const Spectrum shape = Spectrum::blackbody(kelvin, 1.0);
    return shape.scaled(reader.number_or("scale", 1.0, SCALE) / xyz_of(shape)[1]);
}

/// Absorptions exceed 1: such an rgb is a multiple of the reflectance that has its hue. Where a
/// fraction is asked for the limits of the key refuse it.
Spectrum read_rgb(const TableReader& reader) {
    reader.describe("rgb", "array of 3 numbers, at least 0");
    const auto rgb =
        numbers_at(reader.required("rgb"), reader.file(), reader.position_of_key("rgb"), "rgb", 3,
                   NumberRange::within(0.0, MAX_RGB));
    const double scale = std::max(1.0, *std::max_element(rgb.begin(), rgb.end()));
    return reflectance_from_rgb({rgb[0] / scale, rgb[1] / scale, rgb[2] / scale}).scaled(scale);
}

/// Reads light around one wavelength, which is refused if it is in another unit.
Spectrum read_peak(const TableReader& reader, const std::string& form) {
    const NumberRange width = NumberRange::within(1e-3, 1e4);
    const double nm = reader.number(form, WAVELENGTH);
    const double scale = reader.number_or("scale", 1.0, SCALE);
    const auto require_seen = [&](double reach_nm) {
        if (nm <= LONGEST_PEAK_NM && nm >= CHECKED_FROM_NM)
            return;
        require_plausible_range(nm - reach_nm, nm + reach_nm, UnitSource::Fixed,
                                reader.position_of_key(form));
    };
    if (form == "line_nm") {
        const double width_nm = reader.number_or("width_nm", 1.0, width);
        require_seen(0.5 * width_nm);
        return Spectrum::line(nm, width_nm, scale);
    }
    // At five sigma from its peak a Gaussian has fallen to 4e-6 of it.
    const double sigma_nm = reader.number("sigma_nm", width);
    require_seen(5.0 * sigma_nm);
    return Spectrum::gaussian(nm, sigma_nm, scale);
}

/// Multiplies a spectrum that has values of its own by `scale`. This holds for the file of a lamp
/// too: whether its values are radiances or shares of the largest, no luminance replaces them.
Spectrum multiplied(const TableReader& reader, Spectrum spectrum) {
    const double scale = reader.number_or("scale", 1.0, SCALE);
    return scale == 1.0 ? std::move(spectrum) : spectrum.scaled(scale);
}

Spectrum read_file(const TableReader& reader, LoadState& state) {
    return read_spectrum(
        state.resolve_and_digest(reader.text("file"), reader.position_of_key("file")));
}

Spectrum read_node(const toml::node& node, const std::string& file, const SourcePosition& at,
                   const std::string& name, LoadState& state);

/// The list that a sum or a product is made of.
const toml::array& terms_of(const TableReader& reader, const std::string& form) {
    reader.describe(form, "array of SPECTRUM");
    const toml::node& node = reader.required(form);
    const toml::array* terms = node.as_array();
    if (terms == nullptr || terms->empty() || terms->size() > MAX_TERMS)
        reader.fail(form,
                    terms == nullptr ? fmt::format("{} is {}", form, toml_type_name(node))
                                     : fmt::format("a {} of {} spectra", form, terms->size()),
                    fmt::format("give a list of 1 to {} spectra", MAX_TERMS));
    return *terms;
}

Spectrum read_term(const TableReader& reader, const std::string& form, std::size_t index,
                   LoadState& state) {
    const toml::node& term = terms_of(reader, form)[index];
    return read_node(term, reader.file(),
                     position_of(reader.file(), term, reader.position_of_key(form)),
                     fmt::format("{}[{}]", form, index), state);
}

/// A lamp, and the filters before it: what is above 1 in one of these would add light.
Spectrum read_product(const TableReader& reader, LoadState& state) {
    const std::size_t count = terms_of(reader, "product").size();
    Spectrum all = read_term(reader, "product", 0, state);
    for (std::size_t i = 1; i < count; ++i) {
        const Spectrum filter = read_term(reader, "product", i, state);
        if (const double most = filter.maximum(CHECKED_FROM_NM, CHECKED_TO_NM); most > 1.0 + 1e-9)
            state.warn(reader.position_of_key("product"),
                       fmt::format("product[{}] goes up to {:.6g}: as a filter it adds light; "
                                   "divide percent by 100, or put the lamp first",
                                   i, most));
        all = product(all, filter);
    }
    return all;
}

Spectrum read_sum(const TableReader& reader, LoadState& state) {
    Spectrum all;
    for (std::size_t i = 0; i < terms_of(reader, "sum").size(); ++i)
        all += read_term(reader, "sum", i, state);
    return all;
}

/// Cuts the values of a spectrum, which is scaled already, by the keys `min` and `max`.
Spectrum read_cut(const TableReader& reader, Spectrum spectrum) {
    const double low = reader.number_or("min", ANY_VALUE.low, ANY_VALUE);
    const double high = reader.number_or("max", ANY_VALUE.high, ANY_VALUE);
    if (!reader.has("min") && !reader.has("max"))
        return spectrum;
    if (!(low <= high))
        reader.fail("max", fmt::format("max is {} and min {}", high, low),
                    "give a max of at least min");
    return cut_values(spectrum, low, high);
}

Spectrum read_form(const TableReader& reader, const std::string& form, LoadState& state) {
    if (form == "nm")
        return multiplied(reader, read_table(reader));
    if (form == "file")
        return multiplied(reader, read_file(reader, state));
    if (form == "rgb")
        return multiplied(reader, read_rgb(reader));
    if (form == "illuminant")
        return read_illuminant(reader);
    if (form == "blackbody_kelvin")
        return read_blackbody(reader);
    if (form == "product")
        return multiplied(reader, read_product(reader, state));
    if (form == "sum")
        return multiplied(reader, read_sum(reader, state));
    return read_peak(reader, form);
}

/// Reads a textured spectrum: low + t (high - low) at the level that the texture stands at.
Spectrum read_textured(const toml::node& node, const std::string& file, const std::string& name,
                       LoadState& state) {
    const TextureReference reference = read_texture_reference(node, file, name, state);
    const auto end = [&](const TextureReference::End& at, const char* key, double otherwise) {
        if (at.node == nullptr)
            return Spectrum::constant(otherwise);
        return read_node(*at.node, at.file, position_of(at.file, *at.node), key, state);
    };
    state.texture_scope->inside_reference = true;
    const Spectrum low = end(reference.low, "low", 0.0), high = end(reference.high, "high", 1.0);
    state.texture_scope->inside_reference = false;
    if (reference.t == 0.0 || reference.t == 1.0)
        return reference.t == 0.0 ? low : high;
    return low.scaled(1.0 - reference.t) += high.scaled(reference.t);
}

Spectrum read_node(const toml::node& node, const std::string& file, const SourcePosition& at,
                   const std::string& name, LoadState& state) {
    if (node.is_number())
        return Spectrum::constant(number_at(node, at, name, ANY_VALUE));
    if (is_texture_reference(node))
        return read_textured(node, file, name, state);
    if (const toml::table* table = node.as_table()) {
        const std::string form = form_of(*table, file, name);
        const TableReader reader(*table, file, fmt::format("the spectrum {}", name),
                                 keys_of_form(form), fmt::format("SPECTRUM by {}", form));
        Spectrum spectrum = read_cut(reader, read_form(reader, form, state));
        if (form != "product" && form != "sum") // their parts are tracked
            state.track(spectrum, at, name);
        return spectrum;
    }
    const toml::array* terms = node.as_array();
    if (terms == nullptr)
        throw_input_error(at, fmt::format("{} is {}", name, toml_type_name(node)),
                          "give a number, a table such as { illuminant = \"D65\" } or a list");
    if (terms->empty() || terms->size() > MAX_TERMS)
        throw_input_error(at, fmt::format("{} is a sum of {} spectra", name, terms->size()),
                          fmt::format("give 1 to {}", MAX_TERMS));
    Spectrum sum;
    for (std::size_t i = 0; i < terms->size(); ++i)
        sum += read_node((*terms)[i], file, position_of(file, (*terms)[i], at),
                         fmt::format("{}[{}]", name, i), state);
    return sum;
}

void check_limits(const Spectrum& spectrum, const SourcePosition& at, const std::string& name,
                  const SpectrumLimits& limits) {
    const double low = spectrum.minimum(CHECKED_FROM_NM, CHECKED_TO_NM);
    double high = spectrum.maximum(CHECKED_FROM_NM, CHECKED_TO_NM);
    // A box narrower than the comb of maximum() can lie between its teeth.
    for (const SpectralLine& line : spectrum.lines())
        high = std::max(high, spectrum(line.centre_nm));
    const double rounding = 1e-9 * std::max(1.0, limits.high < 1e17 ? limits.high : 1.0);
    if (limits.low_is_allowed ? low < limits.low : low <= limits.low)
        throw_input_error(at, fmt::format("{} goes down to {}", name, low),
                          fmt::format("it must be {} {}",
                                      limits.low_is_allowed ? "at least" : "above", limits.low));
    if (!(high <= limits.high + rounding))
        throw_input_error(at, fmt::format("{} goes up to {}", name, high),
                          fmt::format("it must be at most {}{}", limits.high,
                                      limits.high == 1.0 && high > 1.5
                                          ? "; divide percent by 100, or head its column of a file "
                                            "with %"
                                          : ""));
}

} // namespace

Spectrum read_spectrum_key(const TableReader& table, const std::string& key,
                           const SpectrumLimits& limits, LoadState& state) {
    table.describe(key, fmt::format("SPECTRUM, {} {}{}",
                                    limits.low_is_allowed ? "at least" : "above", limits.low,
                                    limits.high < SpectrumLimits::MAX_SPECTRAL_VALUE
                                        ? fmt::format(" and at most {}", limits.high)
                                        : std::string()));
    return read_spectrum_node(table.required(key), table.file(), table.position_of_key(key), key,
                              limits, state);
}

Spectrum read_spectrum_node(const toml::node& node, const std::string& file,
                            const SourcePosition& at, const std::string& name,
                            const SpectrumLimits& limits, LoadState& state) {
    const Spectrum spectrum = read_node(node, file, at, name, state);
    check_limits(spectrum, at, name, limits);
    return spectrum;
}

} // namespace reradiant
