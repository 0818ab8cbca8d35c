#include "tools/commands/figure/figure_request.h"

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"
#include "host/scene/toml/scene_table.h"
#include "tools/commands/figure/figure_names.h"
#include "tools/program/display_options.h"

#include <cmath>

namespace reradiant {

namespace {

constexpr double points_per_mm = 72.0 / 25.4;

/// Reads one FIGURE.toml from its head to its rows.
class FigureReader {
public:
    FigureReader(const toml::table& table, const std::filesystem::path& file)
        : root_(table, file.string(), "a figure", {"figure", "image", "plot", "swatches"}),
          head_(root_.has("figure") ? root_.table("figure", head_keys)
                                    : TableReader(no_head_, file.string(), "[figure]", head_keys)) {
    }

    FigureRequest request() {
        read_page();
        for (const toml::table* table : root_.tables("image"))
            read_image(*table);
        if (request_.images.empty())
            root_.fail("image", "the figure has no image", "give at least one [[image]]");
        names_.add_marks(request_);
        for (const toml::table* table : root_.tables("plot"))
            read_plot(*table);
        for (const toml::table* table : root_.tables("swatches"))
            read_swatches(*table);
        request_.rows = names_.rows(head_, request_);
        return std::move(request_);
    }

private:
    static inline const std::vector<std::string> head_keys{
        "width_mm", "font_size_pt", "gap_mm",   "dpi",   "letters",
        "caption",  "rows",         "exposure", "white", "gamut"};

    void read_page();
    void read_develop(const TableReader& reader, ImageRequest& image) const;
    void read_exposure(const TableReader& reader, ImageRequest& image) const;
    void read_image(const toml::table& table);
    void read_groups(const toml::table& table, ImageRequest& image) const;
    MarkRequest read_mark(const toml::table& table, std::size_t index) const;
    void read_plot(const toml::table& table);
    void read_swatches(const toml::table& table);

    const toml::table no_head_;
    TableReader root_, head_;
    LoadState files_;
    FigureNames names_;
    FigureRequest request_;
};

void FigureReader::read_page() {
    Figure& page = request_.page;
    page.width = points_per_mm * head_.number_or("width_mm", 170.0, NumberRange::within(20, 2000));
    page.font_size = head_.number_or("font_size_pt", 8.0, NumberRange::within(2, 100));
    page.gap = points_per_mm * head_.number_or("gap_mm", 4.0, NumberRange::within(0, 100));
    page.has_letters = head_.flag_or("letters", true);
    page.caption = head_.text_or("caption", "");
    request_.dpi = head_.number_or("dpi", 300.0, NumberRange::within(20, 2400));
}

void FigureReader::read_exposure(const TableReader& reader, ImageRequest& image) const {
    const toml::node* const node = reader.find("exposure");
    if (node == nullptr)
        return;
    image.has_shared_exposure = false;
    image.develop.auto_exposure = false;
    if (!node->is_string()) {
        image.develop.display.exposure_ev =
            reader.number("exposure", NumberRange::within(-100, 100));
        return;
    }
    // One image alone has nothing to share an exposure with.
    const bool is_head = &reader == &head_;
    const std::string word =
        reader.choice("exposure", is_head ? std::vector<std::string>{"shared", "auto"}
                                          : std::vector<std::string>{"auto"});
    image.has_shared_exposure = word == "shared";
    image.develop.auto_exposure = word == "auto";
}

void FigureReader::read_develop(const TableReader& reader, ImageRequest& image) const {
    read_exposure(reader, image);
    if (reader.has("gamut"))
        image.develop.gamut = reader.choice("gamut", {"clip", "compress"}) == "compress"
                                  ? Gamut::Compress
                                  : Gamut::Clip;
    if (reader.has("white")) {
        try {
            set_white("white", reader.text("white"), image.develop);
            check_develop(image.develop);
        } catch (const Error& error) {
            reader.fail("white", error.what());
        }
    }
}

void FigureReader::read_groups(const toml::table& table, ImageRequest& image) const {
    image.light_position = position_of(root_.file(), table);
    for (const auto& [name, factor] : table) {
        const SourcePosition position = position_of(root_.file(), name.source());
        image.light_factors[std::string(name.str())] =
            number_at(factor, position, "a factor of a light group", NumberRange::at_least(0));
    }
}

MarkRequest FigureReader::read_mark(const toml::table& table, std::size_t index) const {
    const TableReader reader(table, root_.file(), "[[image.mark]] " + std::to_string(index + 1),
                             {"name", "label", "at", "radius", "region"});
    MarkRequest mark;
    mark.position = reader.position();
    mark.name = reader.text("name");
    mark.label = reader.text_or("label", mark.name);
    if (reader.has("at") == reader.has("region"))
        reader.fail(reader.has("at") ? "region" : "name", "a mark is a place or a region",
                    "give either at = [X, Y] or region = [X0, Y0, X1, Y1]");
    if (reader.has("at")) {
        mark.region = region_at(reader, "at", 2);
        mark.region.radius = reader.number_or("radius", 0.0, NumberRange::within(0, 65536));
        widen(mark.region, static_cast<int>(std::floor(mark.region.radius)));
    } else {
        if (reader.has("radius"))
            reader.fail("radius", "a region has no radius", "leave it away, or give at = [X, Y]");
        mark.region = region_at(reader, "region", 4);
    }
    mark.region.name = mark.name;
    return mark;
}

void FigureReader::read_image(const toml::table& table) {
    const TableReader reader(
        table, root_.file(), "[[image]] " + std::to_string(request_.images.size() + 1),
        {"name", "title", "file", "groups", "exposure", "white", "gamut", "crop", "mark"});
    ImageRequest image;
    image.name = reader.text("name");
    names_.add(image.name, PanelReference::Kind::Image, request_.images.size(),
               reader.position_of_key("name"));
    image.title = reader.text_or("title", "");
    image.position = reader.position_of_key("file");
    image.file = files_.resolve(reader.text("file"), image.position);
    if (reader.has("groups"))
        read_groups(reader.plain_table("groups"), image);
    image.has_shared_exposure = true;
    read_develop(head_, image);
    read_develop(reader, image);
    if (reader.has("crop")) {
        image.crop = region_at(reader, "crop", 4);
        image.crop->name = "crop";
        image.crop_position = reader.position_of_key("crop");
    }
    const auto marks = reader.tables("mark");
    for (std::size_t k = 0; k < marks.size(); ++k)
        image.marks.push_back(read_mark(*marks[k], k));
    request_.images.push_back(std::move(image));
}

void FigureReader::read_plot(const toml::table& table) {
    const TableReader reader(
        table, root_.file(), "[[plot]] " + std::to_string(request_.plots.size() + 1),
        {"name", "title", "marks", "against", "logarithmic", "from_nm", "to_nm", "aspect"});
    PlotRequest plot;
    plot.name = reader.text("name");
    names_.add(plot.name, PanelReference::Kind::Plot, request_.plots.size(),
               reader.position_of_key("name"));
    plot.title = reader.text_or("title", "");
    plot.marks = names_.marks(reader, "marks");
    plot.against = names_.mark_or_none(reader, "against");
    plot.is_logarithmic = reader.flag_or("logarithmic", false);
    plot.from_nm = reader.number_or("from_nm", plot.from_nm, NumberRange::at_least(0));
    plot.to_nm = reader.number_or("to_nm", plot.to_nm, NumberRange::above(plot.from_nm));
    plot.aspect = reader.number_or("aspect", 0.0, NumberRange::within(0.1, 20));
    request_.plots.push_back(std::move(plot));
}

void FigureReader::read_swatches(const toml::table& table) {
    const TableReader reader(
        table, root_.file(), "[[swatches]] " + std::to_string(request_.swatches.size() + 1),
        {"name", "title", "marks", "against", "lamp", "white_luminance", "aspect"});
    SwatchRequest swatches;
    swatches.name = reader.text("name");
    names_.add(swatches.name, PanelReference::Kind::Swatches, request_.swatches.size(),
               reader.position_of_key("name"));
    swatches.title = reader.text_or("title", "");
    swatches.marks = names_.marks(reader, "marks");
    swatches.against = names_.mark_or_none(reader, "against");
    swatches.lamp = reader.text_or("lamp", "D65");
    swatches.aspect = reader.number_or("aspect", 0.0, NumberRange::within(0.1, 20));
    const double luminance = reader.number_or("white_luminance", 1.0, NumberRange::above(0));
    try {
        swatches.white = white_of_lamp("lamp", swatches.lamp, luminance);
    } catch (const Error& error) {
        reader.fail("lamp", error.what());
    }
    request_.swatches.push_back(std::move(swatches));
}

} // namespace

FigureRequest read_figure_request(const std::filesystem::path& file) {
    const toml::table table = read_scene_table(file);
    return FigureReader(table, file).request();
}

} // namespace reradiant
