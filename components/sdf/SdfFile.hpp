#pragma once
#include <filesystem>
#include <mutex>
#include <sdf/Root.hh>
#include <sstream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "components/meshes/WorldBuilder.hpp"

namespace insonify::sdf {

/** Captures the text written to std::cerr while it exists: libsdformat prints errors there, not only on its console.
 *  Only one capture exists at a time; the constructor waits for the others. */
class CerrCapture {
public:
    CerrCapture();
    ~CerrCapture();
    CerrCapture(const CerrCapture&) = delete;
    CerrCapture& operator=(const CerrCapture&) = delete;
    /** Returns the text since the last call. */
    std::string take();

private:
    static std::mutex mutex_;
    std::lock_guard<std::mutex> lock_;
    std::ostringstream text_;
    std::streambuf* before_;
};

/** Returns the bytes of a file. Throws types::ConfigError for a file that is too large. */
std::string toText(const std::filesystem::path& file);

/** Returns the finite number that a word is; else NaN. */
double toNumber(std::string_view word);

/** Whether an element says nothing of shapes. */
bool isNeedless(std::string_view element);

/** Follows the includes of an SDF file, and returns what is wrong in the numbers of included files. Throws
 *  types::ConfigError for numbers of the file itself, and where libsdformat would overflow its stack or run for
 * minutes: at a model that includes itself, and beyond the max work. */
types::Diagnostics checkIncludes(const std::filesystem::path& file, const meshes::ModelPaths& paths);

/** Loads an SDF file with its includes, or `text` instead of the file unless `text` is empty. Diagnostics of
 *  libsdformat are notices of `builder` if there is still a world or a model, otherwise they are thrown as
 *  types::ConfigError. An include that is missing or unreadable is omitted. */
::sdf::Root readSdfFile(const std::filesystem::path& file, meshes::WorldBuilder& builder, CerrCapture& console,
                        const std::string& text = {});

}  // namespace insonify::sdf
