#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

namespace insonify::log {

/** Numpy's name of a little-endian number: "<f4"; of a boolean in a byte: "|b1". */
template <class T>
std::string numpyType() {
    if constexpr (std::is_same_v<T, bool>) return "|b1";
    const char* kind = std::is_floating_point_v<T> ? "<f" : std::is_signed_v<T> ? "<i" : "<u";
    return kind + std::to_string(sizeof(T));
}

/** Writes a numpy `.npz`: a zip file of uncompressed arrays, with 64-bit sizes throughout. close() reports errors of
 *  writing; it throws std::runtime_error. */
class NpzFile {
public:
    /** Throws ConfigError when the file cannot be created. */
    explicit NpzFile(const std::filesystem::path& path);

    /** Begins an array in C order; append() adds its elements. */
    void begin(const std::string& name, const std::string& type, const std::vector<size_t>& shape);
    void append(const void* data, size_t size);
    void end();
    template <class T>
    void array(const std::string& name, const std::vector<size_t>& shape, const std::vector<T>& values) {
        begin(name, numpyType<T>(), shape);
        append(values.data(), values.size() * sizeof(T));
        end();
    }
    /** Writes UTF-8 texts as numpy's unicode strings; invalid bytes become U+FFFD. */
    void texts(const std::string& name, const std::vector<std::string>& values) {
        texts(name, {values.size()}, values);
    }
    /** Writes one text as an array without dimensions: `str(x[name])`. */
    void text(const std::string& name, const std::string& value) { texts(name, {}, {value}); }
    void close();

private:
    void texts(const std::string& name, const std::vector<size_t>& shape, const std::vector<std::string>& values);

    struct Entry {
        std::string name;
        uint64_t position = 0;  ///< Position of its local header in the file [B].
        uint64_t size = 0;      ///< [B]
        uint32_t crc = 0;
    };

    std::filesystem::path path_;
    std::ofstream file_;
    std::vector<Entry> entries_;
};

}  // namespace insonify::log
