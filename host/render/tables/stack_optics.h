#pragma once

#include "host/render/tables/lane_tables.h"
#include "reradiant/adding.h"
#include "reradiant/scene.h"

#include <memory>
#include <vector>

namespace reradiant {

/// Wavelength at which spectra are read that a render takes at one wavelength only.
inline constexpr double reference_nm = 550.0;

/// A stack (and its substrate where that is a conductor) at one wavelength as the kernels' tables
/// see it, for either closed model.
class StackOptics {
public:
    virtual ~StackOptics() = default;
    virtual double transmission(double cos_theta) const = 0; ///< one way to the substrate
    virtual double delta(double cos_theta) const = 0;        ///< weight of the mirror direction
    virtual double residual(double cos_theta) const = 0;     ///< over sqrt(pi * its average)
    virtual double amplitude(int lobe, double cos_theta) const = 0;
    /// Returns approximately what each rough lobe reflects, the top one first (0 when there is
    /// none), then the deeper ones. This serves only for choosing among them.
    virtual std::vector<double> lobe_shares(double cos_theta) const = 0;
    /// Returns approximately what slabs reflect by lobes of their own; the cosine lobe samples
    /// them.
    virtual double scattered_share(double /*cos_theta*/) const { return 0.0; }
    /// r of the interreflection with an Oren-Nayar substrate of this sigma; 0 for a model without.
    virtual double internal_reflectance(double sigma) const = 0;
    /// Factor of the substrate's operator: 1 / (pi n_k^2), or 1 / pi.
    virtual double diffuse_scale() const = 0;
    /// Shapes of the deeper lobes in the air's half vector; fewer than a scene's may be.
    virtual const std::vector<AddingTransport::Lobe>& deeper_lobes() const = 0;
};

std::unique_ptr<StackOptics> stack_optics(const Material& material, Model model,
                                          double wavelength_nm);

/// The optics of a material at every phase and lane of a plan, or once where nothing about it
/// depends on wavelength.
class MaterialOptics {
public:
    MaterialOptics(const Material& material, Model model, const WavelengthPlan& plan);

    bool is_spectral() const { return spectral_; }
    const StackOptics& at(int phase, int lane) const {
        return *optics_[spectral_ ? static_cast<std::size_t>(phase * lanes_ + lane) : 0];
    }
    const StackOptics& any() const { return *optics_.front(); }

private:
    bool spectral_;
    int lanes_;
    std::vector<std::unique_ptr<StackOptics>> optics_;
};

/// Returns true when something that the tables by the angle hold depends on wavelength.
bool depends_on_wavelength(const Material& material);

/// Number of deeper rough lobes that a material can have under a model.
int deeper_lobe_count(const Material& material, Model model);

} // namespace reradiant
