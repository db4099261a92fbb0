#pragma once
// Doors through which bytes of others come in, and what pushes at them.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace insonify::fuzz {

/** Bytes to be read, which become a file when one is asked for. */
class Input {
public:
    Input(std::string bytes, std::filesystem::path file) : bytes_(std::move(bytes)), file_(std::move(file)) {}

    const std::string& bytes() const { return bytes_; }
    std::span<const char> span() const { return bytes_; }
    std::span<const uint8_t> octets() const { return {reinterpret_cast<const uint8_t*>(bytes_.data()), bytes_.size()}; }
    const std::filesystem::path& file() const { return file_; }

private:
    std::string bytes_;
    std::filesystem::path file_;
};

/** One reader of foreign bytes. */
struct Door {
    std::string name;                ///< Of its folder in tests/fuzz/corpus.
    std::string file;                ///< Name of the file that it reads.
    std::vector<std::string> words;  ///< Of its language, that are put in.
    std::function<void(const Input&)>
        enter;  ///< Reads; returns as well where types::ConfigError or its like is thrown.
};

/** Reads every file of the door's corpus. With INSONIFY_FUZZ_SECONDS, goes on for that time with inputs made from them:
 *  the one at hand is always in INSONIFY_FUZZ_FOLDER, where those stay that led to code which none before had reached,
 *  as far as the program was built to tell (CMake's INSONIFY_FUZZ). One that takes more than a minute ends the process.
 *  An exception that leaves `enter` is a failure. */
void push(const Door& door);

/** A message for a user: fails where it is what only a library's author understands. */
void expectOurWords(const std::string& message);

}  // namespace insonify::fuzz
