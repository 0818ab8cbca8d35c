#pragma once

#include "host/layers/sources/scattering_dyes.h"
#include "host/layers/sources/source_transport.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace reradiant {

/// What dyes and the substrate of a stack send out: everything, to all orders.
///
/// At one wavelength the stack takes what its sources send out to what reaches them
/// (SourceTransport). What reaches a source it sends out again, at the same or other wavelengths:
/// J(lo) = sum over li of S(lo, li) x(li), with S the emission of a cell (host/layers/stack/
/// slab_emission.h, times its share of the thickness) or the substrate's matrix. Where light goes
/// to longer wavelengths only, one pass over the bands solves it; else the equations of all bands
/// are solved together, with the pass as preconditioner.
class ReEmission {
public:
    /// `by_band` holds one transport for each band, all with the same sources; `slabs` what each
    /// slab's dyes send out, empty for one without; `substrate` its matrix, (bands, bands), empty
    /// where there is none or where what it sends out is left out. `scattering` holds a transport
    /// for each band in which dyes scatter.
    ReEmission(std::vector<std::shared_ptr<const SourceTransport>> by_band, const StackCells& cells,
               const std::vector<Eigen::MatrixXd>& slabs, const Eigen::MatrixXd& substrate,
               const std::vector<ScatteringTransport>& scattering);

    /// True where nothing is sent out in a band below the one that excites it.
    bool shifts_up() const { return stokes_only_; }
    Eigen::Index bands() const { return static_cast<Eigen::Index>(by_band_.size()); }
    const SourceTransport& at(Eigen::Index band) const {
        return *by_band_[static_cast<std::size_t>(band)];
    }
    /// Returns the power that every source sends out in every band, (sources, bands), for light of
    /// one band that reaches the sources without their doing. Input Error where the series of
    /// re-emissions grows without end, which light (reached >= 0) shows.
    Eigen::MatrixXd sent(Eigen::Index excitation, const Eigen::VectorXd& reached) const;

private:
    /// Sources that send out by the same matrix.
    struct Group {
        Eigen::Index first;
        Eigen::VectorXd shares;
        Eigen::MatrixXd emission;
        std::size_t slab; ///< index; of the substrate beyond all slabs
    };

    Eigen::VectorXd within_band(Eigen::Index band) const;
    Eigen::VectorXd scattered(const std::vector<double>& depths) const;
    Eigen::MatrixXd series_within(Eigen::Index band, const Eigen::VectorXd& within,
                                  const ScatteringTransport& scattering) const;
    Eigen::VectorXd driven(Eigen::Index band, const Eigen::MatrixXd& reached) const;
    Eigen::MatrixXd pass(Eigen::Index excitation, const Eigen::VectorXd& reached,
                         Eigen::MatrixXd sent) const;

    std::vector<std::shared_ptr<const SourceTransport>> by_band_;
    std::vector<Group> groups_;
    std::vector<Eigen::MatrixXd> own_series_; ///< by band: (I - S K)^-1; empty: nothing within it
    bool stokes_only_ = true;
};

} // namespace reradiant
