// These tests show that what a scene does not need costs nothing, and that edits of numbers build
// nothing.
#include "host/device/opencl_device.h"
#include "host/device/program.h"
#include "host/render/plan/render_features.h"
#include "reradiant/reradiation.h"
#include "tests/render/kernel_sizes.h"
#include "tests/render/test_scenes.h"
#include "tests/support/full_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace reradiant {
namespace {

using namespace test;

Scene lit_scene(const Material& material) {
    Scene scene = sphere_scene(material, 12, 9);
    scene.lights = {environment(Spectrum::constant(0.3)),
                    RectangleLight{{0, 4, 1}, {2, 0, 0}, {0, 0, 2}, Spectrum::constant(5.0)}};
    return scene;
}

RenderResult rendered(const Scene& scene, bool all_features = false) {
    RenderOptions options;
    options.samples = 8;
    options.bands = grid_from_range(400, 700, 20);
    options.all_features = all_features;
    return render(scene, device(), options);
}

TEST(LeavingOut, Case23ZeroMatrixIsThePlainPathBitForBit) {
    ReradiationMatrix matrix = shifted_matrix();
    matrix.values = matrix.values.diagonal().asDiagonal().toDenseMatrix();
    for (const std::vector<Layer>& layers :
         {std::vector<Layer>{}, {layer(1.5)}, {layer(1.5, 0.2, 0.1)}}) {
        const RenderResult plain = rendered(lit_scene(material(layers, 0.3)));
        const RenderResult zero = rendered(lit_scene(fluorescent(layers, matrix)));
        EXPECT_FALSE(zero.features.at("fluorescence"));
        EXPECT_FALSE(zero.features.at("dense_matrix"));
        EXPECT_EQ(zero.image.values, plain.image.values) << layers.size() << " layers";
        EXPECT_EQ(zero.device_bytes, plain.device_bytes);
    }
}

TEST(LeavingOut, Case43EditsOfNumbersBuildNoKernel) {
    Scene scene = lit_scene(fluorescent({layer(1.5, 0.2, 0.4)}, shifted_matrix()));
    const RenderResult before = rendered(scene);
    EXPECT_EQ(before.build.built + before.build.from_cache, 4);
    scene.camera.fov_deg = 20.0;
    scene.camera.origin[1] = 0.5;
    scene.integrator.max_depth = 3;
    scene.film.width = 7;
    scene.lights.back() = RectangleLight{{1, 4, 1}, {1, 0, 0}, {0, 0, 1}, Spectrum::constant(2.0)};
    Material& edited = scene.materials.front();
    edited.stack.layers.front().absorption = Spectrum::constant(0.1);
    ReradiationMatrix matrix = *edited.substrate.matrix;
    matrix.values *= 0.5;
    edited.substrate.matrix = std::make_shared<const ReradiationMatrix>(matrix);
    edited.substrate.reflectance = edited.substrate.matrix->reflectance();
    const RenderResult result = rendered(scene);
    EXPECT_EQ(result.build.built, 0);
    EXPECT_EQ(result.build.from_cache, 4);
}

TEST(LeavingOut, WhatIsOffTakesNoBuffersTablesOrBands) {
    const RenderResult some = rendered(lit_scene(material({}, 0.3)));
    const RenderResult all = rendered(lit_scene(material({}, 0.3)), true);
    EXPECT_LT(some.device_bytes, all.device_bytes);
    EXPECT_LT(some.build.binary_bytes,
              all.build.binary_bytes * 3 / 5); // rays, sums and numbers are left
    for (const char* name : {"fluorescence", "dense_matrix", "spectral_stack", "smooth", "rough",
                             "deeper_lobes", "walk", "textures", "lens"})
        EXPECT_FALSE(some.features.at(name)) << name;
    // every bit that is off says why, and the wavelength sampling that is not used
    const auto off = std::count_if(some.features.begin(), some.features.end(),
                                   [](const auto& feature) { return !feature.second; });
    EXPECT_GE(some.left_out.size(), static_cast<std::size_t>(off));
}

TEST(LeavingOut, AllFeaturesGiveTheSameImage) {
    for (const Material& look :
         {material({}, 0.5), material({layer(1.5)}, 0.5), material({layer(1.5, 0.2, 0.3)}, 0.5),
          fluorescent({layer(1.5)}, shifted_matrix())}) {
        const RenderResult some = rendered(lit_scene(look)), all = rendered(lit_scene(look), true);
        // the same samples: only roundings differ
        for (std::size_t i = 0; i < some.image.values.size(); ++i)
            EXPECT_NEAR(all.image.values[i], some.image.values[i],
                        1e-4f * (some.image.values[i] + 0.1f));
    }
}

/// Bytes of all programs under some defines.
std::size_t program_bytes(const KernelDefines& defines) {
    BuildStatistics statistics;
    for (const char* file :
         {"kernels/generate.cl", "kernels/shade.cl", "kernels/gather.cl", "kernels/film.cl"})
        build_program(device(), file, defines, &statistics);
    return statistics.binary_bytes;
}

TEST(LeavingOut, EveryBitAddsCodeAndNoneLeavesAnyWhenOff) {
    // what the bit itself stands on, else it has nothing to do
    const std::map<std::string, std::vector<std::string>> needs = {
        {"FEATURE_DENSE_MATRIX", {"FEATURE_FLUORESCENCE"}},
        {"FEATURE_DISPERSION", {"FEATURE_ROUGH"}},
        {"FEATURE_TABULATED_REFLECTANCE", {"FEATURE_ROUGH"}},
        {"FEATURE_WEIDLICH_WILKIE", {"FEATURE_DEEPER_LOBES"}},
        {"FEATURE_SCATTERING_SLABS", {"FEATURE_DEEPER_LOBES", "FEATURE_WEIDLICH_WILKIE"}},
        {"FEATURE_WALKED_DYES", {"FEATURE_WALK", "FEATURE_SCATTERING_SLABS"}},
        {"FEATURE_SHAPED_LIGHTS", {"FEATURE_AREA_LIGHTS"}},
        {"FEATURE_NESTED_MIXTURES", {"FEATURE_TEXTURES"}},
        {"FEATURE_BAND_VARIANCE", {"FEATURE_SCATTER"}}};
    RenderFeatures none;
    none.lobes = 1;
    const auto with = [&](const std::vector<std::string>& on) {
        KernelDefines defines = none.defines();
        for (auto& [name, value] : defines)
            if (std::find(on.begin(), on.end(), name) != on.end())
                value = 1;
        return defines;
    };
    const std::vector<std::string> few = {"FEATURE_FLUORESCENCE", "FEATURE_SMOOTH", "FEATURE_LENS"};
    for (const auto& [name, value] : none.defines()) {
        if (name.rfind("FEATURE_", 0) != 0)
            continue;
        std::vector<std::string> on =
            needs.contains(name) ? needs.at(name) : std::vector<std::string>{};
        const KernelDefines before = with(on);
        on.push_back(name);
        EXPECT_GT(preprocessed_bytes(RERADIANT_SOURCE_DIR, with(on)),
                  preprocessed_bytes(RERADIANT_SOURCE_DIR, before))
            << name;
        if (std::find(few.begin(), few.end(), name) == few.end() && !test::is_full_run())
            continue;
        // The compiler may make a little less of more code, by what it then inlines (0.4 % less
        // with LLVM 18 for one bit): the program does not shrink by more than that.
        EXPECT_GT(1.02 * static_cast<double>(program_bytes(with(on))),
                  static_cast<double>(program_bytes(before)))
            << name;
    }
}

/// Kernels without double precision constants or types build where double is switched off.
TEST(BadDevice, NoDoubleIsNeededByAnyKernel) {
    RenderFeatures features = RenderFeatures::all();
    features.film_chunks = features.chunks;
    for (const char* file :
         {"kernels/generate.cl", "kernels/shade.cl", "kernels/gather.cl", "kernels/film.cl"}) {
        const std::string source = kernel_source(RERADIANT_SOURCE_DIR, file, features.defines());
        const cl::Program program(device().opencl().context,
                                  "#pragma OPENCL EXTENSION cl_khr_fp64 : disable\n" + source);
        try {
            program.compile("-cl-std=CL1.2 -Werror");
        } catch (const cl::Error&) {
            ADD_FAILURE() << file << '\n'
                          << program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device().opencl().handle);
        }
    }
}

TEST(BadDevice, Case38KernelsTakeNoLocalMemory) {
    RenderFeatures features = RenderFeatures::all();
    features.film_chunks = features.chunks;
    for (const auto& [file, name] : {std::pair{"kernels/generate.cl", "generate"},
                                     {"kernels/film.cl", "film"},
                                     {"kernels/shade.cl", "shade"},
                                     {"kernels/gather.cl", "gather"}}) {
        const Kernel kernel(build_program(device(), file, features.defines()), name, 8);
        EXPECT_EQ(
            kernel.handle().getWorkGroupInfo<CL_KERNEL_LOCAL_MEM_SIZE>(device().opencl().handle),
            0U)
            << name;
    }
}

} // namespace
} // namespace reradiant
