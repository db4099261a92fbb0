#include <gtest/gtest.h>

#include "components/viewer/Session.hpp"

namespace insonify::viewer {
namespace {

Frame frame(const char* text) { return {"", toBytes(text), true}; }
std::string toText(const std::optional<Frame>& frame) { return frame ? *frame->body : "nothing"; }

TEST(SendQueueTest, KeepsOnlyTheNewestFrameOfAStreamAndCountsTheOthers) {
    SendQueue outbox;
    outbox.put(1, frame("old"));
    outbox.put(2, frame("other"));
    outbox.put(1, frame("newer"));
    outbox.put(1, frame("newest"));
    EXPECT_EQ(toText(outbox.next()), "newest");
    EXPECT_EQ(toText(outbox.next()), "other");
    EXPECT_EQ(toText(outbox.next()), "nothing");
    EXPECT_EQ(outbox.dropped(), 2u);
}

TEST(SendQueueTest, ABusyStreamDoesNotBlockAnother) {
    SendQueue outbox;
    outbox.put(1, frame("busy"));
    outbox.put(2, frame("rare"));
    EXPECT_EQ(toText(outbox.next()), "busy");
    outbox.put(1, frame("busy again"));
    EXPECT_EQ(toText(outbox.next()), "rare");
}

TEST(SendQueueTest, SendsRepliesFirstAndRefusesTooMany) {
    SendQueue outbox;
    outbox.put(1, frame("stream"));
    for (size_t i = 0; i < SendQueue::max_replies; ++i) EXPECT_TRUE(outbox.post(frame("reply")));
    EXPECT_FALSE(outbox.post(frame("one too many")));
    EXPECT_EQ(toText(outbox.next()), "reply");
    EXPECT_TRUE(outbox.post(frame("now there is room")));
}

TEST(SendQueueTest, ANewerReplyOfAStreamReplacesAWaitingReply) {
    SendQueue outbox;
    EXPECT_TRUE(outbox.post(frame("reply")));
    for (size_t i = 0; i < SendQueue::max_replies; ++i) EXPECT_TRUE(outbox.post(frame("scene"), 1));
    EXPECT_TRUE(outbox.post(frame("newest scene"), 1));
    EXPECT_TRUE(outbox.post(frame("other scene"), 2));
    outbox.put(1, frame("what moves"));
    EXPECT_EQ(toText(outbox.next()), "reply");
    EXPECT_EQ(toText(outbox.next()), "newest scene");
    outbox.forget(2);
    EXPECT_EQ(toText(outbox.next()), "what moves");
    EXPECT_EQ(toText(outbox.next()), "nothing");
    EXPECT_EQ(outbox.dropped(), 0u) << "a whole scene includes all of an older scene";
}

}  // namespace
}  // namespace insonify::viewer
