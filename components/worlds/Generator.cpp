#include "components/worlds/Generator.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "components/console/Console.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Sha256.hpp"

namespace insonify::worlds {
namespace {

namespace fs = std::filesystem;

constexpr int lacks_packages = 97, no_program = 127;  ///< Exit codes of the package's __main__.py, of posix_spawn.
constexpr const char* package_name = "insonify_worlds";

/** Returns the folder that contains the package. */
fs::path packageFolder() {
    for (const fs::path& folder : loader::folders())
        if (std::error_code none; fs::is_regular_file(folder / "python" / package_name / "__main__.py", none))
            return folder / "python";
    throw types::ConfigError(
        "", "",
        fmt::format("the Python package {} is not next to the component library worlds; install the library again",
                    package_name));
}

/** Returns the Pythons to try, in this order: only the given Python, or the Python of scripts/setup in a build folder
 *  and the Pythons in the path. */
std::vector<std::string> pythons() {
    if (const char* given = std::getenv(python_variable); given && *given) return {given};
    std::vector<std::string> all;
    for (const fs::path& folder : loader::folders())
        if (std::error_code none; fs::exists(folder / "../../venv/bin/python3", none))
            all.push_back(fs::weakly_canonical(folder / "../../venv/bin") / "python3");
    all.insert(all.end(), {"python3", "/usr/bin/python3"});
    return all;
}

/** Returns the environment in which Python finds the package. */
std::vector<std::string> environmentWith(const fs::path& folder) {
    constexpr std::string_view name = "PYTHONPATH=";
    std::vector<std::string> all;
    std::string path = std::string(name) + folder.string();
    for (char** entry = environ; *entry; ++entry)
        if (std::string_view(*entry).starts_with(name))
            path += ":" + std::string(*entry).substr(name.size());
        else
            all.emplace_back(*entry);
    all.push_back(path);
    return all;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

/** Reads a pipe to its end of file. */
std::string readAll(int descriptor) {
    std::string text;
    char bytes[4096];
    for (ssize_t count; (count = read(descriptor, bytes, sizeof bytes)) != 0;) {
        if (count < 0 && errno != EINTR) break;
        if (count > 0) text.append(bytes, static_cast<size_t>(count));
    }
    return text;
}

struct Outcome {
    int code = 0;        ///< Exit code; minus the number of the signal that ended it.
    std::string errors;  ///< Its standard error.
};

/** Runs the package with one Python; its standard output is that of this process. */
Outcome runWith(const std::string& python, const std::vector<std::string>& options, const fs::path& folder) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::vector<std::string> words = {python, "-B", "-m", package_name};  // -B: nothing is compiled into its folder
    words.insert(words.end(), options.begin(), options.end());
    std::vector<std::string> environment = environmentWith(folder);
    console::flushResults();
    pid_t process = -1;
    const int error = posix_spawnp(&process, python.c_str(), &actions, nullptr, pointersTo(words).data(),
                                   pointersTo(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    Outcome outcome{.code = no_program, .errors = {}};
    if (error == 0) {
        outcome.errors = readAll(ends[0]);
        int status = 0;
        while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
        }
        outcome.code = WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
    }
    close(ends[0]);
    return outcome;
}

/** Returns how to install the packages: in a build folder, in a wheel (an archive has bin/insonify), elsewhere. */
std::string remedy() {
    const fs::path around = packageFolder().parent_path().parent_path().parent_path();
    std::error_code none;
    if (fs::exists(around / "build.ninja", none)) return "`scripts/setup worlds` installs them";
    if (fs::exists(around / "__init__.py", none) && !fs::exists(around.parent_path() / "bin/insonify", none))
        return "`pip install 'insonify[worlds]'` installs them";
    return fmt::format(
        "`python3 -m venv ~/worlds && ~/worlds/bin/pip install numpy pyyaml manifold3d` installs them, and "
        "{}=~/worlds/bin/python3 names that Python",
        python_variable);
}

std::string withoutLineEnd(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
}

}  // namespace

void generate(const std::vector<std::string>& options) {
    const fs::path folder = packageFolder();
    const std::vector<std::string> tried = pythons();
    for (const std::string& python : tried) {
        const Outcome outcome = runWith(python, options, folder);
        if (outcome.code == no_program || outcome.code == lacks_packages) continue;
        if (outcome.code == 2) throw types::ConfigError("", "", withoutLineEnd(outcome.errors));
        if (outcome.code != 0)
            throw std::runtime_error(
                fmt::format("{} ended with {}: {}", python, outcome.code, withoutLineEnd(outcome.errors)));
        console::addDiagnostic(outcome.errors);
        return;
    }
    throw types::ConfigError("", "scene make",
                             fmt::format("needs a Python 3 with numpy, PyYAML and manifold3d, which {} {} not; {}",
                                         fmt::join(tried, " and "), tried.size() == 1 ? "is" : "are", remedy()));
}

std::string generatorDigest() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(packageFolder() / package_name))
        if (entry.path().extension() == ".py") files.push_back(entry.path());
    std::ranges::sort(files);
    types::Sha256 hash;
    for (const fs::path& file : files) hash.add(types::sha256OfFile(file) + "\n");
    return hash.hex();
}

}  // namespace insonify::worlds
