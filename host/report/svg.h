#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

/// Plots as SVG text: one self-contained element without ids, so that any number of them may stand
/// in one HTML page. Not-finite values are gaps.
namespace reradiant::svg {

struct Series {
    std::string label; ///< empty: not in the legend
    std::vector<double> x, y;
    std::vector<double> low = {}, high = {}; ///< a band about y, as long as y, or empty
    bool points = false;                     ///< marks instead of a line
    std::optional<std::size_t> colour = {};  ///< which series_colour; empty: by its place
};

struct Axes {
    std::string title = {}, x_label = {}, y_label = {};
    bool log_x = false, log_y = false; ///< values <= 0 are gaps there
};

/// Curves over common axes, a legend beside them. The axes hold every value and every band.
/// std::invalid_argument when the lengths of a series disagree.
std::string line_plot(const Axes& axes, const std::vector<Series>& series);

/// The same to be put into another drawing: no element around it, its texts 12 pixels high, the
/// legend above the curves in as many rows as it takes. It fills `width` x `height` pixels.
std::string line_plot_within(const Axes& axes, const std::vector<Series>& series, double width,
                             double height);

struct HeatMap {
    std::string title = {}, x_label = {}, y_label = {};
    std::vector<double> x, y;    ///< cell centres, ascending in equal steps
    Eigen::MatrixXd value;       ///< (y, x); NaN cells are hatched grey
    bool diverging = false;      ///< colours centred at 0, for differences
    Eigen::MatrixXd marked = {}; ///< cells above 0 get a red outline; empty: none
};

/// A matrix in perceptually uniform colours with a colour bar. std::invalid_argument when sizes
/// disagree or the centres are not in equal steps.
std::string heat_map(const HeatMap& map);

} // namespace reradiant::svg
