// Fits of measured data by every model: bytes, error, processor seconds as Markdown, and with a
// folder as argument residual against run time (CSV and SVG).
//
//     table_fit_measured [FOLDER]

#include "host/base/atomic_file.h"
#include "host/report/svg.h"
#include "reradiant/error.h"
#include "reradiant/fit.h"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

using namespace reradiant;

namespace {

struct Setting {
    std::string name;
    FitModel model;
    std::optional<int> rank;
    std::optional<double> smooth_nm;
    std::optional<std::size_t> bytes = {};
    int starts = 4;
};

std::vector<Setting> settings() {
    return {{"factors, rank 1", FitModel::Factors, 1, 0.0},
            {"factors, rank 1, 200 bytes", FitModel::Factors, 1, {}, 200},
            {"factors, rank 2", FitModel::Factors, 2, 0.0},
            {"factors, rank 3", FitModel::Factors, 3, 0.0},
            {"factors, rank 3, one start", FitModel::Factors, 3, 0.0, {}, 1},
            {"factors, rank 3, 600 bytes", FitModel::Factors, 3, {}, 600},
            {"factors, by evidence", FitModel::Factors, {}, {}},
            {"gaussians, 12", FitModel::Gaussians, 12, {}},
            {"matrix", FitModel::Matrix, {}, {}}};
}

struct Row {
    std::string file;
    Setting setting;
    FitResult result;
    double processor_seconds;
};

Row fit_one(const std::filesystem::path& file, const Setting& setting) {
    FitSettings request;
    request.model = setting.model;
    request.rank = setting.rank;
    request.smooth_nm = setting.smooth_nm;
    request.starts = setting.starts;
    request.most_bytes = setting.bytes;
    const BispectralData data = read_bispectral_data(file);
    const std::clock_t begin = std::clock();
    FitResult result = fit_reradiation(data, request);
    return {file.stem().string(), setting, std::move(result),
            static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC};
}

void print_row(const Row& row) {
    fmt::print("| {} | {} | {} | {} | {:.4f} | {:.2f} | {} | {:.1e} |{}\n", row.file,
               row.setting.name, row.result.rank, row.result.bytes, row.result.relative_rmse,
               row.processor_seconds, row.result.trace.iterations, row.result.trace.kkt,
               row.result.failure.empty() ? "" : " " + row.result.failure);
    std::fflush(stdout);
}

/// Weighted residual per datum against wall seconds, a curve a setting, for one file.
void write_curves(const std::filesystem::path& folder, const std::vector<Row>& rows) {
    std::string csv = "file,setting,seconds,residual\n";
    std::vector<svg::Series> series;
    for (const Row& row : rows) {
        const double used = std::max(1.0, row.result.used.sum());
        svg::Series curve{row.setting.name, row.result.trace.seconds, {}};
        for (std::size_t k = 0; k < row.result.trace.cost.size(); ++k) {
            curve.y.push_back(std::sqrt(2.0 * row.result.trace.cost[k] / used));
            csv += fmt::format("{},\"{}\",{:.6g},{:.9g}\n", row.file, row.setting.name,
                               row.result.trace.seconds[k], curve.y.back());
        }
        series.push_back(std::move(curve));
    }
    svg::Axes axes{rows.front().file, "seconds", "residual, standard errors"};
    axes.log_x = axes.log_y = true;
    write_text_atomically(folder / ("residual-" + rows.front().file + ".csv"), csv);
    write_text_atomically(folder / ("residual-" + rows.front().file + ".svg"),
                          svg::line_plot(axes, series));
}

int run(int argc, char** argv) {
    const std::filesystem::path data =
        std::filesystem::path(RERADIANT_SOURCE_DIR) / ".." / "shared" / "data" / "bfc";
    if (!std::filesystem::exists(data)) {
        fmt::print(stderr, "no measured data in {}\n", data.string());
        return 1;
    }
    if (argc > 1)
        std::filesystem::create_directories(argv[1]);
    fmt::print("| data | model | terms | bytes | relative RMSE | CPU s | steps | KKT |\n"
               "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (const char* name :
         {"HERPIORA", "CIBA12", "HERPICER", "IXCRLALE", "POLGREE", "CIPLAW10", "PHP8HP1C"}) {
        std::vector<Row> rows;
        for (const Setting& setting : settings()) {
            rows.push_back(fit_one(data / (std::string(name) + ".BFC"), setting));
            print_row(rows.back());
        }
        if (argc > 1)
            write_curves(argv[1], rows);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return error.exit_code();
    }
}
