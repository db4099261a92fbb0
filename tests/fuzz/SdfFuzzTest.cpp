#include "tests/fuzz/SceneDoor.hpp"

namespace insonify::fuzz {
namespace {

TEST(SdfFuzzTest, EveryWorldIsASoundSceneOrAnError) {
    push({"sdf",
          "case.world",
          {"<model name='m'>",
           "</model>",
           "<link name='l'/>",
           "<frame name='f' attached_to='m'/>",
           "<include><uri>model://a</uri></include>",
           "<pose relative_to='f'>1 0 0 0 0 0</pose>",
           "<box><size>1 1 1</size></box>",
           "<plane/>",
           "<heightmap/>",
           "<joint name='j' type='fixed'>",
           "<static>true</static>",
           "<!--",
           "-->",
           "<![CDATA[",
           "]]>",
           "&#0;",
           "::",
           "__root__",
           "<sdf version='1.2'>",
           "<robot name='r'>",
           "<link",
           "/>",
           "<insonify:acoustics>",
           "<?xml",
           "'",
           "nan"},
          readScene});
}

}  // namespace
}  // namespace insonify::fuzz
