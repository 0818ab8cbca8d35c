// layer_stack's sample, pdf and values on the device, over tables of random materials: nothing but
// finite numbers, none negative, no direction that its own pdf calls impossible.
#include "host/device/buffer.h"
#include "host/device/opencl_device.h"
#include "host/device/program.h"
#include "host/render/tables/scene_tables.h"
#include "tests/render/random_materials.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <mutex>
#include <numbers>

namespace reradiant {
namespace {

using namespace test;

constexpr int lobes = 4;
constexpr std::size_t directions = 64, inputs = 9, outputs = 6;

/// in: wo, wi, u0, u1, u2; out: pdf of wi, sum of the components' values there, sampled direction's
/// z (0 for the mirror), its pdf, its length, 1 for the mirror.
constexpr const char* source = R"(
#include "kernels/stack/layer_stack.h"
__kernel void triple(__global const float* in, __global float* out, uint count,
                     __global const MaterialRecord* materials, __global const LayerRecord* layers,
                     __global const LobeRecord* lobes, __global const float* tables,
                     uint directions) {
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    in += 9u * i;
    out += 6u * i;
    const MaterialRecord record = materials[i / directions];
    const LayerStackView stack = {record, layers + record.first_layer, lobes + record.first_lobe,
                                  tables};
    const Vec3 wo = vec3(in[0], in[1], in[2]), wi = vec3(in[3], in[4], in[5]);
    const LayerChoice choice = layer_stack_choice(stack, wo.z);
    out[0] = layer_stack_pdf(stack, &choice, wo, wi);
    out[1] = layer_stack_diffuse(stack, wi, wo).diffuse;
    if (record.has_top_lobe)
        out[1] += layer_stack_top(stack, wi, wo);
    for (uint l = 0u; l < record.lobe_count; ++l)
        out[1] += layer_stack_deeper(stack, l, wi, wo);
    int is_delta;
    const Vec3 w = layer_stack_sample(stack, &choice, wo, in[6], in[7], in[8], &is_delta);
    out[2] = is_delta ? 0.0f : w.z;
    out[3] = !is_delta && w.z > 0.0f ? layer_stack_pdf(stack, &choice, wo, w) : 0.0f;
    out[4] = sqrt(vec3_dot(w, w));
    out[5] = (float)is_delta;
}
)";

void push_direction(RandomMaterials& random, std::vector<float>& values) {
    const double z =
        random.chance(0.3) ? std::pow(10.0, random.uniform(-7.0, 0.0)) : random.uniform(1e-6, 1.0);
    const double phi = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double s = std::sqrt((1.0 - z) * (1.0 + z));
    for (const double v : {s * std::cos(phi), s * std::sin(phi), z})
        values.push_back(static_cast<float>(v));
}

/// Numbers in [0, 1), often the first or the last ones.
void push_uniform(RandomMaterials& random, std::vector<float>& values) {
    const double u = random.edge_or_between({0.0, 0x1p-24, 1.0 - 0x1p-24});
    values.push_back(std::min(static_cast<float>(u), 1.0f - 0x1p-24f));
}

/// Tables of `count` materials that the model takes.
SceneTables random_tables(RandomMaterials& random, Model model, int count) {
    SceneTables tables;
    WavelengthOptions options;
    options.centred = true;
    Scene scene = plane_scene(material({}, 0.5), 0.0, 1, 1);
    scene.lights = {environment(Spectrum::constant(1.0))};
    const WavelengthPlan plan = plan_wavelengths(scene, grid_from_range(450, 650, 100), options);
    RenderFeatures features;
    features.lobes = lobes;
    while (static_cast<int>(tables.materials.size()) < count) {
        try {
            const Material taken = random.material();
            const MaterialPlan planned = plan_material(taken, {model, ""}, plan);
            append_material(taken, planned, plan, features, MaterialOptics(taken, model, plan),
                            tables);
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2) << error.what();
        }
    }
    return tables;
}

std::vector<float> evaluated(const SceneTables& tables, const std::vector<float>& input) {
    static const cl::Program program =
        build_program_from_text(device(), "random materials", source,
                                {{"LOBES", lobes}, {"FEATURE_WALK", 0}, {"FEATURE_SHEETS", 0}});
    static std::mutex one_at_a_time;
    const std::scoped_lock lock(one_at_a_time);
    const std::size_t count = input.size() / inputs;
    const DeviceArray<float> in(device(), std::span<const float>(input));
    const DeviceArray<float> out(device(), count * outputs);
    const DeviceArray<MaterialRecord> materials(device(), std::span(tables.materials));
    const DeviceArray<LayerRecord> layers(device(), std::span(tables.layers));
    const DeviceArray<LobeRecord> lobe_records(device(), std::span(tables.lobes));
    const DeviceArray<float> numbers(device(), std::span(tables.tables));
    Kernel kernel(program, "triple", 16);
    kernel.bind(in.buffer(), out.buffer(), static_cast<cl_uint>(count), materials.buffer(),
                layers.buffer(), lobe_records.buffer(), numbers.buffer(),
                static_cast<cl_uint>(directions));
    kernel.launch(device(), count);
    const auto mapped = out.map(CL_MAP_READ, 0, count * outputs);
    return {mapped.span().begin(), mapped.span().end()};
}

void expect_sound(const SceneTables& tables, RandomMaterials& random) {
    std::vector<float> input;
    for (std::size_t i = 0; i < tables.materials.size() * directions; ++i) {
        push_direction(random, input);
        push_direction(random, input);
        for (int k = 0; k < 3; ++k)
            push_uniform(random, input);
    }
    const std::vector<float> found = evaluated(tables, input);
    for (std::size_t i = 0; i < found.size() / outputs; ++i) {
        const float* const value = found.data() + i * outputs;
        const std::string where = "material " + std::to_string(i / directions) + ", direction " +
                                  std::to_string(i % directions);
        for (std::size_t k = 0; k < outputs; ++k)
            ASSERT_TRUE(std::isfinite(value[k])) << "output " << k << ", " << where;
        ASSERT_GE(value[0], 0.0f) << where;
        ASSERT_GE(value[1], 0.0f) << where;
        ASSERT_NEAR(value[4], 1.0f, 1e-5f) << where;
        const bool goes_on = value[5] == 0.0f && value[2] > 0.0f;
        ASSERT_TRUE(!goes_on || value[3] > 0.0f) << "a direction of probability 0, " << where;
    }
}

/// A million materials in a full run.
TEST(RandomMaterials, SampleAndPdfOnTheDeviceStaySound) {
    const int batches = test::is_full_run() ? 250 : 2, materials = test::is_full_run() ? 4000 : 150;
    tbb::parallel_for(0, batches, [&](int batch) {
        RandomMaterials random(static_cast<unsigned>(31 + batch), 1);
        const Model model = batch % 2 == 0 ? Model::WeidlichWilkie : Model::Adding;
        expect_sound(random_tables(random, model, materials), random);
    });
}

} // namespace
} // namespace reradiant
