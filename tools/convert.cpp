#include "host/atomic_file.h"
#include "host/error.h"
#include "host/output_file.h"
#include "host/paths.h"
#include "host/quiet_log.h"
#include "host/report/json_file.h"
#include "host/scene/mitsuba_import.h"
#include "host/scene/scene_table.h"
#include "host/scene/toml_document.h"
#include "host/spectral/matrix_io.h"
#include "host/spectral/spectrum_formats.h"
#include "tools/command.h"
#include "tools/file_kind.h"
#include "tools/outputs.h"

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <sstream>

namespace reradiant {

namespace {

struct ConvertOptions {
    std::filesystem::path in, out;
    std::string quantity, orientation;
};

bool is_matrix_ending(const std::string& ending) {
    return ending == ".csv" || ending == ".bfc" || ending == ".exr";
}

void refuse_form_options(const ConvertOptions& options, const char* why) {
    if (!options.quantity.empty() || !options.orientation.empty())
        throw_input_error({options.out.string()},
                          fmt::format("--quantity and --orientation {}", why),
                          "leave them out, or write a .csv of a re-radiation matrix");
}

using FileAction = std::function<void(const std::filesystem::path&)>;

/// Writes what loads again, which a copy among the temporary files shows.
void write_if_it_loads(const ConvertOptions& options, const FileAction& write,
                       const FileAction& read) {
    const std::filesystem::path copy =
        temporary_beside(temporary_directory() / ("convert" + options.out.extension().string()));
    const auto remove = [](const std::filesystem::path* file) {
        std::error_code ignored;
        std::filesystem::remove(*file, ignored);
    };
    const std::unique_ptr<const std::filesystem::path, decltype(remove)> removed(&copy, remove);
    try {
        const QuietLog quiet;
        write(copy);
        read(copy);
    } catch (const Error& error) {
        if (error.kind() == Error::Kind::Runtime)
            throw; // the disk is full, say
        throw_input_error({options.in.string()},
                          fmt::format("would become a file that does not load: {}", error.what()),
                          "convert into another format");
    }
    write(options.out);
}

void convert_matrix(const ConvertOptions& options) {
    const std::string ending = lower_case_ending(options.out);
    if (!is_matrix_ending(ending))
        throw_input_error({options.out.string()},
                          fmt::format("a re-radiation matrix does not fit into '{}'", ending),
                          "write .csv, .bfc or .exr");
    if (ending != ".csv")
        refuse_form_options(options, "are for CSV only");
    const ReradiationMatrix matrix = read_reradiation(options.in);
    MatrixCsvForm form;
    if (options.quantity == "density-per-nm")
        form.quantity = MatrixQuantity::DensityPerNm;
    form.rows_are_emission = options.orientation != "rows-excitation";
    write_if_it_loads(
        options,
        [&](const auto& file) {
            ending == ".csv" ? write_reradiation_csv(file, matrix, form)
                             : write_reradiation(file, matrix);
        },
        [](const auto& file) { read_reradiation(file); });
}

void convert_spectrum(const ConvertOptions& options) {
    refuse_form_options(options, "are for re-radiation matrices only");
    if (const std::string ending = lower_case_ending(options.out);
        ending != ".csv" && ending != ".spd")
        throw_input_error({options.out.string()},
                          fmt::format("a spectrum does not fit into '{}'", ending),
                          "write .csv or .spd");
    const NumberTable table = read_spectrum_table(options.in);
    write_if_it_loads(
        options,
        [&](const auto& file) { write_spectrum(file, table.columns[0], table.columns[1]); },
        [](const auto& file) { read_spectrum(file); });
}

/// Refuses what would not load: in the XML, where its place is known, then as it would be written.
void check_scene(const ConvertOptions& options, const std::string& text) {
    const QuietLog quiet;
    load_scene(options.in);
    try {
        scene_from_table(parse_toml(options.out.string(), text), options.out);
    } catch (const Error& error) {
        throw_input_error({options.in.string()},
                          fmt::format("would become a scene that does not load: {}", error.what()));
    }
}

/// A scene of Mitsuba 3 as one of this program; files keep their places.
void convert_scene(const ConvertOptions& options) {
    refuse_form_options(options, "are for re-radiation matrices only");
    if (lower_case_ending(options.out) != ".toml")
        throw_input_error({options.out.string()}, "a scene is written as .toml", "name a .toml");
    std::ostringstream text;
    text << "# made of " << options.in.filename().string() << " by reradiant convert\n"
         << toml::toml_formatter(mitsuba_scene_table(options.in, options.out.parent_path()))
         << '\n';
    check_scene(options, text.str());
    write_text_atomically(options.out, text.str());
}

/// What was converted.
const char* convert(const ConvertOptions& options) {
    // By what the files hold: a spectrum of IES TM-27 may end with .xml as a scene does.
    if (is_mitsuba_scene(options.in) && file_kind(options.in) == FileKind::Scene) {
        convert_scene(options);
        return "scene";
    }
    if (holds_reradiation(options.in)) {
        convert_matrix(options);
        return "re-radiation matrix";
    }
    convert_spectrum(options);
    return "spectrum";
}

int run_convert(const ConvertOptions& options, const CommonOptions& common) {
    if (options.in.empty())
        throw_input_error({}, "IN names no file", "give the file to convert");
    check_outputs(common, {{"OUT", options.out}});
    const char* const kind = convert(options);
    write_json(common.json,
               {{"kind", kind}, {"in", options.in.string()}, {"out", options.out.string()}});
    return 0;
}

} // namespace

void add_convert_command(CLI::App& program, CommandContext& context) {
    const auto options = std::make_shared<ConvertOptions>();
    CLI::App* const command =
        program.add_subcommand("convert", "converts matrices (BFC, CSV, EXR), spectra (SPD, CSV, "
                                          "JCAMP-DX, CGATS, SPDX) and scenes of Mitsuba 3");
    command
        ->add_option("IN", options->in,
                     "matrix (.bfc, .csv, .exr), spectrum (.spd, .csv, JCAMP-DX, CGATS, .spdx) or "
                     "Mitsuba scene (.xml)")
        ->required();
    command->add_option("OUT", options->out, "file to write; its ending says the format")
        ->required();
    command->add_option("--quantity", options->quantity, "of a matrix written as CSV")
        ->check(CLI::IsMember({"per-band", "density-per-nm"}));
    command->add_option("--orientation", options->orientation, "of a matrix written as CSV")
        ->check(CLI::IsMember({"rows-emission", "rows-excitation"}));
    command->footer("Examples:\n"
                    "  reradiant convert paint.bfc paint.csv\n"
                    "  reradiant convert scene.xml scene.toml");
    command->callback(
        [options, &context] { context.exit_code = run_convert(*options, context.common); });
}

} // namespace reradiant
