#include "reradiant/measure.h"
#include "host/measure/measure_substrate.h"
#include "host/measure/walk_continuation.h"
#include "host/measure/walk_measurement.h"
#include "host/measure/walk_states.h"
#include "host/report/json_file.h"
#include "host/report/progress.h"
#include "host/scene/model/named_files.h"
#include "reradiant/error.h"
#include "reradiant/scene_file.h"
#include "tools/program/command.h"
#include "tools/program/interrupt.h"
#include "tools/program/kept_work.h"
#include "tools/program/outputs.h"
#include "tools/program/parse_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

namespace reradiant {

namespace {

/// The blocks that the WalkState of one theta_i counts when it is done: the groups of blocks
/// advance in step, and the state counts the blocks that each of the 16 has done.
constexpr double blocks_in_state = static_cast<double>(walk_blocks) / 16.0;

struct MeasureOptions {
    std::filesystem::path material, output;
    std::string preset;
    std::vector<double> theta_i{0.0}, theta_o{0.0}, phi{0.0};
    bool hemispherical = false;
    std::string model = "auto", bands;
    long samples = 0;
    double checkpoint_seconds = 60.0;
    bool resume = false;
    std::uint64_t memory_limit_bytes = 0;
};

std::filesystem::path material_file(const MeasureOptions& options) {
    return options.preset.empty() ? options.material : preset_file(options.preset);
}

/// Returns all that a walk depends on, by name. The numbers of the material stand for the files
/// that it names.
SampleIdentity walk_identity(const std::filesystem::path& file, const Material& material,
                             const MeasureRequest& request) {
    const WavelengthGrid bands = measured_bands(material, request);
    const SubstrateValues substrate = measured_substrate(material.substrate, bands);
    std::string numbers = fmt::format("{}", fmt::join(substrate.matrix.reshaped(), " "));
    for (const SurfaceValues& conductor : substrate.conductor)
        numbers += fmt::format(" {} {}", conductor.ior_below, conductor.kappa);
    return {{"material", file_digest(file)},
            {"stack", stack_digest(material.stack, bands)},
            {"substrate", sha256_hex(numbers)},
            {"bands", fmt::format("{}:{}:{}", bands.from_nm, bands.to_nm(), bands.step_nm)},
            {"model", model_name(request.model)},
            {"theta_i", fmt::format("{}", fmt::join(request.theta_i_deg, ","))},
            {"theta_o", fmt::format("{}", fmt::join(request.theta_o_deg, ","))},
            {"phi", fmt::format("{}", fmt::join(request.phi_deg, ","))},
            {"kind", request.hemispherical ? "hemispherical" : "directional"},
            {"samples", std::to_string(request.samples)},
            {"seed", std::to_string(request.seed)}};
}

using WalkStates = std::function<std::vector<WalkState>()>;

/// Shows the progress of walks, seldom: their states are dear to ask for.
class WalkProgress {
public:
    WalkProgress(bool quiet, const MeasureRequest& request)
        : bar_(quiet), theta_count_(static_cast<double>(request.theta_i_deg.size())) {
        const long samples = request.samples > 0 ? request.samples : default_walk_samples;
        block_size_ = std::ceil(static_cast<double>(samples) / static_cast<double>(walk_blocks));
        bar_.update("setting up tables");
    }

    void update(const WalkStates& states) {
        if (Clock::now() < next_ || !bar_.is_due())
            return;
        next_ = Clock::now() + std::chrono::seconds(1);
        double done = 0.0;
        for (const WalkState& state : states())
            done +=
                static_cast<double>(state.blocks) + static_cast<double>(state.walks) / block_size_;
        bar_.update(done / (theta_count_ * blocks_in_state), "walking");
    }

private:
    using Clock = std::chrono::steady_clock;

    ProgressBar bar_;
    double theta_count_, block_size_;
    Clock::time_point next_{};
};

/// Measures with a checkpoint. Returns nothing when it was interrupted, which it says.
std::optional<Measurement> measure_and_keep(const MeasureOptions& options, const Material& material,
                                            MeasureRequest request, bool quiet) {
    KeptWork kept(options.output, walk_identity(material_file(options), material, request),
                  options.checkpoint_seconds);
    WalkContinuation walks;
    if (options.resume)
        kept.resume([&](const nlohmann::json& state) { walks.states = walk_states_from(state); });
    WalkProgress progress(quiet, request);
    walks.pause = [&](const WalkStates& states) {
        kept.keep_when_due([&] { return walk_states_json(states()); });
        progress.update(states);
    };
    request.walks = &walks;
    request.stop = interrupt_flag();
    catch_interrupts();
    try {
        Measurement measurement = measure_material(material, request);
        kept.remove();
        return measurement;
    } catch (const Interrupted&) {
        fmt::print(stderr, "{}\n", kept.interruption_text());
        return std::nullopt;
    }
}

/// Errors of meaning have no place of their own: they are placed at the material's file.
std::optional<Measurement> measure_file(const MeasureOptions& options,
                                        const MeasureRequest& request,
                                        const CommonOptions& common) {
    const std::filesystem::path file = material_file(options);
    const Material material = load_material(file, request.bands);
    check_outputs(common, {{"-o", options.output, {".csv"}}}, named_files());
    try {
        return measure_and_keep(options, material, request, common.quiet);
    } catch (const Error& error) {
        if (error.kind() == Error::Kind::Input && error.position().file.empty())
            throw_input_error({file.string()}, error.what());
        throw;
    }
}

std::string counted(std::size_t count, const char* one, const char* several) {
    return fmt::format("{} {}", count, count == 1 ? one : several);
}

const char* quantity_name(const Measurement& measurement) {
    if (measurement.hemispherical)
        return measurement.of_sheet ? "directional-hemispherical reflectance and transmittance"
                                    : "directional-hemispherical reflectance";
    return measurement.of_sheet ? "bispectral BSDF" : "bispectral BRDF";
}

/// What was made, and where: one line.
std::string summary(const MeasureOptions& options, const MeasureRequest& request,
                    const Measurement& measurement) {
    const std::size_t incidences = request.theta_i_deg.size();
    const std::string directions =
        measurement.hemispherical
            ? counted(incidences, "incidence", "incidences")
            : counted(incidences * request.theta_o_deg.size() * request.phi_deg.size(),
                      "pair of directions", "pairs of directions");
    const WavelengthGrid& bands = measurement.bands;
    return fmt::format(
        "{}: {} of {}, {}, {} from {:.6g} to {:.6g} nm, {}, model {}", options.output.string(),
        quantity_name(measurement), material_file(options).filename().string(), directions,
        counted(static_cast<std::size_t>(bands.count), "band", "bands"), bands.from_nm,
        bands.to_nm(), counted(measurement.rows.size(), "row", "rows"),
        model_name(measurement.model));
}

/// The balance of every theta_i: over the bands of excitation, what leaves or is guided over what
/// came. Empty for directions.
nlohmann::json balances_json(const Measurement& measurement) {
    nlohmann::json list = nlohmann::json::array();
    for (const MeasuredBalance& one : measured_balances(measurement))
        list.push_back(
            {{"theta_i_deg", one.theta_i_deg},
             {"energy", {{"smallest", one.smallest_energy}, {"largest", one.largest_energy}}},
             {"photons", {{"smallest", one.smallest_photons}, {"largest", one.largest_photons}}}});
    return list;
}

int run_measure(const MeasureOptions& options, const CommonOptions& common) {
    MeasureRequest request;
    request.theta_i_deg = options.theta_i;
    request.theta_o_deg = options.theta_o;
    request.phi_deg = options.phi;
    request.hemispherical = options.hemispherical;
    request.model = parse_model_option(options.model);
    request.samples = options.samples;
    request.seed = common.seed;
    request.memory_limit_bytes = options.memory_limit_bytes;
    if (!options.bands.empty())
        request.bands = parse_bands_option(options.bands);
    check_outputs(common, {{"-o", options.output, {".csv"}}}, {options.material});
    // what computes in parallel asks the library how many threads there are
    std::optional<tbb::global_control> threads;
    if (common.threads > 0) {
        threads.emplace(tbb::global_control::max_allowed_parallelism,
                        static_cast<std::size_t>(common.threads));
    }
    const std::optional<Measurement> measured = measure_file(options, request, common);
    if (!measured)
        return exit_interrupted;
    const Measurement& measurement = *measured;
    write_measurement(options.output, measurement);
    write_json(common.json, {{"model", model_name(measurement.model)},
                             {"rows", measurement.rows.size()},
                             {"hemispherical", measurement.hemispherical},
                             {"bands",
                              {{"from_nm", measurement.bands.from_nm},
                               {"to_nm", measurement.bands.to_nm()},
                               {"step_nm", measurement.bands.step_nm}}},
                             {"balance", balances_json(measurement)},
                             {"notes", measurement.notes}});
    if (!common.quiet) {
        fmt::print("{}\n", summary(options, request, measurement));
        for (const std::string& note : measurement.notes)
            fmt::print("{}\n", note);
    }
    return 0;
}

} // namespace

void add_measure_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<MeasureOptions>();
    Command command = program.add_command(
        "measure", "Measures a material with a virtual bispectral goniophotometer");
    Command source = command.one_of_group("material");
    source.option("MATERIAL", options->material, "TOML file with one [material]");
    source.option("--preset", options->preset, "a material of spectra/materials by name");
    command.option("-o,--output", options->output, "CSV file to write").required();
    command
        .option("--theta-i", options->theta_i,
                "incident angles, degrees, as in 0,45; above 90: from beneath a sheet; default: 0")
        .delimiter(',');
    command
        .option("--theta-o", options->theta_o,
                "outgoing angles, degrees, as in 5,20,60; above 90: beneath a sheet; default: 0")
        .delimiter(',');
    command
        .option("--phi", options->phi,
                "azimuths of the outgoing from the incident direction, degrees; 180 is the "
                "mirror side; default: 0")
        .delimiter(',');
    command.flag("--hemispherical", options->hemispherical,
                 "directional-hemispherical matrix instead of the BRDF");
    command.option("--model", options->model, "auto, adding, weidlich-wilkie or walk");
    command.option("--bands", options->bands,
                   "FROM:TO:STEP of band centres in nm; default: the matrix's own grid");
    command
        .option("--samples", options->samples,
                "paths per theta-i (model walk only; default 65536), in blocks of 256")
        .non_negative();
    command
        .option("--checkpoint", options->checkpoint_seconds,
                "write OUT.csv.checkpoint every so many seconds of walks")
        .positive()
        .show_default();
    command.flag("--resume", options->resume, "go on from OUT.csv.checkpoint where it exists");
    command.option("--memory-limit", options->memory_limit_bytes,
                   "refuse a measurement that would take more bytes (default: 80 % of the "
                   "machine's)");
    command.footer("Example: reradiant measure lacquer.toml -o lacquer.csv --theta-i 45 "
                   "--theta-o 0,20,60 --phi 180");
    command.callback(
        [options, &context] { context.exit_code = run_measure(*options, context.common); });
}

} // namespace reradiant
