#include "host/view/page_lamps.h"

#include "host/film/lamp_cells.h"
#include "host/view/tables/model_tables.h"
#include "reradiant/spectral_image.h"

#include <algorithm>

namespace reradiant {

using Json = nlohmann::ordered_json;

namespace {

/// Lamps that every page has: daylight, bulb, tubes, diodes, ultraviolet lamps.
constexpr const char* usual_lamps[] = {"D65",    "D50",    "A",        "FL2",      "FL11",
                                       "LED-B3", "LED-V1", "L:365:10", "L:405:10", "E"};

Json lamp_json(const Lamp& lamp) {
    return {{"name", lamp.name}, {"values", encoded_floats(lamp_cell_means(lamp.light))}};
}

} // namespace

Json lamps_json(const std::vector<Lamp>& lamps) {
    Json list = Json::array();
    for (const Lamp& lamp : lamps)
        list.push_back(lamp_json(lamp));
    for (const char* name : usual_lamps)
        if (std::none_of(lamps.begin(), lamps.end(),
                         [&](const Lamp& lamp) { return lamp.name == name; }))
            list.push_back(lamp_json(lamp_from_text(name)));
    return list;
}

} // namespace reradiant
