#pragma once
#include <filesystem>
#include <mutex>
#include <sdf/Root.hh>
#include <sstream>
#include <streambuf>
#include <string>
#include <vector>

#include "components/meshes/ModelPaths.hpp"

namespace insonify::sdf {

/** Takes what is written to std::cerr while it lives: libsdformat complains there, and not only on its console.
 *  One at a time; others wait. */
class CerrCapture {
public:
    CerrCapture();
    ~CerrCapture();
    CerrCapture(const CerrCapture&) = delete;
    CerrCapture& operator=(const CerrCapture&) = delete;
    /** What came since the last call. */
    std::string take();

private:
    static std::mutex mutex_;
    std::lock_guard<std::mutex> lock_;
    std::ostringstream text_;
    std::streambuf* before_;
};

/** The bytes of a file. Throws types::ConfigError for one that is too large. */
std::string textOf(const std::filesystem::path& file);

/** Loads an SDF file with what it includes, or `text` in its place unless that is empty. What libsdformat finds wrong
 * goes to `notices` when there is a world or a model nevertheless, and is thrown as types::ConfigError when there is
 * none. An include that is not found or cannot be read is left out. */
::sdf::Root readSdfFile(const std::filesystem::path& file, const meshes::ModelPaths& paths, CerrCapture& console,
                        std::vector<std::string>& notices, const std::string& text = {});

}  // namespace insonify::sdf
