#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace insonify::output {

/** A file name with a number in it, written as for printf: "fan_%06d.png". */
class FilePattern {
public:
    /** Nothing unless there is exactly one `%`, of the form %d, %Nd or %0Nd with N up to 99, before a final ".png". */
    static std::optional<FilePattern> parse(const std::string& pattern);

    std::string name(uint64_t number) const;

private:
    std::string before_, after_;
    int width_ = 0;
    char filler_ = ' ';
};

}  // namespace insonify::output
