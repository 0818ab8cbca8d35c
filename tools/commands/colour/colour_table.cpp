#include "tools/commands/colour/colour_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

namespace reradiant {

namespace {

/// A cell of a row from the colour that the row is of.
struct Column {
    std::string name;
    std::function<std::string(const SeenSample&, const SeenColour&)> cell;
};
using Columns = std::vector<Column>;

/// Adds columns of numbers in one format.
class NumberColumns {
public:
    NumberColumns(Columns& columns, std::string format)
        : columns_(columns), format_(std::move(format)) {}

    /// `value` takes a report and returns a number, or an optional one.
    template <typename Value>
    void add(const std::string& name, const Value& value) {
        columns_.push_back({name, [format = format_, value](const auto&, const SeenColour& seen) {
                                const std::optional<double> number = value(seen.report);
                                return number && std::isfinite(*number)
                                           ? fmt::format(fmt::runtime(format), *number)
                                           : std::string();
                            }});
    }

    /// The indices of what `part` takes out of a report: whiteness and tint of the CIE, R457,
    /// whiteness and yellowness of E313.
    template <typename Part>
    void add_indices(const std::array<std::string, 5>& names, const Part& part) {
        using Optional = std::optional<double>;
        add(names[0], [part](const ColourReport& report) {
            const auto& whiteness = part(report).whiteness;
            return whiteness ? Optional(whiteness->whiteness) : Optional();
        });
        add(names[1], [part](const ColourReport& report) {
            const auto& whiteness = part(report).whiteness;
            return whiteness ? Optional(whiteness->tint) : Optional();
        });
        add(names[2], [part](const ColourReport& report) { return part(report).r457; });
        add(names[3], [part](const ColourReport& report) {
            const auto& e313 = part(report).e313;
            return e313 ? Optional(e313->whiteness) : Optional();
        });
        add(names[4], [part](const ColourReport& report) {
            const auto& e313 = part(report).e313;
            return e313 ? Optional(e313->yellowness) : Optional();
        });
    }

    /// Three numbers, or two, with a name each.
    template <typename Part, typename Numbers>
    void add_each(const std::vector<std::string>& names, const Part& part, Numbers numbers) {
        for (std::size_t c = 0; c < names.size(); ++c)
            add(names[c], [part, numbers, c](const ColourReport& report) {
                return numbers(part(report))[c];
            });
    }

private:
    Columns& columns_;
    std::string format_;
};

const IndexedColour& whole(const ColourReport& report) {
    return report;
}
const IndexedColour& without_uv(const ColourReport& report) {
    return report.uv_excluded;
}

void add_conditions(Columns& columns, bool with_observer) {
    columns.push_back(
        {"lamp", [](const auto&, const SeenColour& seen) { return seen.report.illuminant; }});
    if (with_observer)
        columns.push_back({"observer", [](const auto&, const SeenColour& seen) {
                               return observer_name(seen.report.observer);
                           }});
}

void add_short_names(Columns& columns, const ColourOptions& options) {
    columns.push_back(
        {"sample", [](const SeenSample& sample, const auto&) { return sample.sample.short_name; }});
    add_conditions(columns, options.observers.size() > 1);
}

void add_geometry(Columns& columns) {
    columns.push_back({"geometry", [](const SeenSample& sample, const auto&) {
                           return sample.sample.matrix.geometry;
                       }});
}

void add_differences(NumberColumns& numbers, const std::vector<std::string>& names) {
    const auto differences = [](const ColourReport& report) {
        const ColourDifferences of = report.differences.value_or(ColourDifferences{});
        return std::array{of.cie1976, of.cie1994, of.ciede2000, of.cmc21};
    };
    numbers.add_each(names, differences, [](const std::array<double, 4>& all) { return all; });
    numbers.add("metamerism", [](const ColourReport& report) { return report.metamerism; });
}

template <typename Part>
void add_colour(Columns& columns, const Part& part) {
    NumberColumns numbers(columns, "{:.2f}");
    numbers.add("Y", [part](const ColourReport& report) { return part(report).colour.xyz[1]; });
    numbers.add_each({"L*", "a*", "b*"}, part, [](const auto& of) { return of.colour.lab; });
    numbers.add("C*", [part](const ColourReport& report) { return part(report).lch[1]; });
    numbers.add("h", [part](const ColourReport& report) { return part(report).lch[2]; });
    NumberColumns(columns, "{:.4f}").add_each({"x", "y"}, part, [](const auto& of) {
        return of.colour.xy;
    });
}

/// The polygons that the colour passes, where polygons are tested.
void add_polygons(Columns& columns, const ColourOptions& options) {
    if (options.polygons.empty())
        return;
    columns.push_back({"polygons", [](const auto&, const SeenColour& seen) {
                           std::string passed;
                           for (const PolygonVerdict& verdict : seen.report.polygons)
                               if (verdict.result.passes())
                                   passed += (passed.empty() ? "" : "; ") + verdict.polygon.name;
                           return passed.empty() && !seen.report.polygons.empty() ? "none" : passed;
                       }});
}

/// What becomes of columns without any value.
enum class Empty { Kept, LeftOut };

void drop_empty_columns(ColourTable& table) {
    for (std::size_t c = table.header.size(); c-- > 0;) {
        const auto at = static_cast<std::ptrdiff_t>(c);
        if (std::any_of(table.rows.begin(), table.rows.end(),
                        [&](const auto& row) { return !row[c].empty(); }))
            continue;
        table.header.erase(table.header.begin() + at);
        for (auto& row : table.rows)
            row.erase(row.begin() + at);
    }
}

ColourTable table_of(const Columns& columns, const std::vector<SeenSample>& samples, Empty empty) {
    ColourTable table;
    for (const Column& column : columns)
        table.header.push_back(column.name);
    for (const SeenSample& sample : samples)
        for (const SeenColour& seen : sample.colours) {
            std::vector<std::string>& row = table.rows.emplace_back();
            for (const Column& column : columns)
                row.push_back(column.cell(sample, seen));
        }
    if (empty == Empty::LeftOut)
        drop_empty_columns(table);
    return table;
}

} // namespace

ColourTable short_table(const std::vector<SeenSample>& samples, const ColourOptions& options) {
    Columns columns;
    add_short_names(columns, options);
    add_colour(columns, whole);
    NumberColumns numbers(columns, "{:.2f}");
    numbers.add_indices({"W", "tint", "R457", "W E313", "YI E313"}, whole);
    if (!options.against.empty())
        add_differences(numbers, {"dE76", "dE94", "dE2000", "CMC(2:1)"});
    add_polygons(columns, options);
    return table_of(columns, samples, Empty::LeftOut);
}

ColourTable colour_table(const std::vector<SeenSample>& samples, const ColourOptions& options,
                         bool uv_excluded) {
    Columns columns;
    add_short_names(columns, options);
    add_geometry(columns);
    add_colour(columns, uv_excluded ? without_uv : whole);
    return table_of(columns, samples, Empty::LeftOut);
}

ColourTable index_table(const std::vector<SeenSample>& samples, const ColourOptions& options,
                        bool uv_excluded) {
    Columns columns;
    add_short_names(columns, options);
    const auto names = static_cast<std::ptrdiff_t>(columns.size());
    NumberColumns(columns, "{:.2f}")
        .add_indices({"whiteness CIE", "tint CIE", "R457", "whiteness E313", "yellowness E313"},
                     uv_excluded ? without_uv : whole);
    ColourTable table = table_of(columns, samples, Empty::LeftOut);
    std::erase_if(table.rows, [&](const std::vector<std::string>& row) {
        return std::all_of(row.begin() + names, row.end(),
                           [](const std::string& cell) { return cell.empty(); });
    });
    return table;
}

ColourTable difference_table(const std::vector<SeenSample>& samples, const ColourOptions& options) {
    Columns columns;
    add_short_names(columns, options);
    NumberColumns numbers(columns, "{:.2f}");
    add_differences(numbers, {"CIE 1976", "CIE 1994", "CIEDE2000", "CMC(2:1)"});
    return table_of(columns, samples, Empty::LeftOut);
}

ColourTable whole_table(const std::vector<SeenSample>& samples, const ColourOptions& options) {
    Columns columns{
        {"sample", [](const SeenSample& sample, const auto&) { return sample.sample.name; }}};
    add_geometry(columns);
    add_conditions(columns, true);
    columns.push_back({"sums", [](const auto&, const SeenColour& seen) {
                           return seen.report.colour.at_nanometres ? "1 nm" : "bands";
                       }});
    NumberColumns numbers(columns, "{:.10g}");
    const auto xyz = [](const auto& of) { return of.colour.xyz; };
    const auto lab = [](const auto& of) { return of.colour.lab; };
    numbers.add_each({"X", "Y", "Z"}, whole, xyz);
    numbers.add_each({"x", "y"}, whole, [](const auto& of) { return of.colour.xy; });
    numbers.add_each({"L", "a", "b"}, whole, lab);
    numbers.add("C", [](const ColourReport& report) { return report.lch[1]; });
    numbers.add("h", [](const ColourReport& report) { return report.lch[2]; });
    numbers.add("Y_reflected",
                [](const ColourReport& report) { return report.colour.luminance_reflected; });
    numbers.add_indices({"whiteness_cie", "tint_cie", "r457", "whiteness_e313", "yellowness_e313"},
                        whole);
    numbers.add("uv_share", [](const ColourReport& report) { return report.ultraviolet_share; });
    numbers.add_each({"uv_excluded_X", "uv_excluded_Y", "uv_excluded_Z"}, without_uv, xyz);
    numbers.add_each({"uv_excluded_L", "uv_excluded_a", "uv_excluded_b"}, without_uv, lab);
    numbers.add_indices({"uv_excluded_whiteness_cie", "uv_excluded_tint_cie", "uv_excluded_r457",
                         "uv_excluded_whiteness_e313", "uv_excluded_yellowness_e313"},
                        without_uv);
    if (!options.against.empty())
        add_differences(numbers, {"cie1976", "cie1994", "ciede2000", "cmc21"});
    add_polygons(columns, options);
    return table_of(columns, samples, Empty::Kept);
}

} // namespace reradiant
