#pragma once

#include "tests/full_run.h"

#include <gtest/gtest.h>

/// For what `fit` must reach and does not yet: skipped with the reason, and tried in a full run.
#define NOT_REACHED_YET(reason)                                                                    \
    if (!::reradiant::is_full_run())                                                               \
    GTEST_SKIP() << "not reached yet: " << reason
