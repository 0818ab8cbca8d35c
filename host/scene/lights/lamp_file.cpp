#include "host/scene/lights/lamp_file.h"

#include "host/scene/toml/scene_table.h"
#include "host/scene/toml/spectrum_reader.h"

namespace reradiant {

Lamp read_lamp_file(const std::filesystem::path& file) {
    if (file.extension() != ".toml")
        return read_lamp(file);
    const toml::table table = read_scene_table(file);
    LoadState state;
    const TableReader reader(table, file.string(), "a lamp's file", {"spectrum"});
    const Spectrum light = read_spectrum_key(reader, "spectrum", SpectrumLimits::emission(), state);
    return lamp_of_spectrum(file.filename().string(), light, reader.position_of_key("spectrum"));
}

} // namespace reradiant
