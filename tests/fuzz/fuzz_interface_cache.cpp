#include "host/layers/rough/interface_file.h"
#include "tests/fuzz/fuzz_input.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>

// The disk cache of rough interfaces. A whole file is 130 KB, so an input is a patch of one: four
// bytes of where to cut it (beyond its end: nowhere), then five bytes an edit, place and value.

using namespace reradiant;

namespace {

constexpr long eta_1e4 = 15000;

struct Whole {
    RoughInterface interface;
    std::string bytes;

    Whole() {
        interface.eta = 1.5;
        interface.alpha = 0.25;
        InterfaceOperator op = empty_interface_operator(interface);
        op.exchange.setConstant(2 * interface_cells, 2 * interface_cells, 0.5);
        op.first_lobe.setConstant(interface_cells, 0.25);
        const auto file = fuzz::folder() / "whole.bin";
        write_interface_file(file, op, eta_1e4);
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
    const bool read = read_interface_file(file, whole.interface, eta_1e4).has_value();
    if (read != (patched == whole.bytes))
        fuzz::fail(read ? "a damaged file was taken" : "a whole file was refused");
    return 0;
}
