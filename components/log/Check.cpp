#include "components/log/Check.hpp"

#include "components/log/Reader.hpp"

namespace insonify::log {

Verdict check(const std::filesystem::path& path) {
    if (storageOf(path) == Storage::Pocolog && !std::filesystem::is_directory(path)) return pocolog::check(path);
    const auto log = openLog(path);
    Verdict verdict{log->streams().size(), 0, 0, {}};
    for (const Stream& stream : log->streams()) verdict.set_backs += stream.set_backs;
    for (const SampleRef& at : log->samples()) {
        try {
            log->verify(at);
        } catch (const types::ConfigError& error) {
            verdict.diagnostic = {path, at.position, error.diagnostics().front().message};
            return verdict;
        }
        ++verdict.samples;
    }
    if (!log->complete()) verdict.diagnostic = {path, log->gaps().front().byte, log->gaps().front().what};
    return verdict;
}

}  // namespace insonify::log
