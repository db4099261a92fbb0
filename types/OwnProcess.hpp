#pragma once

namespace insonify::types {

/** Remembers the process in which it was made, for objects that own threads: threads do not follow a fork, so that a
 *  forked child would wait for them for ever. */
class OwnProcess {
public:
    OwnProcess();

    /** Whether this is a child that was forked after the object was made. */
    bool isForked() const;
    /** Throws std::runtime_error with the remedy if isForked(); `what` is the subject of its sentence. */
    void require(const char* what) const;

private:
    unsigned generation_;
};

}  // namespace insonify::types
