#include "host/check/probe_source.h"

#include <fmt/core.h>

namespace reradiant {

std::string probe_source(std::span<const CheckedFunction> functions) {
    std::string source = "#include \"kernels/core/portable.h\"\n"
                         "#include \"kernels/core/check_tables.h\"\n"
                         "#include \"kernels/core/random.h\"\n";
    source += fmt::format("#include \"{}\"\n", functions.front().header);
    for (std::size_t i = 0; i < functions.size(); ++i) {
        const CheckedFunction& function = functions[i];
        source += fmt::format(
            "__kernel void check_{0}(__global const float* inputs, __global real* outputs,\n"
            "                        uint count, __global const CheckTables* tables) {{\n"
            "    const uint item = (uint)get_global_id(0);\n"
            "    if (item >= count)\n"
            "        return;\n"
            "    real in[{1}], out[{2}];\n"
            "    for (uint k = 0u; k < {1}u; ++k)\n"
            "        in[k] = inputs[item * {1}u + k];\n"
            "    {{ {3} }}\n"
            "    for (uint k = 0u; k < {2}u; ++k)\n"
            "        outputs[item * {2}u + k] = out[k];\n"
            "}}\n",
            i, width_of(function.arguments), function.outputs, function.body);
    }
    return source;
}

KernelDefines probe_defines(const std::string& header, bool in_double) {
    KernelDefines defines;
    if (header == "kernels/stack/hero.h")
        defines.emplace_back("HERO", 4);
    if (in_double)
        defines.emplace_back("KERNELS_IN_DOUBLE", 1);
    return defines;
}

} // namespace reradiant
