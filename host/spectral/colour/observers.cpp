#include "reradiant/colour_of_matrix.h"

#include "host/spectral/text/number_table.h"
#include "reradiant/paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace reradiant {

namespace {

struct ObserverTable {
    Observer observer;
    const char* name; ///< as users write it
    const char* file; ///< in spectra/observers
};

/// In the order of Observer.
constexpr std::array observers = {
    ObserverTable{Observer::Cie1931Deg2, "1931-2", "cie-1931-2-degree.csv"},
    ObserverTable{Observer::Cie1964Deg10, "1964-10", "cie-1964-10-degree.csv"},
    ObserverTable{Observer::Cie2015Deg2, "2015-2", "cie-2015-2-degree.csv"},
    ObserverTable{Observer::Cie2015Deg10, "2015-10", "cie-2015-10-degree.csv"}};

const ObserverTable& table_of(Observer observer) {
    return observers[static_cast<std::size_t>(observer)];
}

template <Observer observer>
const ColourMatching& table_read_once() {
    static const ColourMatching table = [] {
        NumberTable read =
            read_number_table(spectra_directory() / "observers" / table_of(observer).file, 4);
        return ColourMatching{std::move(read.columns[0]), std::move(read.columns[1]),
                              std::move(read.columns[2]), std::move(read.columns[3])};
    }();
    return table;
}

} // namespace

const ColourMatching& colour_matching(Observer observer) {
    switch (observer) {
    case Observer::Cie1964Deg10:
        return table_read_once<Observer::Cie1964Deg10>();
    case Observer::Cie2015Deg2:
        return table_read_once<Observer::Cie2015Deg2>();
    case Observer::Cie2015Deg10:
        return table_read_once<Observer::Cie2015Deg10>();
    case Observer::Cie1931Deg2:
        break;
    }
    return table_read_once<Observer::Cie1931Deg2>();
}

const ColourMatching& cie_1931_2_degree() {
    return colour_matching(Observer::Cie1931Deg2);
}

Observer observer_named(const std::string& name) {
    const auto* const found =
        std::find_if(observers.begin(), observers.end(),
                     [&](const ObserverTable& table) { return name == table.name; });
    if (found == observers.end())
        throw std::invalid_argument(fmt::format(
            "there is no observer '{}'; there are 1931-2, 1964-10, 2015-2, 2015-10", name));
    return found->observer;
}

std::string observer_name(Observer observer) {
    return table_of(observer).name;
}

bool is_10_degree(Observer observer) {
    return observer == Observer::Cie1964Deg10 || observer == Observer::Cie2015Deg10;
}

} // namespace reradiant
