#include "host/fit/dye/dye_fit.h"

#include "host/base/atomic_file.h"
#include "host/scene/toml/scene_table.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <sstream>

namespace reradiant {

namespace {

namespace fs = std::filesystem;

/// Names files from another folder, but for those that are looked up in spectra/.
void rename_files(toml::node& node, const fs::path& from, const fs::path& to) {
    if (toml::array* const array = node.as_array())
        for (toml::node& element : *array)
            rename_files(element, from, to);
    toml::table* const table = node.as_table();
    if (table == nullptr)
        return;
    for (auto&& [key, value] : *table) {
        const auto* name = value.as_string();
        if (key.str() != "file" || name == nullptr) {
            rename_files(value, from, to);
            continue;
        }
        std::error_code ignored;
        if (const fs::path there = from / name->get(); fs::exists(there, ignored))
            *value.as_string() = fs::relative(fs::absolute(there), to).string();
    }
}

toml::table spectrum_table(const WavelengthGrid& bands, const Eigen::VectorXd& values) {
    toml::array nm, value;
    for (int band = 0; band < bands.count; ++band) {
        nm.push_back(bands.centre_nm(band));
        value.push_back(values(band));
    }
    return toml::table{{"nm", nm}, {"value", value}};
}

toml::array fluorophores_of(const DyeFitResult& result, double thickness) {
    toml::array list;
    for (const FittedDye& dye : result.dyes) {
        const Eigen::VectorXd absorption =
            result.sets.front().depth_factor / thickness * dye.absorption;
        list.push_back(toml::table{{"absorption", spectrum_table(result.bands, absorption)},
                                   {"emission", spectrum_table(result.bands, dye.emission)},
                                   {"quantum_yield", dye.quantum_yield.value}});
    }
    return list;
}

} // namespace

void write_dye_material(const fs::path& file, const DyeFitResult& result, const fs::path& material,
                        std::size_t layer) {
    toml::table table = read_scene_table(material);
    rename_files(table, fs::absolute(material).parent_path(), fs::absolute(file).parent_path());
    toml::table& own = *table["material"]["layer"][layer].as_table();
    const double thickness = own["thickness"].value_or(1.0);
    own.insert_or_assign("fluorophores", fluorophores_of(result, thickness));
    std::ostringstream text;
    text << "# " << material.filename().string() << " with the dyes of `fit --dye " << layer + 1
         << "`.\n"
         << table << '\n';
    write_text_atomically(file, text.str());
}

} // namespace reradiant
