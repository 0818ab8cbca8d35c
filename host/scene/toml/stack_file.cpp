#include "host/scene/toml/stack_file.h"

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"
#include "host/scene/model/textured_value.h"
#include "host/scene/toml/scene_table.h"
#include "host/scene/toml/stack_reader.h"
#include "reradiant/scene_file.h"

namespace reradiant {

namespace {

/// Layers alone are looked through, to a substrate beneath them.
void refuse_sheets(const TableReader& material) {
    const toml::node* substrate = material.find("substrate");
    const toml::table* table = substrate == nullptr ? nullptr : substrate->as_table();
    const bool is_none = table != nullptr && (*table)["type"].value_or("") == std::string("none");
    if (material.has("back") || is_none)
        material.fail(material.has("back") ? "back" : "substrate",
                      "the layers are those of a sheet, which has no substrate to look through to",
                      "give layers that lie on a substrate");
}

/// What dyes send out is not the substrate's light, and is not taken away from it.
void refuse_dyes(const Layer& layer, const toml::table& table, const std::string& file) {
    if (layer.is_dyed())
        throw_input_error(position_of(file, table.find("fluorophores")->first.source()),
                          "dyes in layers send out light of their own, and what lies beneath them "
                          "cannot be told from it",
                          "give layers without fluorophores");
}

} // namespace

LayerStack load_stack(const std::filesystem::path& file) {
    return stack_from_table(read_scene_table(file), file);
}

LayerStack stack_from_table(const toml::table& table, const std::filesystem::path& file) {
    LoadState state;
    const TableReader root(table, file.string(), "a stack file", {"material", "texture"});
    const TableReader material =
        root.table("material", {"name", "model", "layer", "substrate", "back", "normal", "mix"});
    TextureScope textures(root, state);
    state.texture_scope = &textures;
    const auto layers = material.tables("layer");
    if (layers.empty())
        material.fail("layer", "the stack has no layer", "give at least one [[material.layer]]");
    LayerStack stack;
    refuse_sheets(material);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        stack.layers.push_back(read_layer(*layers[i], root.file(), i, state));
        refuse_dyes(stack.layers.back(), *layers[i], root.file());
    }
    return stack;
}

} // namespace reradiant
