#pragma once

#include "host/study/study/study_file.h"
#include "reradiant/error.h"
#include "tests/support/scratch_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace reradiant::test {

/// A folder with files of a study, removed with the test.
class StudyTest : public ScratchFolder {
protected:
    void SetUp() override { put("sample.toml", material); }

    void put(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name) << text;
    }
    Study load(const std::string& text) const {
        put("study.toml", text);
        return load_study(folder / "study.toml");
    }
    /// Returns the message with which loading fails, without the folder's name before it:
    /// "study.toml:LINE:COLUMN: ...".
    std::string refusal(const std::string& text) const {
        try {
            load(text);
        } catch (const Error& error) {
            EXPECT_EQ(error.exit_code(), 2) << error.what();
            const std::string what = error.what();
            const std::string prefix = (folder / "").string();
            return what.starts_with(prefix) ? what.substr(prefix.size()) : what;
        }
        ADD_FAILURE() << "was taken:\n" << text;
        return {};
    }

    /// A dye beneath a varnish.
    const std::string material =
        "[material]\n"
        "[[material.layer]]\n"
        "ior = 1.5\n"
        "alpha = 0.2\n"
        "absorption = 0.1\n"
        "[material.substrate]\n"
        "type = \"lambert\"\n"
        "[material.substrate.reradiation]\n"
        "reflectance = 0.3\n"
        "fluorophores = [{ excitation = { gaussian_nm = 450, sigma_nm = 30, scale = 0.5 }, "
        "emission = { gaussian_nm = 550, sigma_nm = 20, scale = 1 }, quantum_yield = 0.8 }]\n";
    /// Line 1 and 2 of studies; sweeps begin in line 3.
    const std::string head = "[study]\nmaterial = \"sample.toml\"\n";
};

} // namespace reradiant::test
