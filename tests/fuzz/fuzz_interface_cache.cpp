#include "host/layers/rough/interface_file.h"
#include "host/layers/rough/interface_operator.h"
#include "tests/fuzz/fuzz_input.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>

// The disk cache of rough interfaces. A whole file is 130 KB, so an input is a patch of one: four
// bytes of where to cut it (beyond its end: nowhere), then five bytes an edit, place and value.

using namespace reradiant;

namespace {

/// As many as an operator has.
constexpr std::size_t count = 4 * interface_cells * interface_cells + interface_cells;

struct Whole {
    InterfaceKey key{InterfaceNumbers::Operator, {.eta = 1.5, .alpha = 0.25}, 15000};
    std::string bytes;

    Whole() {
        const auto file = fuzz::folder() / "whole.bin";
        write_interface_file(file, key, std::vector<double>(count, 0.5));
        std::ifstream stream(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
};

std::uint32_t number_at(const std::uint8_t* bytes) {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes, sizeof number);
    return number;
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    static const Whole whole;
    std::string patched = whole.bytes;
    for (std::size_t edit = 4; edit + 5 <= size; edit += 5)
        patched[number_at(bytes + edit) % patched.size()] = static_cast<char>(bytes[edit + 4]);
    if (size >= 4)
        patched.resize(
            std::min<std::size_t>(number_at(bytes) % (2 * patched.size()), patched.size()));
    const auto file = fuzz::put("interface.bin", patched);
    const bool read = read_interface_file(file, whole.key, count).has_value();
    if (read != (patched == whole.bytes))
        fuzz::fail(read ? "a damaged file was taken" : "a whole file was refused");
    return 0;
}
