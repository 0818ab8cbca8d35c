#pragma once

#include "reradiant/error.h"
#include "reradiant/scene.h"
#include "tests/support/scratch_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace reradiant::testing {

using Scratch = test::ScratchFolder;

/// The Error that an action throws; a failed test and nothing when it throws none.
struct Caught {
    bool thrown = false;
    int exit_code = 0, line = 0, column = 0;
    std::string file, text;
};
Caught error_of(const std::function<void()>& action);

/// Warnings that an action logs.
std::vector<std::string> warnings_of(const std::function<void()>& action);

/// The smallest scene: film in lines 1-3, camera in lines 4-6, a grey sphere under a white sky.
extern const char* const SMALL_SCENE;

/// `text` with the first `from` replaced; fails the test when it does not occur.
std::string replaced(std::string text, const std::string& from, const std::string& to);

} // namespace reradiant::testing
