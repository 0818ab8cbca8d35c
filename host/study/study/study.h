#pragma once

#include "host/base/team.h"
#include "host/study/converge/converge.h"
#include "host/study/study/cell_measurement.h"
#include "host/study/study/study_file.h"
#include "reradiant/device.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace reradiant {

struct StudyOptions {
    std::filesystem::path folder; ///< for results, and for what an interrupted run goes on from
    RenderOptions render; ///< seed, threads, memory and seconds between checkpoints are used
    bool resume = false;  ///< refuse the checkpoint of a cell that is of another render; else the
                          ///< cell begins anew
    Team* team = nullptr; ///< cells are handed out to its members, who share the folder
};

/// One combination of the swept values. What was rendered lies in its folder as image.exr and
/// image.png.
struct CellResult {
    std::size_t index = 0;
    std::vector<std::string> labels; ///< of the chosen values, one for each sweep
    std::filesystem::path folder;
    std::string error; ///< empty: the cell was done
    bool kept = false; ///< from an earlier run
    bool has_image = false;
    double relmse = 0.0; ///< estimated, of the image
    std::optional<CellMeasurement> measurement;
    std::string identity; ///< digest of what its results depend on

    bool failed() const { return !error.empty(); }
};

struct StudyResult {
    std::vector<CellResult> cells;
    bool interrupted = false; ///< cells that were done are kept, and here
    double exposure_ev = 0.0; ///< of the pictures on sheet and page, see sheet_exposure_ev
};

/// Renders and measures every cell of a study into cells/NNNN beneath the folder. A cell that fails
/// is reported and the rest goes on; cells of an earlier run with the same scene, settings and seed
/// are not done again, and one that was interrupted goes on from its render's checkpoint. With a
/// team every member calls this, and the leader has all cells. `device` may be null when nothing is
/// rendered.
StudyResult run_study(const Study& study, const Device* device, const StudyOptions& options,
                      const StudyProgress& progress);

/// What a cell has of each sweep: "thickness = 0.5 units", "roughness = 10 deg".
std::vector<std::string> cell_values(const Study& study, const CellResult& cell);
/// "thickness = 0.5 units, roughness = 10 deg"
std::string cell_name(const Study& study, const CellResult& cell);

} // namespace reradiant
