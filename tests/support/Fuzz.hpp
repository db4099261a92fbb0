#pragma once
// Doors, the readers of external bytes, and the inputs that test them.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace insonify::fuzz {

/** Bytes to read, which are written to a file on request. */
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

/** One reader of external bytes. */
struct Door {
    std::string name;                ///< Name of its folder in tests/fuzz/corpus.
    std::string file;                ///< Name of the file that it reads.
    std::vector<std::string> words;  ///< Words of its format, inserted into inputs.
    std::function<void(const Input&)>
        enter;  ///< Reads; returns also if types::ConfigError or a similar exception is thrown.
};

/** Reads every file of the door's corpus. With INSONIFY_FUZZ_SECONDS, continues for that time with inputs made from
 *  these files. The current input is always in INSONIFY_FUZZ_FOLDER, where inputs that reached new code are kept. */
void push(const Door& door);

/** Checks a message for users: fails if only the author of a library would understand it. */
void expectOurWords(const std::string& message);

}  // namespace insonify::fuzz
