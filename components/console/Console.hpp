#pragma once
#include <fmt/core.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace insonify::console {

// What a process prints: results to the standard output, diagnostics to the standard error. Nothing is thrown, and no
// console ends the process: text that cannot be written is counted and dropped.

/** Ignores the signals of a closed pipe and of a file beyond its limit, which then are errors of the write, and opens
 *  closed standard streams, so that no file of a run gets their numbers. Call it first. */
void prepareConsole() noexcept;

/** From here on, a thread prints diagnostics: no caller waits for a stopped terminal or a full pipe. Its queue holds
 *  256 KiB; lines beyond are counted and dropped. Call it before threads with priorities start. */
void startPrinting() noexcept;

/** Waits for the diagnostics in the queue while they are read, at most 10 s without a byte. */
void finishPrinting() noexcept;

/** Adds to the results, after the diagnostics so far. They are written when 64 KiB have come together, at each call on
 * a terminal, and by flushResults(). */
void addResult(std::string_view text) noexcept;
/** Writes the results so far. Returns why some could not be written; empty: all are. */
std::string flushResults() noexcept;

void addDiagnostic(std::string_view text) noexcept;

/** Replaces the last line of the terminal that the standard error is; an empty text wipes it. */
void showProgress(std::string_view text) noexcept;

/** Counts a text that could not even be made. */
void dropText() noexcept;
/** Returns the number of diagnostics that were not printed so far. */
uint64_t droppedDiagnostics() noexcept;

template <class... T>
void printResult(fmt::format_string<T...> format, T&&... values) noexcept try {
    addResult(fmt::format(format, std::forward<T>(values)...));
} catch (...) {
    dropText();
}

template <class... T>
void printDiagnostic(fmt::format_string<T...> format, T&&... values) noexcept try {
    addDiagnostic(fmt::format(format, std::forward<T>(values)...));
} catch (...) {
    dropText();
}

/** Returns a text as a word of the shell: in quotes if it has letters with a meaning there. */
std::string shellWord(const std::string& text);

}  // namespace insonify::console
