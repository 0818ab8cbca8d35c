#pragma once

#include "host/study/converge/render_method.h"
#include "reradiant/error.h"
#include "reradiant/scene.h"

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

/// A `SweepKind` says what a sweep changes: a key of the scene, or something that has a name in
/// studies.
enum class SweepKind { Key, Angle, Concentration, Illuminant, Matrix };

struct SweepValue {
    toml::array boxed; ///< one element: the value (toml++ has no node by value)
    std::string label;
    std::string shown; ///< the label with its unit, for pages and messages
    SourcePosition position;

    const toml::node& node() const { return boxed[0]; }
};

/// One parameter and the values that it takes.
struct Sweep {
    std::string label; ///< name on axes and in columns
    std::string unit;  ///< unit of values that are numbers, "deg"; empty: none is known
    SweepKind kind = SweepKind::Key;
    /// Place in the scene's tables, part by part: keys of tables, and for arrays an index or a
    /// `name`. For an illuminant it is that of every light, or of the one that is chosen.
    std::vector<std::string> path;
    int index = -1; ///< of the light (Illuminant) or fluorophore (Concentration); -1: all
    int layer = -1; ///< that holds the fluorophores (Concentration); -1: the substrate
    std::vector<SweepValue> values;
    SourcePosition position;
};

struct StudyRendering {
    std::uint32_t samples = 64;
    RenderMethod method;
    std::optional<double> exposure_ev; ///< for all pictures; empty: chosen by what they show
};

/// A virtual goniophotometer's angles, in degrees, and the light that colours are seen under. Of
/// sheets, thetas above 90 lie beneath: there is what they transmit.
struct StudyMeasuring {
    std::vector<double> theta_i_deg{45.0}, theta_o_deg{0.0}, phi_deg{0.0};
    std::vector<std::string> illuminants{"D65"};
    Model model = Model::Auto;
    long samples = 0; ///< the walk's paths for each theta_i, 0: its default
    bool theta_i_given = false, illuminants_given = false; ///< by the file, not by default
};

/// More combinations than this are refused.
inline constexpr std::size_t most_study_cells = 10000;

struct Study {
    std::filesystem::path file;
    std::string title;
    std::filesystem::path base_file; ///< file of the scene or of the material
    toml::table base;                ///< the scene that cells change
    bool is_sample = false;          ///< the built-in scene around a material
    std::string material;            ///< name of the scene's material that is measured
    std::vector<Sweep> sweeps;       ///< the last runs fastest
    std::optional<StudyRendering> rendering;
    std::optional<StudyMeasuring> measuring;

    std::size_t cell_count() const;
    /// Indices of the values that a cell takes, one a sweep.
    std::vector<std::size_t> cell_values(std::size_t cell) const;
};

/// Reads STUDY.toml and the scene or material that it names. Input Error with line and column for
/// what cannot be: no sweep, an empty one, two of one parameter, a value twice, a key that the
/// scene does not have, angles that are swept and given, too many cells.
Study load_study(const std::filesystem::path& file);

} // namespace reradiant
