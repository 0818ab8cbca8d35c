#include "host/measure/measured_sample.h"

#include "host/measure/measured_sample_reader.h"
#include "reradiant/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

namespace reradiant {

namespace {

using Kind = ViewingGeometry::Kind;

constexpr std::size_t most_listed = 24;

bool same_angle(double a, double b) {
    return std::abs(a - b) < 1e-6;
}

bool same_azimuth(double a, double b) {
    return same_angle(std::remainder(a - b, 360.0), 0.0);
}

/// At the normal every azimuth is one direction.
bool is_answered_by(const ViewingGeometry& asked, const MeasuredDirections& held) {
    const bool is_directional = asked.kind == Kind::Directional;
    if (is_directional == held.hemispherical || !same_angle(asked.theta_i_deg, held.theta_i_deg))
        return false;
    const bool any_azimuth = asked.theta_i_deg == 0.0 || asked.theta_o_deg == 0.0;
    return !is_directional || (same_angle(asked.theta_o_deg, held.theta_o_deg) &&
                               (any_azimuth || same_azimuth(asked.phi_deg, held.phi_deg)));
}

} // namespace

std::string MeasuredDirections::text() const {
    if (hemispherical)
        return fmt::format("{:.10g}/d", theta_i_deg);
    return fmt::format("{:.10g}:{:.10g}:{:.10g}", theta_i_deg, theta_o_deg, phi_deg);
}

MeasuredSample::MeasuredSample(const std::filesystem::path& file) {
    Reader(*this, file).read();
}

std::vector<MeasuredDirections> MeasuredSample::answering(const ViewingGeometry& geometry) const {
    std::vector<MeasuredDirections> found;
    for (const auto& [at, rows] : rows_)
        if (is_answered_by(geometry, at))
            found.push_back(at);
    if (found.empty())
        refuse(geometry);
    return found;
}

void MeasuredSample::refuse(const ViewingGeometry& geometry) const {
    std::vector<std::string> held;
    for (const auto& [at, rows] : rows_)
        held.push_back(at.text());
    std::string list = fmt::format(
        "{}",
        fmt::join(held.begin(),
                  held.begin() + static_cast<std::ptrdiff_t>(std::min(most_listed, held.size())),
                  ", "));
    if (held.size() > most_listed)
        list += fmt::format(" and {} more", held.size() - most_listed);
    const bool is_directional = geometry.kind == Kind::Directional;
    const bool has_that_kind = rows_.begin()->first.hemispherical != is_directional ||
                               rows_.rbegin()->first.hemispherical != is_directional;
    const std::string options =
        is_directional ? fmt::format("--theta-i {:g} --theta-o {:g} --phi {:g}",
                                     geometry.theta_i_deg, geometry.theta_o_deg, geometry.phi_deg)
                       : fmt::format("--hemispherical --theta-i {:g}", geometry.theta_i_deg);
    throw_input_error({file_},
                      fmt::format("the file does not hold the geometry {}, and nothing is "
                                  "interpolated; it holds {}",
                                  geometry.name, list),
                      fmt::format("{}`measure` the material with {}",
                                  is_directional && has_that_kind
                                      ? "ask for one of these with --geometry, or "
                                      : "",
                                  options));
}

void MeasuredSample::require_no_fluorescence(const MeasuredDirections& at) const {
    for (const Row& row : rows_.at(at))
        if (is_reflected(row) && row.value != 0.0 && !row.is_diagonal)
            throw_input_error({file_},
                              "the file tells where light from one direction goes, and the sample "
                              "fluoresces: light that comes from everywhere is another matrix",
                              "give the material itself (.toml), or ask for 8/d");
}

void MeasuredSample::require_no_specular_light(const MeasuredDirections& at) const {
    for (const Row& row : rows_.at(at))
        if (row.part == MeasuredPart::Specular && row.value != 0.0)
            throw_input_error(
                {file_, row.line, 1},
                "the file does not tell how much of the specular light goes into an "
                "instrument's port",
                "give the material itself (.toml), or ask for specular included, 8/d");
}

/// Entries below the excitation may be missing, and where nothing fluoresces all but the diagonal.
void MeasuredSample::require_every_entry(const MeasuredDirections& at) const {
    Eigen::MatrixXi seen = Eigen::MatrixXi::Zero(emission_.count, excitation_.count);
    bool is_fluorescent = false;
    for (const Row& row : rows_.at(at))
        if (is_reflected(row)) {
            seen(row.emission, row.excitation) = 1;
            is_fluorescent = is_fluorescent || !row.is_diagonal;
        }
    for (int i = 0; i < excitation_.count; ++i)
        for (int o = 0; o < emission_.count; ++o) {
            const double shift = emission_.centre_nm(o) - excitation_.centre_nm(i);
            const bool is_possible = is_fluorescent ? shift > -1e-6 : std::abs(shift) < 1e-6;
            if (seen(o, i) == 0 && is_possible)
                throw_input_error({file_},
                                  fmt::format("excitation {:g} nm, emission {:g} nm is missing at "
                                              "{}; a colour needs every entry",
                                              excitation_.centre_nm(i), emission_.centre_nm(o),
                                              at.text()),
                                  "`fit` fills what was not measured");
        }
}

void MeasuredSample::add_to(ReradiationMatrix& matrix, const MeasuredDirections& at,
                            double factor) const {
    std::set<std::tuple<MeasuredPart, int, int>> seen;
    for (const Row& row : rows_.at(at)) {
        const SourcePosition place{file_, row.line, 1};
        if (!seen.emplace(row.part, row.emission, row.excitation).second)
            throw_input_error(place,
                              fmt::format("excitation {:g} nm, emission {:g} nm is given twice",
                                          row.excitation_nm, row.emission_nm),
                              "keep one of the two lines");
        if (is_reflected(row) && std::isnan(row.value))
            throw_input_error(place, "the value was not measured; a colour needs every entry",
                              "`fit` fills what was not measured");
        if (is_reflected(row))
            matrix.values(row.emission, row.excitation) += factor * row.value;
    }
}

ReradiationMatrix MeasuredSample::seen_in(const ViewingGeometry& geometry) const {
    const std::vector<MeasuredDirections> directions = answering(geometry);
    ReradiationMatrix matrix;
    matrix.emission = emission_;
    matrix.excitation = excitation_;
    matrix.values.setZero(emission_.count, excitation_.count);
    matrix.kind = is_measured_ ? MatrixKind::Measured : MatrixKind::Model;
    matrix.anti_stokes_allowed = anti_stokes_allowed_;
    matrix.geometry = geometry.name;
    for (const MeasuredDirections& at : directions) {
        if (geometry.kind == Kind::HemisphericalDirectional)
            require_no_fluorescence(at);
        if (geometry.kind != Kind::Directional && !geometry.specular_included)
            require_no_specular_light(at);
        require_every_entry(at);
        // A perfect diffuser has 1/pi in every direction.
        const double unit = at.hemispherical ? 1.0 : std::numbers::pi;
        add_to(matrix, at, unit / static_cast<double>(directions.size()));
    }
    return matrix;
}

} // namespace reradiant
