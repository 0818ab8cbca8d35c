#include "reradiant/error.h"
#include "reradiant/spectral_files.h"
#include "tests/support/scratch_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <memory>

using namespace reradiant;

namespace {

/// Entries that are possible: equal steps, emission not below the excitation.
ReradiationMatrix possible(const WavelengthGrid& emission, const WavelengthGrid& excitation) {
    ReradiationMatrix matrix{emission, excitation,
                             Eigen::MatrixXd::Zero(emission.count, excitation.count)};
    for (int i = 0; i < excitation.count; ++i)
        for (int o = 0; o < emission.count; ++o)
            if (emission.centre_nm(o) >= excitation.centre_nm(i))
                matrix.values(o, i) = 0.5 / (1 + i + o);
    return matrix;
}

class CountingSink : public spdlog::sinks::base_sink<std::mutex> {
public:
    std::vector<std::string> messages;

private:
    void sink_it_(const spdlog::details::log_msg& message) override {
        messages.emplace_back(message.payload.data(), message.payload.size());
    }
    void flush_() override {}
};

class MatrixExr : public test::ScratchFolder {
protected:
    std::vector<std::string> channels() const {
        Imf::InputFile input(path("m.exr").c_str());
        std::vector<std::string> names;
        const Imf::ChannelList& list = input.header().channels();
        for (auto channel = list.begin(); channel != list.end(); ++channel)
            names.emplace_back(channel.name());
        return names;
    }
    /// A file of another program: values 0.1, 0.2 and so on in the order of the names given.
    ReradiationMatrix read_foreign(const std::vector<std::string>& names,
                                   const Imath::Box2i& display = {Imath::V2i(0), Imath::V2i(0)}) {
        Imf::Header header(display, Imath::Box2i(Imath::V2i(0), Imath::V2i(0)));
        header.insert("reradiant:quantity", Imf::StringAttribute("per-band"));
        std::vector<float> values;
        for (std::size_t i = 0; i < names.size(); ++i)
            values.push_back(0.1f * static_cast<float>(i + 1));
        Imf::FrameBuffer frame;
        for (std::size_t i = 0; i < names.size(); ++i) {
            header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
            frame.insert(names[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&values[i]),
                                              sizeof(float), sizeof(float)));
        }
        {
            Imf::OutputFile output(path("m.exr").c_str(), header);
            output.setFrameBuffer(frame);
            output.writePixels(1);
        }
        return read_reradiation(path("m.exr"));
    }
    std::string refusal(const std::vector<std::string>& names) {
        try {
            read_foreign(names);
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2);
            return error.what();
        }
        return "was read";
    }
    /// Lines that are logged when it is written.
    std::vector<std::string> log_of(const ReradiationMatrix& matrix) {
        const auto sink = std::make_shared<CountingSink>();
        const auto previous = spdlog::default_logger();
        spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
        write_reradiation(path("m.exr"), matrix);
        spdlog::set_default_logger(previous);
        return sink->messages;
    }
};

} // namespace

TEST_F(MatrixExr, ImpossibleEntriesAreLeftOutAndReadBackAsZero) {
    const WavelengthGrid grids[][2] = {{{300, 10, 49}, {300, 10, 49}},
                                       {{380, 10, 41}, {300, 10, 49}},
                                       {{300, 10, 21}, {400, 10, 31}}, // columns without entries
                                       {{300, 10, 2}, {500, 10, 3}}};  // no entry at all
    const std::size_t counts[] = {49 * 50 / 2, 41 * 49 - 41 * 40 / 2, 11 * 12 / 2, 1};
    for (std::size_t k = 0; k < std::size(counts); ++k) {
        const ReradiationMatrix matrix = possible(grids[k][0], grids[k][1]);
        write_reradiation(path("m.exr"), matrix);
        EXPECT_EQ(channels().size(), counts[k]);
        const ReradiationMatrix back = read_reradiation(path("m.exr"));
        EXPECT_EQ(back.emission, matrix.emission);
        EXPECT_EQ(back.excitation, matrix.excitation);
        // Half an ULP of a float below 1.
        EXPECT_LE((back.values - matrix.values).cwiseAbs().maxCoeff(), 6e-8);
    }
}

TEST_F(MatrixExr, WhatIsMeasuredBelowTheExcitationIsKept) {
    ReradiationMatrix matrix = possible({400, 10, 3}, {400, 10, 3});
    matrix.kind = MatrixKind::Measured;
    matrix.values(0, 2) = -1e-3;
    write_reradiation(path("m.exr"), matrix);
    EXPECT_EQ(channels().size(), 7u);
    EXPECT_NEAR(read_reradiation(path("m.exr")).values(0, 2), -1e-3, 1e-9);
}

TEST_F(MatrixExr, MoreChannelsThanOthersReadAreSaidInOneLine) {
    EXPECT_TRUE(log_of(possible({380, 10, 40}, {380, 10, 40})).empty());
    const auto log = log_of(possible({380, 10, 41}, {300, 10, 49}));
    ASSERT_EQ(log.size(), 1u);
    EXPECT_NE(log[0].find("1189 channels"), std::string::npos) << log[0];
    EXPECT_NE(log[0].find("limits:channels"), std::string::npos) << log[0];
}

TEST_F(MatrixExr, NamesOfOtherProgramsAreRead) {
    const ReradiationMatrix matrix =
        read_foreign({"T.400nm", "T.0,41um", "T.400.0nm.0.41um", "T.4,2e-7m", "Z"});
    EXPECT_EQ(matrix.emission, (WavelengthGrid{400, 10, 3}));
    EXPECT_EQ(matrix.excitation, (WavelengthGrid{400, 10, 3}));
    EXPECT_NEAR(matrix.values(1, 0), 0.3, 1e-7);
    EXPECT_NEAR(matrix.values(2, 2), 0.4, 1e-7);
    EXPECT_EQ(matrix.values(2, 0), 0.0);
    EXPECT_EQ(read_foreign({"T.374,688nm", "T.404,062nm", "T.433,438nm", "T.462,812nm"}).emission,
              (WavelengthGrid{374.6875, 29.375, 4}));
}

TEST_F(MatrixExr, Case69EntriesGivenTwiceAndLargerImagesAreRefused) {
    EXPECT_NE(refusal({"T.400nm", "T.410nm", "T.400,0nm.400nm"}).find("the same entry"),
              std::string::npos);
    EXPECT_NE(refusal({"T.400nm", "T.410nm", "T.420xm"}).find("T.420xm"), std::string::npos);
    EXPECT_NE(refusal({"T.400nm", "T.410nm", "T.430nm"}).find("equally spaced"), std::string::npos);
    EXPECT_THROW(read_foreign({"T.400nm", "T.410nm"}, {Imath::V2i(0), Imath::V2i(1, 0)}), Error);
}
