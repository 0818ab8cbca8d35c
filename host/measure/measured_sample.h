#pragma once

#include "host/measure/geometry_matrix.h"
#include "reradiant/measure.h"
#include "reradiant/reradiation.h"
#include "reradiant/wavelength_grid.h"

#include <compare>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace reradiant {

/// The directions of rows of `measure`, in degrees. Hemispherical rows have an incidence only.
struct MeasuredDirections {
    bool hemispherical = false;
    double theta_i_deg = 0.0, theta_o_deg = 0.0, phi_deg = 0.0;

    auto operator<=>(const MeasuredDirections&) const = default;
    /// As `--geometry` would ask for them: "45:20:180", or "8/d" for any hemispherical incidence.
    std::string text() const;
};

/// A `MeasuredSample` is a CSV of `measure` as a sample whose colour is asked for: what it reflects
/// in each of the directions that were measured, nothing interpolated between them.
class MeasuredSample {
public:
    /// Reads the file. Input Error with the place for what is malformed or given twice.
    explicit MeasuredSample(const std::filesystem::path& file);

    /// The radiance factors in a geometry, on the file's own bands: all parts that are reflected,
    /// the mirror only in what is hemispherical. 45/0 and 0/45 are the mean over the azimuths that
    /// were measured. d/8 follows from 8/d where nothing fluoresces. Input Error, which lists what
    /// was measured, for directions that were not, and for specular light that is to be excluded,
    /// of which the file does not say how much goes into the port; with its place for an entry that
    /// is missing, except below the excitation and where nothing fluoresces.
    ReradiationMatrix seen_in(const ViewingGeometry& geometry) const;

private:
    struct Row {
        double excitation_nm, emission_nm;
        int excitation, emission; ///< bands
        bool is_diagonal;         ///< both are one wavelength
        double value;             ///< as in the file; NaN: not measured
        MeasuredPart part;
        int line;
    };
    class Reader;

    static bool is_reflected(const Row& row) { return reradiant::is_reflected(row.part); }
    std::vector<MeasuredDirections> answering(const ViewingGeometry& geometry) const;
    [[noreturn]] void refuse(const ViewingGeometry& geometry) const;
    void require_every_entry(const MeasuredDirections& at) const;
    void require_no_fluorescence(const MeasuredDirections& at) const;
    void require_no_specular_light(const MeasuredDirections& at) const;
    void add_to(ReradiationMatrix& matrix, const MeasuredDirections& at, double factor) const;

    std::string file_;
    WavelengthGrid emission_, excitation_;
    bool is_measured_ = false, anti_stokes_allowed_ = false;
    std::map<MeasuredDirections, std::vector<Row>> rows_;
};

} // namespace reradiant
