#include "tests/tools/program_runner.h"

#include "reradiant/colour.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

namespace reradiant {

namespace {

using Json = nlohmann::json;

/// A patch of a fluorescent material beneath a varnish that fills the picture, lit at 45 degrees
/// from the left and seen from above. By the walk, so that it is noisy.
const std::string varnished = "  [[material.layer]]\n"
                              "  ior = 1.5\n"
                              "  [material.substrate]\n"
                              "  type = \"lambert\"\n"
                              "  reradiation = { file = \"dye.csv\" }\n";
const std::string patch_scene = "[film]\n"
                                "width = 16\n"
                                "height = 16\n"
                                "bands_nm = { from = 400, to = 700, step = 50 }\n"
                                "[camera]\n"
                                "origin = [0, 0, 100]\n"
                                "target = [0, 0, 0]\n"
                                "fov_deg = 0.5\n"
                                "[[light]]\n"
                                "type = \"directional\"\n"
                                "direction = [1, 0, -1]\n"
                                "irradiance = 1.0\n"
                                "[[shape]]\n"
                                "type = \"rectangle\"\n"
                                "center = [0, 0, 0]\n"
                                "edge_u = [10, 0, 0]\n"
                                "edge_v = [0, 10, 0]\n"
                                "material = \"patch\"\n"
                                "[[material]]\n"
                                "name = \"patch\"\n"
                                "model = \"walk\"\n" +
                                varnished;
const std::string dye = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                        "nm,400,450,500,550,600,650,700\n"
                        "400,0.1,0,0,0,0,0,0\n"
                        "450,0.05,0.1,0,0,0,0,0\n"
                        "500,0.05,0.05,0.1,0,0,0,0\n"
                        "550,0.2,0.2,0.2,0.2,0,0,0\n"
                        "600,0.2,0.2,0.25,0.1,0.7,0,0\n"
                        "650,0.05,0.05,0.05,0.05,0,0.8,0\n"
                        "700,0,0,0,0,0,0,0.8\n";

class DevelopAndProbe : public ProgramTest {
protected:
    /// Left half orange beyond what sRGB shows, right half grey.
    void write_halves() const {
        SpectralImage image = flat_image(12, 8, grid_from_range(400, 700, 20), 0.4f);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 6; ++x)
                for (int band = 0; band < image.bands.count; ++band)
                    image.at(x, y, band) = image.bands.centre_nm(band) < 570
                                               ? 0.01f
                                               : 1.6f + 0.1f * static_cast<float>(y);
        write_spectral_exr(folder / "halves.exr", image);
    }

    Json probe_json(const std::string& arguments) const {
        const ProgramResult result = run("probe " + arguments + " --json probe.json");
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return Json::parse(file_bytes(folder / "probe.json"));
    }

    /// Radiance per band that `measure` says the patch has: its BRRDF times cos 45 degrees.
    std::vector<double> measured_radiance() const {
        put("patch.toml", "[material]\n" + varnished);
        const ProgramResult result =
            run("measure patch.toml -o patch.csv --theta-i 45 --theta-o 0 --phi 0 --model adding");
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        std::vector<double> radiance(7, 0.0);
        std::istringstream lines(file_bytes(folder / "patch.csv"));
        for (std::string line; std::getline(lines, line);) {
            double theta_i = 0, theta_o = 0, phi = 0, in_nm = 0, out_nm = 0, value = 0;
            if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &theta_i, &theta_o, &phi,
                            &in_nm, &out_nm, &value) == 6)
                radiance.at(static_cast<std::size_t>((out_nm - 400.0) / 50.0 + 0.5)) +=
                    value * std::sqrt(0.5);
        }
        return radiance;
    }
};

} // namespace

TEST_F(DevelopAndProbe, DevelopMakesThePictureOfRenderByteForByte) {
    put("dye.csv", dye);
    put("scene.toml", patch_scene);
    for (const std::string options : {"", "--exposure 1.5 --gamut compress",
                                      "--exposure auto --white A", "--white auto --gamut compress",
                                      "--exposure -2 --display G2.6-P3-D65", "--white 0.36,0.36"}) {
        const ProgramResult render =
            run("render scene.toml -o s.exr --spp 4 --png s.png " + options);
        ASSERT_EQ(render.exit_code, 0) << options << render.errors;
        const ProgramResult develop = run("develop s.exr -o d.png " + options);
        ASSERT_EQ(develop.exit_code, 0) << options << develop.errors;
        EXPECT_EQ(file_bytes(folder / "d.png"), file_bytes(folder / "s.png")) << options;
        const ProgramResult merge = run("merge s.exr -o m.exr --png m.png " + options);
        ASSERT_EQ(merge.exit_code, 0) << options << merge.errors;
        EXPECT_EQ(file_bytes(folder / "m.png"), file_bytes(folder / "s.png")) << options;
    }
}

TEST_F(DevelopAndProbe, DevelopSaysWhatItChose) {
    write_halves();
    const ProgramResult result = run(
        "develop halves.exr -o a.png --exposure auto --white auto --gamut compress --json r.json");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const Json json = Json::parse(file_bytes(folder / "r.json"));
    EXPECT_EQ(json.at("width"), 12);
    EXPECT_TRUE(json.at("exposure_ev").is_number());
    EXPECT_GT(json.at("white_xy").at(0).get<double>(), 0.5) << "the orange is bright";
    EXPECT_NE(result.output.find("white x = 0."), std::string::npos) << result.output;
    EXPECT_EQ(run("develop halves.exr -o b.jpg --quiet").output, "");
    EXPECT_EQ(file_bytes(folder / "b.jpg").substr(0, 2), "\xff\xd8");
    EXPECT_EQ(run("develop halves.exr -o b.tif --quiet").output, "");
    EXPECT_EQ(file_bytes(folder / "b.tif").substr(0, 4), std::string("II*\0", 4));
    EXPECT_EQ(run("develop halves.exr -o c.png --json r.json").exit_code, 0);
    EXPECT_TRUE(Json::parse(file_bytes(folder / "r.json")).at("white_xy").is_null());
    EXPECT_EQ(Json::parse(file_bytes(folder / "r.json")).at("out_of_gamut"), 48);
}

TEST_F(DevelopAndProbe, LampsAreThoseOfColourAndFiles) {
    write_halves();
    put("lamp.csv", "nm,value\n400,1\n500,2\n600,3\n700,2\n");
    for (const char* lamp : {"A", "FL11", "D:5000", "P:2700", "D65+0.3*L:365", "lamp.csv", "M0"}) {
        const ProgramResult result =
            run(std::string("develop halves.exr -o a.png --white ") + lamp);
        EXPECT_EQ(result.exit_code, 0) << lamp << result.errors;
        EXPECT_EQ(run(std::string("probe halves.exr --at 1,1 --lamp ") + lamp).exit_code, 0)
            << lamp;
    }
}

TEST_F(DevelopAndProbe, BadDevelopingIsRefusedAndNothingWritten) {
    write_halves();
    put("text.exr", "no image");
    put("matrix.csv", dye);
    expect_failure(2, "develop missing.exr -o a.png", "missing.exr");
    expect_failure(2, "develop text.exr -o a.png", "text.exr");
    expect_failure(2, "develop matrix.csv -o a.png", "matrix.csv");
    expect_failure(2, "develop halves.exr -o a.png --white Sun", "--white");
    expect_failure(2, "develop halves.exr -o a.png --white 0.9,0.9", "--white");
    expect_failure(2, "develop halves.exr -o a.png --white L:365", "--white");
    expect_failure(2, "develop halves.exr -o a.png --white ''", "--white");
    expect_failure(2, "develop halves.exr -o a.png --exposure bright", "--exposure");
    expect_failure(2, "develop halves.exr -o a.png --exposure nan", "--exposure");
    expect_failure(2, "develop halves.exr -o a.png --exposure 101", "--exposure");
    expect_failure(2, "develop halves.exr -o a.png --exposure 1x", "--exposure");
    expect_failure(2, "develop halves.exr -o a.png --gamut squeeze", "--gamut");
    expect_failure(2, "develop halves.exr -o a.png --display Cinema", "Cinema");
    expect_failure(2, "develop halves.exr -o a.png --ocio missing.ocio", "missing.ocio");
    expect_failure(2, "develop halves.exr -o a.exr", "a.exr");
    expect_failure(2, "develop halves.exr -o a.bmp", "a.bmp");
    expect_failure(2, "develop halves.exr -o a.tif --display G2.6-P3-D65", "a.tif");
    expect_failure(2, "develop halves.exr -o a", "a");
    expect_failure(2, "develop halves.exr -o a.jpg --display G2.6-P3-D65", "a.jpg");
    expect_failure(2, "develop halves.exr -o halves.exr", "halves.exr");
    expect_failure(2, "develop halves.exr", "-o");
}

TEST_F(DevelopAndProbe, ProbeAgreesWithMeasureWithinItsStandardError) {
    put("dye.csv", dye);
    put("scene.toml", patch_scene);
    const std::vector<double> expected = measured_radiance();
    ASSERT_EQ(
        run("render scene.toml -o s.exr --spp 32 --variance bands --seed 3 --comb-phase centre")
            .exit_code,
        0);
    std::string regions;
    for (int y = 0; y < 16; y += 4)
        for (int x = 0; x < 16; x += 4)
            regions += " --region " + std::to_string(x) + "," + std::to_string(y) + "," +
                       std::to_string(x + 3) + "," + std::to_string(y + 3);
    const Json probed = probe_json("s.exr --region 0,0,15,15" + regions);
    const Json& whole = probed.at("places").at(0);
    EXPECT_EQ(whole.at("pixels"), 256);
    EXPECT_EQ(whole.at("radiance_stderr_from"), "variance");
    for (std::size_t band = 0; band < expected.size(); ++band) {
        const double value = whole.at("radiance").at(band),
                     error = whole.at("radiance_stderr").at(band);
        EXPECT_GT(error, 0.0);
        EXPECT_LT(error, 0.05 * expected[band] + 1e-6) << "a probe that says nothing";
        // 4.5 standard errors: one in 20,000 for seven bands.
        EXPECT_NEAR(value, expected[band], 4.5 * error) << "band " << band;
    }
    // 16 independent regions: mean squares of chi-square with 16 degrees lie within 0.2 to 2.8 but
    // for one in 10,000.
    for (std::size_t band = 0; band < expected.size(); ++band) {
        double sum = 0.0;
        for (std::size_t k = 1; k <= 16; ++k) {
            const Json& place = probed.at("places").at(k);
            const double off = place.at("radiance").at(band).get<double>() - expected[band];
            sum += std::pow(off / place.at("radiance_stderr").at(band).get<double>(), 2) / 16.0;
        }
        EXPECT_GT(sum, 0.2) << band;
        EXPECT_LT(sum, 2.8) << band;
    }
}

TEST_F(DevelopAndProbe, ProbeComparesPlaces) {
    write_halves();
    const Json probed =
        probe_json("halves.exr --at 9,4 --at 2,4:2 --region 6,0,11,7 -o p.csv --plot p.svg");
    ASSERT_EQ(probed.at("places").size(), 3u);
    const Json& grey = probed.at("places").at(0);
    EXPECT_EQ(grey.at("pixels"), 1);
    EXPECT_EQ(grey.at("radiance_stderr_from"), "unknown");
    EXPECT_TRUE(grey.at("luminance_stderr").is_null());
    EXPECT_EQ(probed.at("places").at(1).at("pixels"), 13);
    EXPECT_EQ(probed.at("places").at(1).at("luminance_stderr_from"), "spread");
    const Json& pairs = probed.at("pairs");
    ASSERT_EQ(pairs.size(), 2u);
    EXPECT_EQ(pairs.at(0).at("over"), "at 9,4");
    // 2.0 over 0.4 in the red, in single precision.
    EXPECT_NEAR(pairs.at(0).at("ratio").at(15).get<double>(), 5.0, 1e-5);
    EXPECT_GT(pairs.at(0).at("ciede2000").get<double>(), 20.0);
    EXPECT_EQ(pairs.at(1).at("ciede2000").get<double>(), 0.0);
    EXPECT_EQ(pairs.at(1).at("luminance_ratio").get<double>(), 1.0);
    const std::string csv = file_bytes(folder / "p.csv");
    EXPECT_NE(csv.find("\nnm,at 9 4,at 9 4 stderr,"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\n700,0.4"), std::string::npos) << csv;
    EXPECT_NE(file_bytes(folder / "p.svg").find("at 2,4:2"), std::string::npos);
}

TEST_F(DevelopAndProbe, LabIsRelativeToTheLampsWhite) {
    const WavelengthGrid bands = grid_from_range(380, 780, 5);
    SpectralImage image = flat_image(2, 2, bands, 0.0f);
    const Spectrum a = illuminant_with_luminance("A", 0.2);
    for (int pixel = 0; pixel < 4; ++pixel)
        for (int band = 0; band < bands.count; ++band)
            image.at(pixel % 2, pixel / 2, band) =
                static_cast<float>(a.average(bands.lower_edge_nm(band), bands.upper_edge_nm(band)));
    write_spectral_exr(folder / "a.exr", image);
    const auto lab = [&](const std::string& options) {
        return probe_json("a.exr --region 0,0,1,1 " + options)
            .at("places")
            .at(0)
            .at("Lab")
            .get<std::array<double, 3>>();
    };
    const auto neutral = lab("--lamp A --white-luminance 0.2");
    EXPECT_NEAR(neutral[0], 100.0, 0.02); // bands of 5 nm, from 380 nm on
    EXPECT_NEAR(neutral[1], 0.0, 0.02);
    EXPECT_NEAR(neutral[2], 0.0, 0.02);
    EXPECT_NEAR(lab("--lamp A")[0], 116.0 * std::cbrt(0.2) - 16.0, 0.02);
    EXPECT_GT(lab("")[2], 20.0) << "beside daylight it is yellow";
}

TEST_F(DevelopAndProbe, BadProbesAreRefusedAndNothingWritten) {
    write_halves();
    put("text.exr", "no image");
    const std::string files = " -o p.csv --plot p.svg --json p.json";
    const auto refused = [&](const std::string& arguments, const std::string& place) {
        expect_failure(2, "probe " + arguments + files, place);
    };
    refused("missing.exr --at 1,1", "missing.exr");
    refused("text.exr --at 1,1", "text.exr");
    refused("halves.exr", "--at");
    refused("halves.exr --at 12,1", "12 x 8 pixels");
    refused("halves.exr --at 1,8", "halves.exr");
    refused("halves.exr --at 1,1:2", "12 x 8 pixels");
    refused("halves.exr --at=-1,1", "12 x 8 pixels");
    refused("halves.exr --at 1", "--at");
    refused("halves.exr --at ''", "--at");
    refused("halves.exr --at 1,1:", "--at");
    refused("halves.exr --at 1,1:0", "--at");
    refused("halves.exr --at 1,1:nan", "--at");
    refused("halves.exr --at 1.5,1", "--at");
    refused("halves.exr --at 99999999999,1", "--at");
    refused("halves.exr --at 2147483647,1:9", "--at");
    refused("halves.exr --at 1,1 --at 1,1", "twice");
    refused("halves.exr --region 4,4,2,2", "--region");
    refused("halves.exr --region 0,0,12,2", "12 x 8 pixels");
    refused("halves.exr --region 0,0,2", "--region");
    refused("halves.exr --at 1,1 --lamp Sun", "--lamp");
    refused("halves.exr --at 1,1 --lamp L:365", "--lamp");
    refused("halves.exr --at 1,1 --white-luminance 0", "--white-luminance");
    expect_failure(2, "probe halves.exr --at 1,1 -o p.png", "p.png");
    expect_failure(2, "probe halves.exr --at 1,1 --plot halves.exr", "halves.exr");
}

} // namespace reradiant
