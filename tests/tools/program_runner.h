#pragma once

#include "tests/film/film_fixtures.h"

#include <cstdlib>
#include <string>
#include <sys/wait.h>

namespace reradiant {

/// The exit code and the texts that one run of the program left behind.
struct ProgramResult {
    int exit_code = -1; ///< -1 when a signal ended it
    std::string output, errors;
};

/// Runs the program in a folder of its own, through the shell as a user does.
class ProgramTest : public ::testing::Test {
protected:
    /// `arguments` as typed after the program's name; `environment` like "NAME=value NAME=value".
    ProgramResult run(const std::string& arguments, const std::string& environment = "") const {
        const TemporaryFolder capture_folder("capture");
        const std::string output = (capture_folder / "out").string();
        const std::string errors = (capture_folder / "err").string();
        const std::string command = "cd '" + (folder / "").string() + "' && env -u OCIO -u " +
                                    "RERADIANT_DEVICE " + environment +
                                    " '" RERADIANT_PROGRAM "' " + arguments + " >'" + output +
                                    "' 2>'" + errors + "'";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_bytes(output),
                file_bytes(errors)};
    }

    /// Starts the program, asks it to end as soon as `file` is there, and returns its exit code.
    int run_until(const std::string& file, const std::string& arguments) const {
        const std::string command =
            "cd '" + (folder / "").string() + "' && { '" RERADIANT_PROGRAM "' " + arguments +
            " --quiet & program=$!; until test -e '" + file +
            "' || ! kill -0 $program; do sleep 0.05; done; kill -TERM $program; wait $program; }";
        const int status = std::system(command.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    /// The run must fail with this code, say `place` on standard error, and add no file.
    void expect_failure(int exit_code, const std::string& arguments, const std::string& place,
                        const std::string& environment = "") const {
        const std::size_t files_before = folder.file_count();
        const ProgramResult result = run(arguments, environment);
        EXPECT_EQ(result.exit_code, exit_code) << arguments << "\n" << result.errors;
        EXPECT_NE(result.errors.find(place), std::string::npos) << arguments << "\n"
                                                                << result.errors;
        EXPECT_EQ(folder.file_count(), files_before) << arguments << " left a file";
    }

    void put(const std::string& name, const std::string& text) const {
        put_bytes(folder / name, text);
    }

    const TemporaryFolder folder;
};

/// A small scene that is right; tests break it in one place.
inline std::string small_scene() {
    return "[film]\n"
           "width = 8\n"
           "height = 6\n"
           "[camera]\n"
           "origin = [0, 0, 3]\n"
           "target = [0, 0, 0]\n"
           "[[light]]\n"
           "type = \"environment\"\n"
           "radiance = 1.0\n"
           "[[shape]]\n"
           "type = \"sphere\"\n"
           "center = [0, 0, 0]\n"
           "radius = 1\n"
           "material = \"grey\"\n"
           "[[material]]\n"
           "name = \"grey\"\n"
           "[material.substrate]\n"
           "type = \"lambert\"\n"
           "reflectance = 0.5\n";
}

/// The text with the first `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return text.replace(place, from.size(), to);
}

} // namespace reradiant
