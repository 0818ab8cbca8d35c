#include "host/atomic_file.h"
#include "host/error.h"
#include "host/scene/mitsuba_import.h"
#include "host/spectral/matrix_io.h"
#include "host/spectral/spectrum_formats.h"
#include "tools/command.h"
#include "tools/file_kind.h"

#include <fmt/format.h>

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

void convert_matrix(const ConvertOptions& options) {
    const std::string ending = lower_case_ending(options.out);
    if (!is_matrix_ending(ending))
        throw_input_error({options.out.string()},
                          fmt::format("a re-radiation matrix does not fit into '{}'", ending),
                          "write .csv, .bfc or .exr");
    if (ending != ".csv")
        refuse_form_options(options, "are for CSV only");
    const ReradiationMatrix matrix = read_reradiation(options.in);
    if (ending != ".csv")
        return write_reradiation(options.out, matrix);
    MatrixCsvForm form;
    if (options.quantity == "density-per-nm")
        form.quantity = MatrixQuantity::DensityPerNm;
    form.rows_are_emission = options.orientation != "rows-excitation";
    write_reradiation_csv(options.out, matrix, form);
}

void convert_spectrum(const ConvertOptions& options) {
    refuse_form_options(options, "are for re-radiation matrices only");
    const NumberTable table = read_spectrum_table(options.in);
    write_spectrum(options.out, table.columns[0], table.columns[1]);
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
    write_text_atomically(options.out, text.str());
}

void convert(const ConvertOptions& options) {
    // By what the files hold: a spectrum of IES TM-27 may end with .xml as a scene does.
    if (is_mitsuba_scene(options.in) && file_kind(options.in) == FileKind::Scene)
        convert_scene(options);
    else if (holds_reradiation(options.in))
        convert_matrix(options);
    else
        convert_spectrum(options);
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
    command->callback([options, &context] {
        convert(*options);
        context.exit_code = 0;
    });
}

} // namespace reradiant
