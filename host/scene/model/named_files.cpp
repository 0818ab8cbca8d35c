#include "host/scene/model/named_files.h"

#include <mutex>
#include <set>

namespace reradiant {

namespace {

struct NamedFiles {
    std::mutex mutex;
    std::set<std::filesystem::path> files;
};

NamedFiles& remembered() {
    static NamedFiles named;
    return named;
}

} // namespace

void remember_named_file(const std::filesystem::path& file) {
    NamedFiles& named = remembered();
    const std::scoped_lock lock(named.mutex);
    named.files.insert(file);
}

std::vector<std::filesystem::path> named_files() {
    NamedFiles& named = remembered();
    const std::scoped_lock lock(named.mutex);
    return {named.files.begin(), named.files.end()};
}

} // namespace reradiant
