#include "host/scene/model/dye_concentration.h"

#include <cmath>
#include <vector>

namespace reradiant {

namespace {

/// Wavelengths that a dye's spectra are written out at when its concentration changes.
constexpr int first_dye_nm = 200, last_dye_nm = 1000;

} // namespace

void set_dye_concentration(Substrate& substrate, int index, double concentration) {
    std::vector<double> nm, ratio;
    for (int wavelength = first_dye_nm; wavelength <= last_dye_nm; ++wavelength)
        nm.push_back(wavelength);
    ratio.assign(nm.size(), 1.0); // light that passes now over light that passed
    for (std::size_t k = 0; k < substrate.fluorophores.size(); ++k) {
        if (index >= 0 && static_cast<std::size_t>(index) != k)
            continue;
        std::vector<double> absorbed = substrate.fluorophores[k].excitation.at(nm);
        for (std::size_t i = 0; i < nm.size(); ++i) {
            const double before = 1.0 - absorbed[i];
            const double after = std::pow(before, concentration);
            absorbed[i] = 1.0 - after;
            ratio[i] *= before > 0.0 ? after / before : 0.0;
        }
        substrate.fluorophores[k].excitation = Spectrum::table(nm, std::move(absorbed));
    }
    std::vector<double> reflectance = substrate.reflectance.at(nm);
    for (std::size_t i = 0; i < nm.size(); ++i)
        reflectance[i] *= ratio[i];
    substrate.reflectance = Spectrum::table(std::move(nm), std::move(reflectance));
}

} // namespace reradiant
