#include "tests/support/Fuzz.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>

#include "tests/support/Folder.hpp"
#include "tests/support/Paths.hpp"

namespace {

/** The path of the program: a mark for each step from one block of code to another. */
std::array<uint8_t, 1 << 16> steps;
thread_local uintptr_t block_before = 0;

}  // namespace

#ifdef __clang__
#define INSONIFY_NO_COVERAGE no_sanitize("coverage")
#else
#define INSONIFY_NO_COVERAGE no_sanitize_coverage
#endif

/** Called by the compiler at each block of code (-fsanitize-coverage=trace-pc). */
extern "C" __attribute__((INSONIFY_NO_COVERAGE, no_sanitize("address", "undefined"))) void __sanitizer_cov_trace_pc() {
    const auto block = reinterpret_cast<uintptr_t>(__builtin_return_address(0));
    steps[(block ^ block_before) % steps.size()] = 1;
    block_before = block >> 1;
}

namespace insonify::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr unsigned max_seconds = 60;           // for one input
constexpr size_t max_bytes = size_t{1} << 20;  // of an input

std::string bytesOfFile(const fs::path& file) {
    const std::vector<char> bytes = toBytes(file);
    return {bytes.begin(), bytes.end()};
}

std::vector<std::string> corpusIn(const fs::path& folder) {
    std::vector<fs::path> files;
    if (fs::is_directory(folder))
        for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::ranges::sort(files);
    std::vector<std::string> corpus;
    std::ranges::transform(files, std::back_inserter(corpus), bytesOfFile);
    return corpus;
}

class Mutator {
public:
    Mutator(const Door& door, std::vector<std::string> corpus, unsigned seed)
        : door_(door), corpus_(std::move(corpus)), random_(seed) {}

    std::string next() {
        std::string bytes = pick(corpus_);
        for (size_t changes = 1 + below(4); changes > 0; --changes) change(bytes);
        bytes.resize(std::min(bytes.size(), max_bytes));
        return bytes;
    }
    void keep(const std::string& bytes) { corpus_.push_back(bytes); }
    size_t kept() const { return corpus_.size(); }

private:
    size_t below(size_t count) { return count == 0 ? 0 : random_() % count; }
    const std::string& pick(const std::vector<std::string>& texts) { return texts[below(texts.size())]; }

    void change(std::string& bytes) {
        const size_t at = below(bytes.size() + 1);
        switch (below(9)) {
            case 0: return overwrite(bytes, at, std::string(1, static_cast<char>(random_())));
            case 1: return overwrite(bytes, at, std::string(1, static_cast<char>('0' + below(10))));
            case 2: return void(bytes.erase(at, 1 + below(32)));
            case 3: return void(bytes.insert(at, bytes.substr(below(bytes.size() + 1), 1 + below(200))));
            case 4: return void(bytes.insert(at, pick(door_.words)));
            case 5: return overwrite(bytes, at, extremeNumber());
            case 6: return replaceNumber(bytes, at);
            case 7: return splice(bytes, at);
            default: return void(bytes.resize(at));
        }
    }
    static void overwrite(std::string& bytes, size_t at, const std::string& by) {
        bytes.replace(at, std::min(by.size(), bytes.size() - at), by);
    }
    /** A number of 1, 2, 4 or 8 bytes: a bound, or about the size of the input. */
    std::string extremeNumber() {
        const uint64_t numbers[] = {0,          1,          0x7f,       0x80,       0xff,  0x7fff,
                                    0xffff,     0x7fffffff, 0x80000000, 0xffffffff, ~0ull, 0x7fffffffffffffff,
                                    below(4096)};
        const uint64_t number = numbers[below(std::size(numbers))];
        std::string bytes(size_t{1} << below(4), '\0');
        std::memcpy(bytes.data(), &number, bytes.size());
        return bytes;
    }
    void replaceNumber(std::string& bytes, size_t at) {
        static const std::vector<std::string> numbers = {
            "0", "-1", "1e308", "-1e-320", "nan", "inf", "4294967296", "18446744073709551616", "2147483648", "0.5", ""};
        const size_t begin = bytes.find_first_of("0123456789", at);
        if (begin == std::string::npos) return;
        const size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", begin), bytes.size());
        bytes.replace(begin, end - begin, pick(numbers));
    }
    void splice(std::string& bytes, size_t at) {
        const std::string& other = pick(corpus_);
        const size_t from = below(other.size() + 1);
        bytes.insert(at, other, from, 1 + below(400));
    }

    const Door& door_;
    std::vector<std::string> corpus_;
    std::minstd_rand random_;
};

/** Returns whether the last input reached new steps. */
bool leadsElsewhere() {
    static std::array<uint8_t, steps.size()> known;
    bool is_new = false;
    for (size_t i = 0; i < steps.size(); ++i) {
        is_new = is_new || steps[i] > known[i];
        known[i] |= steps[i];
    }
    return is_new;
}

void enter(const Door& door, const std::string& bytes, const fs::path& folder) {
    const fs::path file = folder / door.file;
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    steps.fill(0);
    EXPECT_NO_THROW(door.enter(Input(bytes, file))) << "the input is in " << file;
}

/** Limits memory, except with a sanitizer, which reserves unlimited address space and has a limit of its own. */
void limitMemory() {
#ifndef __SANITIZE_ADDRESS__
    const rlimit limit{rlim_t{4} << 30, rlim_t{4} << 30};
    setrlimit(RLIMIT_AS, &limit);
#endif
}

void fuzz(const Door& door, std::vector<std::string> corpus, double seconds, const fs::path& folder) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    limitMemory();
    Mutator mutator(door, std::move(corpus), std::random_device()());
    uint64_t inputs = 0;
    for (; std::chrono::steady_clock::now() < end && !testing::Test::HasFailure(); ++inputs) {
        const std::string bytes = mutator.next();
        alarm(max_seconds);
        enter(door, bytes, folder);
        if (!leadsElsewhere()) continue;
        fs::create_directories(folder / "found");
        fs::copy_file(folder / door.file, folder / "found" / std::to_string(mutator.kept()),
                      fs::copy_options::overwrite_existing);
        mutator.keep(bytes);
    }
    alarm(0);
    std::cout << door.name << ": " << inputs << " inputs, " << mutator.kept() << " in the corpus\n";
}

}  // namespace

void push(const Door& door) {
    const Folder own;
    const std::vector<std::string> corpus = corpusIn(fs::path(test::source_dir) / "tests/fuzz/corpus" / door.name);
    ASSERT_FALSE(corpus.empty());
    for (const std::string& bytes : corpus) enter(door, bytes, own.path());
    leadsElsewhere();
    const char* seconds = std::getenv("INSONIFY_FUZZ_SECONDS");
    const char* folder = std::getenv("INSONIFY_FUZZ_FOLDER");
    if (!seconds || !folder) return;
    fs::create_directories(fs::path(folder) / door.name);
    fuzz(door, corpus, std::atof(seconds), fs::path(folder) / door.name);
}

void expectOurWords(const std::string& message) {
    EXPECT_FALSE(message.empty());
    for (const char* raw : {"std::bad", "std::exception", "_M_", "basic_string::", "[json.exception", "XML_ERROR"})
        EXPECT_EQ(message.find(raw), std::string::npos) << message;
}

}  // namespace insonify::fuzz
