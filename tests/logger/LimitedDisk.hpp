#pragma once
// A logger on a disk that is nearly full.
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "components/logger/LoggerTask.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::logger {

/** Logs texts until the task fails, at most 5000. */
void logUntilFailure(LoggerTask& task, test::Writer<std::string>& source, auto&& text) {
    for (int i = 0; i < 5000 && task.state() == framework::TaskState::Running; ++i) {
        source.port.write(text());
        task.update();
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
}

/** Logs texts to a file limited to 50000 bytes; exits 0 when the task ends in Exception and its error has `words`. With
 *  a queue of one sample the file is flushed every few samples, for any order of the threads. */
[[noreturn]] void fillLimitedDisk(const std::filesystem::path& file, auto&& text, const std::string& words = "") {
    const rlimit limit{50000, 50000};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    LoggerTask task("log");
    task.environment().output_folder = file.parent_path();
    LoggerConfig config;
    config.file = file.filename();
    config.flush_period = 0.001;
    config.queue = 1;
    task.config.set(config);
    test::Writer<std::string> source;
    source.port.connectTo(*task.makeInput("in", source.port), framework::ConnPolicy::buffer(10));
    task.configure();
    task.start();
    logUntilFailure(task, source, text);
    const bool reported = task.lastError().find(words) != std::string::npos;
    std::_Exit(task.state() == framework::TaskState::Exception && reported ? 0 : 1);
}

}  // namespace insonify::logger
