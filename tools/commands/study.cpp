#include "host/study/study/study.h"
#include "host/base/atomic_file.h"
#include "host/film/display/display_picture.h"
#include "host/render/wavefront/render_hooks.h"
#include "host/report/json_file.h"
#include "host/report/progress.h"
#include "host/study/page/contact_sheet.h"
#include "host/study/page/sheet_exposure.h"
#include "host/study/page/study_page.h"
#include "host/study/study/study_store.h"
#include "tools/program/command.h"
#include "tools/program/interrupt.h"
#include "tools/program/join_team.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace reradiant {

namespace {

constexpr int exit_cells_failed = 1;

struct StudyCommand {
    std::filesystem::path study;
    StudyOptions options;
};

std::size_t failed_cells(const StudyResult& result) {
    return static_cast<std::size_t>(
        std::count_if(result.cells.begin(), result.cells.end(),
                      [](const CellResult& cell) { return cell.failed(); }));
}

nlohmann::ordered_json result_json(const Study& study, const StudyResult& result) {
    nlohmann::ordered_json json = {{"title", study.title},
                                   {"cells", study.cell_count()},
                                   {"failed", failed_cells(result)},
                                   {"interrupted", result.interrupted},
                                   {"exposure_ev", result.exposure_ev},
                                   {"results", nlohmann::ordered_json::array()}};
    for (const CellResult& cell : result.cells) {
        nlohmann::ordered_json entry = {{"cell", cell.index}, {"name", cell_name(study, cell)}};
        entry["kept"] = cell.kept;
        if (cell.failed())
            entry["error"] = cell.error;
        else if (cell.has_image)
            entry["relmse"] = cell.relmse;
        json["results"].push_back(std::move(entry));
    }
    return json;
}

void write_results(const Study& study, StudyResult& result, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    result.exposure_ev = sheet_exposure_ev(study, result);
    write_study_table(folder / "table.csv", study, result);
    write_contact_sheet(folder / "contact-sheet.png", study, result);
    write_text_atomically(folder / "index.html", study_page(study, result));
}

int run(StudyCommand command, const CommandContext& context) {
    CommonOptions common = context.common;
    const std::unique_ptr<Team> team = join_team(common);
    StudyOptions& options = command.options;
    options.folder = output_directory(options.folder);
    check_outputs(common, {}, {command.study}, options.folder);
    options.render.seed = common.seed;
    options.render.threads = common.threads;
    options.render.processes_on_machine = members_on_host(team);
    options.team = team.get();
    const Study study = load_study(command.study);
    if (study.rendering)
        check_display({});
    study.rendering && !team ? end_at_interrupts() : catch_interrupts();
    std::optional<Device> device;
    if (study.rendering) {
        prepare_opencl(common.threads);
        device.emplace(common.device);
    }
    const RenderHooks hooks{.on_set_up = catch_interrupts};
    options.render.hooks = &hooks;
    StudyResult result;
    {
        ProgressBar bar(common.quiet);
        bar.update("setting up the first cell");
        result = run_study(study, device ? &*device : nullptr, options,
                           [&](double share, const std::string& note) {
                               bar.update(share, note);
                               return !interrupt_requested();
                           });
    }
    if (team && !team->leads())
        return 0;
    const std::size_t failed = failed_cells(result);
    if (!result.interrupted)
        write_results(study, result, options.folder);
    write_json(common.json, result_json(study, result));
    if (!common.quiet)
        fmt::print("{} of {} cells done, {} failed; {}\n", result.cells.size() - failed,
                   study.cell_count(), failed,
                   result.interrupted ? "interrupted: run again to go on"
                                      : (options.folder / "index.html").string());
    if (result.interrupted)
        return exit_interrupted;
    return failed > 0 ? exit_cells_failed : 0;
}

} // namespace

void add_study_command(Program& program, CommandContext& context) {
    auto command = std::make_shared<StudyCommand>();
    Command app = program.add_command(
        "study", "Sweeps parameters of a scene or material: renders, measurements and a page");
    app.option("STUDY", command->study, "study file (TOML)").required();
    app.option("-o,--output", command->options.folder, "folder to write to").required();
    app.option("--memory-limit", command->options.render.memory_limit_bytes,
               "refuse a render that would take more bytes (default: 80 % of the machine's)");
    app.option("--checkpoint", command->options.render.checkpoint_seconds,
               "keep a cell's render every so many seconds")
        .positive()
        .show_default();
    app.flag("--resume", command->options.resume,
             "refuse what was kept of another scene, build or device; without it such a cell "
             "begins anew");
    app.footer("All pictures have one exposure, chosen by what they show; exposure_ev in the "
               "study's [render] sets it.\n"
               "Example: reradiant study study.toml -o results");
    app.callback([command, &context] { context.exit_code = run(*command, context); });
}

} // namespace reradiant
