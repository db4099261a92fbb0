#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/Paths.hpp"

/** Skips a test with a message if a component library could not be built because the system lacks its packages. */
#define INSONIFY_NEEDS(library)                                                                            \
    if (!std::filesystem::exists(std::string(insonify::test::build_dir) + "/lib/insonify/" library ".so")) \
    GTEST_SKIP() << "NOT TESTED: this system has no packages for the component library " library
