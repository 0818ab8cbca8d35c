#include "host/study/study/study.h"

#include "host/base/logging.h"
#include "host/base/quiet_log.h"
#include "host/scene/model/sha256.h"
#include "host/study/study/study_store.h"
#include "host/study/study/sweep_apply.h"
#include "reradiant/colour.h"
#include "reradiant/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

namespace reradiant {

namespace {

/// Everything that a cell's results depend on.
std::string identity_of(const Study& study, const std::vector<ChosenValue>& values,
                        const Scene& scene, const std::string& device, std::uint32_t seed) {
    std::ostringstream text;
    text << scene.hash << ' ' << device << ' ' << seed << ' ' << study.material;
    for (const ChosenValue& chosen : values)
        text << ' ' << static_cast<int>(chosen.sweep->kind)
             << fmt::format(" {}", chosen.sweep->path) << toml::toml_formatter(chosen.value->boxed);
    if (const auto& r = study.rendering)
        text << fmt::format(" render {} {} {} {}", r->samples, static_cast<int>(r->method.model),
                            r->method.comb_count, r->method.hero_count);
    if (const auto& m = study.measuring)
        text << fmt::format(" measure {} {} {} {} {} {}", m->samples, m->theta_i_deg,
                            m->theta_o_deg, m->phi_deg, m->illuminants, static_cast<int>(m->model));
    Sha256 digest;
    digest.update(text.str());
    return digest.hex();
}

/// One run over all cells.
class Run {
public:
    Run(const Study& study, const Device* device, const StudyOptions& options,
        const StudyProgress& progress)
        : study_(study), device_(device), options_(options), progress_(progress) {}

    StudyResult result() {
        if (options_.team != nullptr)
            return result_of_team(*options_.team);
        const std::size_t count = study_.cell_count();
        for (std::size_t index = 0; index < count && !result_.interrupted; ++index) {
            CellResult cell = attempted(index);
            if (!result_.interrupted)
                result_.cells.push_back(std::move(cell));
        }
        return std::move(result_);
    }

private:
    CellResult blank_cell(std::size_t index) const {
        CellResult cell;
        cell.index = index;
        cell.folder = options_.folder / "cells" / fmt::format("{:04}", index);
        const std::vector<std::size_t> indices = study_.cell_values(index);
        for (std::size_t k = 0; k < indices.size(); ++k)
            cell.labels.push_back(study_.sweeps[k].values[indices[k]].label);
        return cell;
    }

    /// The cell as far as it came: done, failed or interrupted.
    CellResult attempted(std::size_t index) {
        CellResult cell = blank_cell(index);
        try {
            do_cell(cell);
        } catch (const std::exception& error) {
            if (options_.resume && is_about_checkpoint(error, cell))
                throw;
            cell.error = error.what();
            logging::error("cell {} ({}) failed: {}", index, cell_name(study_, cell), cell.error);
        }
        return cell;
    }

    static bool is_about_checkpoint(const std::exception& error, const CellResult& cell) {
        const auto* const placed = dynamic_cast<const Error*>(&error);
        return placed != nullptr && placed->kind() == Error::Kind::Input &&
               placed->position().file == cell_checkpoint(cell).string();
    }
    static std::filesystem::path cell_checkpoint(const CellResult& cell) {
        return cell.folder / "image.exr.checkpoint";
    }

    /// Cells that members did are told to the leader, who reads them from the folder.
    StudyResult result_of_team(Team& team) {
        const std::size_t count = study_.cell_count();
        std::size_t next = 0;
        bool interrupted = false;
        std::vector<CellResult> mine;
        team.share_tasks(
            [&](const TeamReport& report) -> TeamTask {
                interrupted |= report.interrupted;
                return interrupted || next == count ? TeamTask{} : TeamTask{next++, 1};
            },
            [&](const TeamTask& task) -> TeamReport {
                CellResult cell = attempted(task.first);
                if (!result_.interrupted)
                    mine.push_back(std::move(cell));
                return {task, 0.0, result_.interrupted};
            });
        result_.interrupted = team.from_leader(interrupted) != 0;
        for (const std::string& told : team.gather(cells_text(mine)))
            for (CellResult& cell : cells_from(told))
                result_.cells.push_back(std::move(cell));
        std::sort(result_.cells.begin(), result_.cells.end(),
                  [](const CellResult& a, const CellResult& b) { return a.index < b.index; });
        return std::move(result_);
    }

    std::vector<CellResult> cells_from(const std::string& told) const {
        std::vector<CellResult> cells;
        for (const ToldCell& one : told_cells(told)) {
            CellResult cell = blank_cell(one.index);
            cell.error = one.error;
            if (!cell.failed() && !restore_cell(cell, one.identity))
                cell.error = "its files are not here; all machines must share the folder";
            cell.kept = one.kept && !cell.failed();
            cells.push_back(std::move(cell));
        }
        return cells;
    }

    std::vector<ChosenValue> chosen_values(std::size_t index) const {
        std::vector<ChosenValue> chosen;
        const std::vector<std::size_t> indices = study_.cell_values(index);
        for (std::size_t k = 0; k < indices.size(); ++k)
            chosen.push_back({&study_.sweeps[k], &study_.sweeps[k].values[indices[k]]});
        return chosen;
    }

    void do_cell(CellResult& cell) {
        const std::vector<ChosenValue> values = chosen_values(cell.index);
        const Scene scene = [&] {
            const QuietLog quiet;
            return scene_with(study_, values);
        }();
        const std::string identity =
            identity_of(study_, values, scene, device_ != nullptr ? device_->info().name : "",
                        options_.render.seed);
        cell.identity = identity;
        if (restore_cell(cell, identity)) {
            ++kept_;
            result_.interrupted = !report(cell, 0.0, "kept");
            return;
        }
        if (study_.rendering)
            render_cell(scene, cell);
        if (study_.measuring && !result_.interrupted)
            measure(scene, values, cell);
        if (result_.interrupted)
            return;
        keep_cell(cell, identity);
        std::error_code ignored;
        std::filesystem::remove(cell_checkpoint(cell), ignored);
        ++done_now_;
    }

    void render_cell(const Scene& scene, CellResult& cell) {
        RenderOptions render = options_.render;
        render.samples = study_.rendering->samples;
        render.model = study_.rendering->method.model;
        render.wavelengths.comb_count = study_.rendering->method.comb_count;
        render.wavelengths.hero_count = study_.rendering->method.hero_count;
        render.adaptive = study_.rendering->method.adaptive;
        render.checkpoint = cell_checkpoint(cell);
        render.resume = true;
        render.restart_if_other = !options_.resume;
        std::filesystem::create_directories(cell.folder);
        RenderResult rendered =
            reradiant::render(scene, *device_, render, [&](const RenderProgress& state) {
                const double share = static_cast<double>(state.samples) / render.samples;
                result_.interrupted = !report(cell, share, fmt::format("{} spp", state.samples));
                return !result_.interrupted;
            });
        if (result_.interrupted)
            return;
        rendered.image.attributes["reradiant:cell"] = cell_name(study_, cell);
        rendered.image.attributes["reradiant:sceneHash"] = scene.hash;
        rendered.image.attributes["reradiant:seed"] = std::to_string(render.seed);
        cell.relmse = rendered.relmse;
        keep_image(cell, rendered.image, study_.rendering->exposure_ev.value_or(0.0));
    }

    void measure(const Scene& scene, const std::vector<ChosenValue>& values, CellResult& cell) {
        result_.interrupted = !report(cell, 0.9, "measuring");
        if (result_.interrupted)
            return;
        StudyMeasuring measuring = *study_.measuring;
        for (const ChosenValue& chosen : values)
            if (chosen.sweep->kind == SweepKind::Angle)
                measuring.theta_i_deg = {*chosen.value->node().value<double>()};
        const auto material =
            std::find_if(scene.materials.begin(), scene.materials.end(),
                         [&](const Material& one) { return one.name == study_.material; });
        cell.measurement = measure_cell(*material, measuring, illuminants(scene, values));
    }

    /// The lamp that is swept, or those that the study names.
    std::vector<NamedIlluminant> illuminants(const Scene& scene,
                                             const std::vector<ChosenValue>& values) const {
        for (const ChosenValue& chosen : values)
            if (chosen.sweep->kind == SweepKind::Illuminant) {
                const auto light = static_cast<std::size_t>(std::max(chosen.sweep->index, 0));
                return {{chosen.value->label, light_spectrum(scene.lights[light])}};
            }
        std::vector<NamedIlluminant> named;
        for (const std::string& name : study_.measuring->illuminants)
            named.push_back({name, illuminant_with_luminance(name, 1.0)});
        return named;
    }

    /// Cells that an earlier run did are no part of this one's work.
    bool report(const CellResult& cell, double share, const std::string& note) const {
        const std::size_t count = study_.cell_count();
        const double work = static_cast<double>(std::max<std::size_t>(count - kept_, 1));
        return progress_((static_cast<double>(done_now_) + share) / work,
                         fmt::format("cell {} of {}: {}", cell.index + 1, count, note));
    }

    const Study& study_;
    const Device* device_;
    const StudyOptions& options_;
    const StudyProgress& progress_;
    StudyResult result_;
    std::size_t done_now_ = 0, kept_ = 0;
};

} // namespace

std::vector<std::string> cell_values(const Study& study, const CellResult& cell) {
    std::vector<std::string> parts;
    const std::vector<std::size_t> indices = study.cell_values(cell.index);
    for (std::size_t k = 0; k < study.sweeps.size(); ++k)
        parts.push_back(fmt::format("{} = {}", study.sweeps[k].label,
                                    study.sweeps[k].values[indices[k]].shown));
    return parts;
}

std::string cell_name(const Study& study, const CellResult& cell) {
    return fmt::format("{}", fmt::join(cell_values(study, cell), ", "));
}

StudyResult run_study(const Study& study, const Device* device, const StudyOptions& options,
                      const StudyProgress& progress) {
    return Run(study, device, options, progress).result();
}

} // namespace reradiant
