#include "host/base/atomic_file.h"
#include "host/base/output_ending.h"
#include "host/base/output_file.h"
#include "host/base/quiet_log.h"
#include "host/report/json_file.h"
#include "host/scene/document/toml_document.h"
#include "host/scene/mitsuba/mitsuba_import.h"
#include "host/scene/toml/scene_table.h"
#include "host/spectral/evidence/matrix_warnings.h"
#include "host/spectral/spectrum/spectrum_formats.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"
#include "reradiant/reradiation.h"
#include "reradiant/scene_file.h"
#include "reradiant/spectral_files.h"
#include "tools/program/command.h"
#include "tools/program/file_kind.h"
#include "tools/program/outputs.h"

#include <fmt/core.h>

#include <functional>
#include <memory>
#include <sstream>

namespace reradiant {

namespace {

struct ConvertOptions {
    std::filesystem::path in, out;
    TableWords words; ///< the user's words about the table in IN
    std::string out_rows, out_quantity;
};

bool is_matrix_ending(const std::string& ending) {
    return ending == ".csv" || ending == ".bfc" || ending == ".exr";
}

void refuse_form_options(const ConvertOptions& options, const std::string& what) {
    if (table_form(options.words) != TableForm{})
        throw_input_error(
            {options.in.string()},
            fmt::format("--rows, --quantity, --scale, --decimal, --kind, "
                        "--anti-stokes and --geometry are of tables of re-radiation, not of {}",
                        what),
            "leave them out");
}

void refuse_out_options(const ConvertOptions& options) {
    if (!options.out_rows.empty() || !options.out_quantity.empty())
        throw_input_error({options.out.string()},
                          "--out-rows and --out-quantity are of a re-radiation matrix as CSV",
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

/// Reads the matrix in IN; a measurement may keep its gaps where a CSV is written.
ReradiationMatrix read_matrix(const ConvertOptions& options, Gaps gaps) {
    const TableForm form = table_form(options.words);
    if (gaps == Gaps::Refused)
        return read_reradiation(options.in, gaps, form);
    ReradiationMatrix matrix = read_reradiation(options.in, gaps, form);
    const bool has_gaps = !matrix.values.allFinite();
    if (has_gaps && matrix.kind == MatrixKind::Model)
        return read_reradiation(options.in, Gaps::Refused, form); // says where
    return matrix;
}

void convert_matrix(const ConvertOptions& options) {
    const std::string ending = lower_case_ending(options.out);
    if (!is_matrix_ending(ending))
        throw_input_error({options.out.string()},
                          fmt::format("a re-radiation matrix does not fit into '{}'", ending),
                          "write .csv, .bfc or .exr");
    if (ending != ".csv")
        refuse_out_options(options);
    const Gaps gaps = ending == ".csv" ? Gaps::BecomeNan : Gaps::Refused;
    const ReradiationMatrix matrix = read_matrix(options, gaps);
    warn_of_matrix(options.in.string(), matrix);
    MatrixCsvForm form;
    if (!options.out_quantity.empty())
        form.quantity = matrix_quantity(options.out_quantity);
    form.rows_are_emission = options.out_rows.empty() || rows_are_emission(options.out_rows);
    write_if_it_loads(
        options,
        [&](const auto& file) {
            ending == ".csv" ? write_reradiation_csv(file, matrix, form)
                             : write_reradiation(file, matrix);
        },
        [&](const auto& file) { read_reradiation(file, gaps); });
}

void convert_spectrum(const ConvertOptions& options) {
    refuse_form_options(options, "spectra");
    refuse_out_options(options);
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

/// Converts a scene of Mitsuba 3 to one of this program; files keep their places.
void convert_scene(const ConvertOptions& options) {
    refuse_form_options(options, "scenes");
    refuse_out_options(options);
    if (lower_case_ending(options.out) != ".toml")
        throw_input_error({options.out.string()}, "a scene is written as .toml", "name a .toml");
    std::ostringstream text;
    text << "# made of " << options.in.filename().string() << " by reradiant convert\n"
         << toml::toml_formatter(mitsuba_scene_table(options.in, options.out.parent_path()))
         << '\n';
    check_scene(options, text.str());
    write_text_atomically(options.out, text.str());
}

/// Converts IN and returns what it was: "scene", "re-radiation matrix" or "spectrum".
const char* convert(const ConvertOptions& options) {
    // The content of the file decides, not its ending: a spectrum of IES TM-27 may end with .xml as
    // a scene does.
    if (is_mitsuba_scene(options.in) && file_kind(options.in) == FileKind::Scene) {
        convert_scene(options);
        return "scene";
    }
    if (!options.words.rows.empty() || !options.words.quantity.empty() ||
        holds_reradiation(options.in)) {
        convert_matrix(options);
        return "re-radiation matrix";
    }
    if (file_kind(options.in) == FileKind::ComplexIndex)
        throw_input_error({options.in.string()},
                          "is a complex index of refraction (nm,n,k), which has one form alone",
                          "materials take it as it is: ior and kappa are its two columns");
    convert_spectrum(options);
    return "spectrum";
}

int run_convert(const ConvertOptions& options, const CommonOptions& common) {
    if (options.in.empty())
        throw_input_error({}, "IN names no file", "give the file to convert");
    check_outputs(common, {{"OUT", options.out}}, {options.in});
    const char* const kind = convert(options);
    if (!common.quiet)
        fmt::print("{}: a {} of {}\n", options.out.string(), kind, options.in.string());
    write_json(common.json,
               {{"kind", kind}, {"in", options.in.string()}, {"out", options.out.string()}});
    return 0;
}

/// Adds the options that say how a plain table of numbers is to be read.
void add_table_options(Command command, ConvertOptions& options) {
    const char* const group = "A table that does not say what its numbers are";
    command
        .option("--rows", options.words.rows,
                "what a row of IN belongs to: emission (excitation goes across) or excitation")
        .one_of({"emission", "excitation", "rows-emission", "rows-excitation"})
        .group(group);
    command
        .option("--quantity", options.words.quantity,
                "values of IN: per-band (their sum over the bands of excitation counts) or "
                "density (per nm of excitation)")
        .one_of({"per-band", "density", "density-per-nm"})
        .group(group);
    command
        .option("--scale", options.words.scale,
                "percent, permille or the factor that makes a white reflect 1")
        .group(group);
    command
        .option("--decimal", options.words.decimal,
                "comma or point; told by itself where cells are parted by semicolons or tabs")
        .one_of({"comma", "point"})
        .group(group);
    command
        .option("--kind", options.words.kind,
                "measured (holds noise, may have gaps) or model (the default)")
        .one_of({"measured", "model"})
        .group(group);
    command
        .flag("--anti-stokes", options.words.anti_stokes,
              "emission below its excitation is real, not noise")
        .group(group);
    command
        .option("--geometry", options.words.geometry,
                "illumination/viewing of the instrument, as in 45/0 (`fit --stack` needs it)")
        .group(group);
    command.option("--out-rows", options.out_rows, "of a matrix written as CSV: emission")
        .one_of({"emission", "excitation", "rows-emission", "rows-excitation"});
    command.option("--out-quantity", options.out_quantity, "of a matrix written as CSV: per-band")
        .one_of({"per-band", "density", "density-per-nm"});
}

} // namespace

void add_convert_command(Program& program, CommandContext& context) {
    const auto options = std::make_shared<ConvertOptions>();
    Command command =
        program.add_command("convert", "converts matrices (BFC, CSV, EXR), spectra (SPD, CSV, "
                                       "JCAMP-DX, CGATS, SPDX) and scenes of Mitsuba 3");
    command
        .option("IN", options->in,
                "matrix (.bfc, .csv, .exr), spectrum (.spd, .csv, JCAMP-DX, CGATS, .spdx) or "
                "Mitsuba scene (.xml)")
        .required();
    command.option("OUT", options->out, "file to write; its ending says the format").required();
    add_table_options(command, *options);
    command.footer("Examples:\n"
                   "  reradiant convert paint.bfc paint.csv\n"
                   "  reradiant convert export.csv paint.csv --rows emission --quantity per-band "
                   "--scale percent --kind measured\n"
                   "  reradiant convert scene.xml scene.toml");
    command.callback(
        [options, &context] { context.exit_code = run_convert(*options, context.common); });
}

} // namespace reradiant
