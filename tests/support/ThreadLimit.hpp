#pragma once
// A system that permits a limited number of threads, as a container does. Needs support/ThreadLimit.cpp as a source.
//
//     const ThreadLimit limit(3);  // the fourth thread from here on is refused

namespace insonify::test {

class ThreadLimit {
public:
    explicit ThreadLimit(int permitted);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;
};

}  // namespace insonify::test
