// Insonify as a folder of a bigger project: add_subdirectory.
#include <gmock/gmock.h>

#include "tests/install/Outside.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify::deployer;
using testing::HasSubstr;
using testing::Not;

namespace {

/** A project with a warning in one of its files, a target of its own that is called `package`, and tests. */
void writeProject(const TestFolder& folder) {
    writeFile(folder / "CMakeLists.txt", R"(cmake_minimum_required(VERSION 3.22)
project(Vehicle CXX)
add_subdirectory()" + std::string(insonify::test::source_dir) +
                                             R"( insonify EXCLUDE_FROM_ALL)
get_property(installed GLOBAL PROPERTY insonify_installed)
foreach(target insonify insonify_core ${installed})
  get_target_property(name ${target} EXPORT_NAME)
  if(NOT name)
    set(name insonify)
  endif()
  get_target_property(aliased Insonify::${name} ALIASED_TARGET)
  if(NOT aliased STREQUAL target)
    message(SEND_ERROR "Insonify::${name} is ${aliased}")
  endif()
endforeach()
if(CMAKE_BUILD_TYPE OR CMAKE_CXX_STANDARD OR CMAKE_RUNTIME_OUTPUT_DIRECTORY)
  message(SEND_ERROR "a setting of the part is in the whole")
endif()
add_custom_target(package)
add_custom_target(check)
add_executable(vehicle main.cpp)
target_link_libraries(vehicle Insonify::acoustics)
install(TARGETS vehicle)
)");
    writeFile(folder / "main.cpp", R"(#include <cstdio>

#include "components/acoustics/SoundSpeed.hpp"
#include "types/geometry/Extent.hpp"

int main() {
    std::puts("linked");
}
)");
}

}  // namespace

TEST(SubprojectTest, ABiggerProjectBuildsWithOurLibrariesAndNothingElseOfOurs) {
    const TestFolder folder;
    writeProject(folder);
    const Outcome configured =
        call(folder, {INSONIFY_CMAKE, "-S", ".", "-B", "b,1", "-G", "Ninja", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"});
    ASSERT_EQ(configured.code, 0) << configured.err;
    EXPECT_THAT(readFile(folder / "b,1/build.ninja"),
                testing::AllOf(Not(HasSubstr("-Werror")), Not(HasSubstr("_test"))));
    const std::string cache = readFile(folder / "b,1/CMakeCache.txt");
    for (const char* ours : {"BUILD_TESTING", "\nCPACK_", "INSONIFY_TESTS:BOOL=ON", "INSONIFY_INSTALL:BOOL=ON"})
        EXPECT_EQ(cache.find(ours), std::string::npos) << ours;

    ASSERT_THAT(call(folder, {INSONIFY_CMAKE, "--build", "b,1"}), succeeds());
    EXPECT_EQ(call(folder, {folder / "b,1/vehicle"}).out, "linked\n");
    ASSERT_THAT(call(folder, {INSONIFY_CMAKE, "--install", "b,1", "--prefix", folder / "prefix"}), succeeds());
    size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "prefix"))
        files += entry.is_regular_file() ? 1 : 0;
    EXPECT_EQ(files, 1u) << "only the project's own program";
}
