#include "host/scene/document/load_state.h"

#include "host/base/logging.h"
#include "host/scene/model/named_files.h"
#include "reradiant/paths.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// spectra/ and the folders in it, in the order of their names.
std::vector<fs::path> spectra_folders() {
    std::vector<fs::path> folders;
    std::error_code ignored;
    const fs::path root = spectra_directory();
    for (fs::directory_iterator entry(root, ignored), end; entry != end; entry.increment(ignored))
        if (entry->is_directory(ignored))
            folders.push_back(entry->path());
    std::sort(folders.begin(), folders.end());
    folders.insert(folders.begin(), root);
    return folders;
}

} // namespace

std::string read_file(const fs::path& file, const SourcePosition& at, std::uintmax_t max_bytes) {
    const auto fail = [&](const std::string& why, const std::string& remedy) {
        throw_input_error(at, fmt::format("cannot read \"{}\": {}", file.string(), why), remedy);
    };
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (!fs::exists(status))
        fail("no such file", "give the name of an existing file");
    if (!fs::is_regular_file(status))
        fail("it is not a regular file", "give the name of a file");
    const std::uintmax_t size = fs::file_size(file, failure);
    if (failure)
        fail(failure.message(), "check its permissions");
    if (size > max_bytes)
        fail(fmt::format("it has {} bytes", size), fmt::format("at most {} are read", max_bytes));
    std::ifstream stream(file, std::ios::binary);
    std::string bytes(size, '\0');
    if (!stream || !stream.read(bytes.data(), static_cast<std::streamsize>(size)))
        fail("it cannot be opened or read to its end", "check its permissions");
    return bytes;
}

fs::path LoadState::resolve(const std::string& name, const SourcePosition& at) const {
    const fs::path given(name);
    if (name.empty())
        throw_input_error(at, "the file name is empty", "give a file name");
    const fs::path beside = fs::path(at.file).parent_path() / given;
    if (is_file(beside)) {
        remember_named_file(beside);
        return beside;
    }
    std::vector<std::string> tried{beside.string()};
    if (given == given.filename()) {
        for (const fs::path& folder : spectra_folders()) {
            if (is_file(folder / given))
                return folder / given;
            tried.push_back((folder / given).string());
        }
    }
    throw_input_error(at, fmt::format("cannot open \"{}\": no such file", name),
                      fmt::format("looked for {}", fmt::join(tried, ", ")));
}

fs::path LoadState::resolve_and_digest(const std::string& name, const SourcePosition& at) {
    fs::path file = resolve(name, at);
    if (digested_.insert(file.string()).second)
        add_to_digest(read_file(file, at));
    return file;
}

void LoadState::add_to_digest(const std::string& bytes) {
    // The length keeps two files apart from one that holds both.
    digest_.update(fmt::format("{}:", bytes.size()));
    digest_.update(bytes);
}

void LoadState::warn(const SourcePosition& at, const std::string& text) {
    if (warned_.insert(at.text() + text).second)
        logging::warn("{}: {}", at.text(), text);
}

void LoadState::track(const Spectrum& spectrum, const SourcePosition& at, const std::string& name) {
    const auto same = [&](const Tracked& other) {
        return other.name == name && other.position.text() == at.text();
    };
    if (std::any_of(tracked_.begin(), tracked_.end(), same))
        return;
    const double from = spectrum.data_from_nm(), to = spectrum.data_to_nm();
    const bool is_dark = spectrum(from - 1.0) == 0.0 && spectrum(to + 1.0) == 0.0;
    tracked_.push_back({from, to, is_dark, at, name});
}

void LoadState::warn_outside(double from_nm, double to_nm) const {
    for (const Tracked& spectrum : tracked_)
        if (spectrum.from_nm > from_nm || spectrum.to_nm < to_nm)
            logging::warn("{}: {} has data from {} to {} nm but is used from {} to {} nm; {}",
                          spectrum.position.text(), spectrum.name, spectrum.from_nm, spectrum.to_nm,
                          from_nm, to_nm,
                          spectrum.is_dark_outside ? "it is dark outside"
                                                   : "its end values are kept outside");
}

} // namespace reradiant
