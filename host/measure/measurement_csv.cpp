#include "reradiant/measure.h"

#include "host/base/atomic_file.h"

#include <fmt/format.h>

#include <iterator>

namespace reradiant {

namespace {

const char* quantity_of(const Measurement& measurement) {
    if (measurement.hemispherical)
        return measurement.of_sheet
                   ? "directional-hemispherical reflectance and transmittance, per-band"
                   : "directional-hemispherical reflectance, per-band";
    return measurement.of_sheet ? "bispectral BSDF in 1/sr without the cosine, per-band"
                                : "bispectral BRDF in 1/sr without the cosine, per-band";
}

} // namespace

const char* part_name(MeasuredPart part) {
    switch (part) {
    case MeasuredPart::Diffuse:
        return "diffuse";
    case MeasuredPart::Slab:
        return "slab";
    case MeasuredPart::Specular:
        return "specular";
    case MeasuredPart::Transmitted:
        return "transmitted";
    case MeasuredPart::TransmittedSpecular:
        return "transmitted-specular";
    case MeasuredPart::Guided:
        break;
    }
    return "guided";
}

void write_measurement(const std::filesystem::path& file, const Measurement& measurement) {
    std::string text = fmt::format("# measure, model {}, {}\n", model_name(measurement.model),
                                   quantity_of(measurement));
    for (const std::string& note : measurement.notes)
        text += "# " + note + "\n";
    text += "theta_i_deg,theta_o_deg,phi_deg,lambda_i_nm,lambda_o_nm,value,stderr,part\n";
    auto out = std::back_inserter(text);
    for (const MeasureRow& row : measurement.rows) {
        fmt::format_to(out, "{:.12g},", row.theta_i_deg);
        if (measurement.hemispherical)
            fmt::format_to(out, ",,");
        else
            fmt::format_to(out, "{:.12g},{:.12g},", row.theta_o_deg, row.phi_deg);
        fmt::format_to(out, "{:.12g},{:.12g},{:.12g},{:.12g},{}\n", row.lambda_i_nm,
                       row.lambda_o_nm, row.value, row.standard_error, part_name(row.part));
    }
    write_text_atomically(file, text);
}

} // namespace reradiant
