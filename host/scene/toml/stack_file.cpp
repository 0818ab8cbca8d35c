#include "host/scene/toml/stack_file.h"

#include "host/scene/document/load_state.h"
#include "host/scene/document/table_reader.h"
#include "host/scene/model/textured_value.h"
#include "host/scene/toml/scene_table.h"
#include "host/scene/toml/stack_reader.h"
#include "reradiant/scene_file.h"

namespace reradiant {

LayerStack load_stack(const std::filesystem::path& file) {
    return stack_from_table(read_scene_table(file), file);
}

LayerStack stack_from_table(const toml::table& table, const std::filesystem::path& file) {
    LoadState state;
    const TableReader root(table, file.string(), "a stack file", {"material", "texture"});
    const TableReader material =
        root.table("material", {"name", "model", "layer", "substrate", "normal", "mix"});
    TextureScope textures(root, state);
    state.texture_scope = &textures;
    const auto layers = material.tables("layer");
    if (layers.empty())
        material.fail("layer", "the stack has no layer", "give at least one [[material.layer]]");
    LayerStack stack;
    for (std::size_t i = 0; i < layers.size(); ++i)
        stack.layers.push_back(read_layer(*layers[i], root.file(), i, state));
    return stack;
}

} // namespace reradiant
