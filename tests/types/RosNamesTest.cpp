#include <gtest/gtest.h>

#include <random>

#include "types/text/RosNames.hpp"

namespace insonify::types {
namespace {

RosNames namesIn(const std::string& ros_namespace, const std::string& prefix = "") {
    RosNames names;
    EXPECT_TRUE(names.setNamespace(ros_namespace)) << ros_namespace;
    EXPECT_TRUE(names.setFramePrefix(prefix)) << prefix;
    return names;
}

/** A name of one to three random words. */
std::string randomName(std::mt19937& random) {
    std::string name;
    for (unsigned word = random() % 3 + 1; word > 0; --word) {
        name += name.empty() ? "" : "/";
        name += static_cast<char>('a' + random() % 26);
        for (unsigned length = random() % 5; length > 0; --length) name += "abz_019"[random() % 7];
    }
    return name;
}

}  // namespace

TEST(RosNamesTest, NamesStayUnchangedWithoutANamespace) {
    for (const char* none : {"", "/"}) {
        const RosNames names = namesIn(none, "");
        for (const char* name : {"sonar", "/auv/sonar", "auv/sonar"}) {
            EXPECT_EQ(names.topic(name), name);
            EXPECT_EQ(names.node(name), name);
            EXPECT_EQ(names.frame(name), name);
        }
    }
}

TEST(RosNamesTest, OnlyRelativeNamesAreInTheNamespace) {
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const std::string space = randomName(random), name = randomName(random);
        const RosNames names = namesIn((i % 2 ? "/" : "") + space);
        EXPECT_EQ(names.topic(name), "/" + space + "/" + name);
        EXPECT_EQ(names.node(name), "/" + space + "/" + name);
        EXPECT_EQ(names.topic("/" + name), "/" + name);
        EXPECT_EQ(names.node("/" + name), "/" + name);
        EXPECT_TRUE(isRosName(names.topic(name)));
    }
}

TEST(RosNamesTest, AFramePrefixIsAddedOnceAndEndsInOneSlash) {
    for (const char* prefix : {"auv1", "auv1/"}) {
        const RosNames names = namesIn("", prefix);
        EXPECT_EQ(names.frame("base_link"), "auv1/base_link");
        EXPECT_EQ(names.frame(names.frame("base_link")), "auv1/base_link");
        EXPECT_EQ(names.frame("auv10"), "auv1/auv10");
    }
}

TEST(RosNamesTest, InvalidNamespacesAndPrefixesChangeNothing) {
    RosNames names = namesIn("a", "b");
    for (const char* bad : {"1a", "a b", "a//b", "a/", "//a", "a-b", "~a"})
        EXPECT_FALSE(names.setNamespace(bad)) << bad;
    for (const char* bad : {"/a", "1a", "a b", "a//", "a-b", "//"}) EXPECT_FALSE(names.setFramePrefix(bad)) << bad;
    EXPECT_EQ(names.ros_namespace, "/a");
    EXPECT_EQ(names.frame_prefix, "b/");
}

TEST(RosNamesTest, TheFirstMatchingRemapApplies) {
    RosNames names = namesIn("auv1");
    names.remaps = {
        {"other", "sonar", "/wrong"}, {"", "/auv1/sonar", "fan"}, {"", "sonar", "/late"}, {"ros", "/x", "y/z"}};
    EXPECT_EQ(names.topic("sonar", "/auv1/ros"), "/auv1/fan");
    EXPECT_EQ(names.topic("sonar", "/auv1/other"), "/wrong");
    EXPECT_EQ(names.topic("/auv1/sonar"), "/auv1/fan");
    EXPECT_EQ(names.topic("/x", "/auv1/ros"), "/auv1/y/z");
    EXPECT_EQ(names.topic("/x", "/auv1/other"), "/x");
    EXPECT_EQ(names.topic("sonar/scan"), "/auv1/sonar/scan");
    names.ros_namespace.clear();
    EXPECT_EQ(names.topic("sonar"), "/late") << "/auv1/sonar is another topic now";
}

TEST(RosNamesTest, ATildeIsTheNameOfTheNode) {
    RosNames names;
    EXPECT_EQ(names.topic("~/sonar", "ros"), "/ros/sonar");
    EXPECT_EQ(names.topic("~/sonar", "/auv/ros"), "/auv/ros/sonar");
    names = namesIn("auv1");
    EXPECT_EQ(names.topic("~/sonar", names.node("ros")), "/auv1/ros/sonar");
    names.remaps = {{"", "~/sonar", "fan"}, {"", "ros/state", "~/phase"}, {"other", "~/x", "/wrong"}};
    EXPECT_EQ(names.topic("~/sonar", "/auv1/ros"), "/auv1/fan");
    EXPECT_EQ(names.topic("/auv1/ros/sonar", "/auv1/ros"), "/auv1/fan") << "written out";
    EXPECT_EQ(names.topic("~/sonar", "/auv1/other"), "/auv1/fan");
    EXPECT_EQ(names.topic("/auv1/ros/sonar", "/auv1/other"), "/auv1/ros/sonar") << "another node's";
    EXPECT_EQ(names.topic("~/state", "/auv1/ros"), "/auv1/ros/phase");
    EXPECT_EQ(names.topic("~/x", "/auv1/ros"), "/auv1/ros/x");
}

}  // namespace insonify::types
