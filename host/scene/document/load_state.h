#pragma once

#include "host/scene/model/sha256.h"
#include "reradiant/error.h"
#include "reradiant/scene.h"
#include "reradiant/spectrum.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace reradiant {

class TextureScope;

/// Larger files are refused before memory is taken for them.
inline constexpr std::uintmax_t MAX_TEXT_BYTES = std::uintmax_t{64} << 20;
/// Scenes are written by hand; toml++ takes some fifty times the text's size.
inline constexpr std::uintmax_t MAX_TOML_BYTES = std::uintmax_t{16} << 20;
inline constexpr std::uintmax_t MAX_MESH_BYTES = std::uintmax_t{4} << 30;

/// Reads a whole regular file. Errors (missing, a folder, unreadable, too large) are placed at
/// `at`: the file itself for one named on the command line, the key for one named in a file.
std::string read_file(const std::filesystem::path& file, const SourcePosition& at,
                      std::uintmax_t max_bytes = MAX_TEXT_BYTES);

/// A `LoadState` gathers what one call of load_scene or load_material finds while it reads.
class LoadState {
public:
    /// Returns the file that `name` means where it stands at `at`: relative to that file's folder,
    /// then, for names without a path, in spectra/ and in the folders of spectra/. Throws an input
    /// Error at `at` when there is none.
    std::filesystem::path resolve(const std::string& name, const SourcePosition& at) const;
    /// Resolves `name` as `resolve` does and adds the bytes of the file to the digest, once however
    /// often it is named.
    std::filesystem::path resolve_and_digest(const std::string& name, const SourcePosition& at);

    void add_to_digest(const std::string& bytes);
    std::string digest() const { return digest_.hex(); }

    /// Logs a warning; a material that is read once per texture level repeats itself only once.
    void warn(const SourcePosition& at, const std::string& text);

    /// Remembers a spectrum so that use outside its data can be warned about.
    void track(const Spectrum& spectrum, const SourcePosition& at, const std::string& name);
    /// Logs one warning for each tracked spectrum whose tables do not cover [from, to].
    void warn_outside(double from_nm, double to_nm) const;

    std::vector<Texture> textures;     ///< Scene::textures
    std::vector<Image> images;         ///< Scene::images
    std::vector<bool> image_is_linear; ///< true for each image that was read as data
    /// Meshes of instances, by their file and how it is read.
    std::map<std::string, std::shared_ptr<const MeshShape>> shared_meshes;
    /// Textures that the values read now may refer to; null outside materials.
    TextureScope* texture_scope = nullptr;

private:
    struct Tracked {
        double from_nm, to_nm;
        bool is_dark_outside; ///< as a built-in illuminant is
        SourcePosition position;
        std::string name;
    };
    std::vector<Tracked> tracked_;
    std::set<std::string> digested_, warned_;
    Sha256 digest_;
};

} // namespace reradiant
