#pragma once

#include "reradiant/error.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace reradiant {

/// Line and column of the input Error that `read` must throw, whose text must hold these words.
template <typename Read>
std::pair<int, int> refusal(const Read& read, const std::string& words = "") {
    try {
        read();
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 2) << error.what();
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
            << error.what() << "\nwithout '" << words << "'";
        return {error.position().line, error.position().column};
    }
    ADD_FAILURE() << "accepted, where '" << words << "' belongs";
    return {0, 0};
}

} // namespace reradiant
