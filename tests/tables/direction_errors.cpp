// Directions of light by adding, against the random walk: the BRRDF of every preset that adding
// takes and does not find smooth, and of single rough coats, at 0/0 to 80/80 degrees and all
// azimuths, as a Markdown table. Arguments: names of presets, or `coats`; none: all of them.
#include "reradiant/measure.h"
#include "reradiant/paths.h"
#include "reradiant/scene_file.h"
#include "reradiant/stack_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

using namespace reradiant;

namespace {

const WavelengthGrid band{540, 10, 1};
constexpr long paths = 1L << 16U;

struct Sum {
    double value = 0.0, variance = 0.0;
};
/// What the substrate sends into one pair of directions, and all else.
using Parts = std::array<Sum, 2>;
constexpr std::size_t specular = 1;
using Geometry = std::array<double, 3>; ///< theta_i, theta_o, phi
using Values = std::map<Geometry, Parts>;

Values measured(const Material& material, Model model) {
    MeasureRequest request;
    request.model = model;
    request.bands = band;
    request.samples = paths;
    request.theta_i_deg = request.theta_o_deg = {0, 20, 40, 60, 75, 80};
    request.phi_deg = {0, 30, 60, 90, 120, 150, 170, 180};
    Values values;
    for (const MeasureRow& row : measure_material(material, request).rows) {
        Sum& sum = values[{row.theta_i_deg, row.theta_o_deg, row.phi_deg}]
                         [row.part == MeasuredPart::Diffuse ? 0 : specular];
        sum.value += row.value;
        sum.variance += row.standard_error * row.standard_error;
    }
    return values;
}

/// The walk's specular part is taken from the more grazing of the two directions, by reciprocity:
/// from the other one rare paths of large weight hide from its standard error.
const Sum& specular_of(const Values& walk, const Geometry& g) {
    return walk.at(g[0] >= g[1] ? g : Geometry{g[1], g[0], g[2]})[specular];
}

void print_row(const std::string& name, const Material& material) {
    const Values walk = measured(material, Model::Walk), adding = measured(material, Model::Adding);
    int beyond = 0;
    double sum = 0.0, errors = 0.0, worst = 0.0;
    Geometry where{};
    for (const auto& [geometry, parts] : walk) {
        const Sum& rest = specular_of(walk, geometry);
        const double truth = parts[0].value + rest.value;
        const double error = std::sqrt(parts[0].variance + rest.variance);
        const Parts& own = adding.at(geometry);
        const double difference = std::fabs(own[0].value + own[1].value - truth);
        sum += difference / truth;
        errors += error / truth;
        if (difference <= 0.01 * truth || difference <= 3.0 * error)
            continue;
        ++beyond;
        if (difference / truth > worst) {
            worst = difference / truth;
            where = geometry;
        }
    }
    const auto count = static_cast<double>(walk.size());
    fmt::print("| {} | {} | {:.2f} % | {} | {:.2f} % |\n", name, beyond, 100.0 * sum / count,
               beyond > 0 ? fmt::format("{:.1f} % at {}, {}, {}", 100.0 * worst, where[0], where[1],
                                        where[2])
                          : "-",
               100.0 * errors / count);
    std::fflush(stdout);
}

bool is_rough(const LayerStack& stack) {
    return std::any_of(stack.layers.begin(), stack.layers.end(),
                       [](const Layer& layer) { return layer.alpha > 0.0; });
}

void print_preset(const std::string& name) {
    const Material material = load_material(spectra_directory() / "materials" / (name + ".toml"));
    if (material.substrate.type != SubstrateType::Conductor && is_rough(material.stack) &&
        !adding_refusal(material.stack))
        print_row(name, material);
}

void print_coats() {
    for (const Distribution distribution : {Distribution::Ggx, Distribution::Beckmann})
        for (const double alpha : {0.1, 0.3, 0.6})
            for (const double ior : {1.5, 2.2}) {
                Material material;
                Layer coat;
                coat.ior = Spectrum::constant(ior);
                coat.alpha = alpha;
                coat.distribution = distribution;
                material.stack.layers = {coat};
                material.substrate.reflectance = Spectrum::constant(0.1);
                print_row(fmt::format("{} {}, n {}, over 0.1",
                                      distribution == Distribution::Ggx ? "ggx" : "beckmann", alpha,
                                      ior),
                          material);
            }
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> names(argv + 1, argv + argc);
    if (names.empty()) {
        names = preset_names();
        names.emplace_back("coats");
    }
    fmt::print(
        "Of 288 pairs of directions at {} nm, how many are off by more than 1 % and 3 standard "
        "errors of the walk; means are over all pairs.\n\n"
        "| material | beyond | mean difference | worst of those beyond | mean s.e. of the walk "
        "|\n| --- | --- | --- | --- | --- |\n",
        band.from_nm);
    for (const std::string& name : names) {
        if (name == "coats")
            print_coats();
        else
            print_preset(name);
    }
    return 0;
}
