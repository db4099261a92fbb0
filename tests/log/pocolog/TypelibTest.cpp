#include <gmock/gmock.h>

#include <vector>

#include "components/log/pocolog/Typelib.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::log::pocolog {
namespace {

using testing::HasSubstr;

template <class T>
std::vector<size_t> getOffsets() {
    std::vector<size_t> offsets;
    Extent extent;
    forEachField<T>([&]<class F>(const types::Field&, F&) { offsets.push_back(extent.append(getExtent<F>())); });
    return offsets;
}

TEST(TypelibTest, SonarHasRocksOffsetsAndSize) {
    EXPECT_THAT(getOffsets<types::Sonar>(), testing::ElementsAre(0, 8, 32, 40, 48, 56, 80, 84, 88, 96));
    EXPECT_EQ(getExtent<types::Sonar>().size, 120u);
}

TEST(TypelibTest, RigidBodyStateHasRocksOffsetsAndSize) {
    EXPECT_THAT(getOffsets<types::Pose>(), testing::ElementsAre(0, 8, 40, 72, 96, 168, 200, 272, 296, 368, 392));
    EXPECT_EQ(getExtent<types::Pose>().size, 464u);
}

TEST(TypelibTest, FrameHasRocksOffsetsAndSize) {
    EXPECT_THAT(getOffsets<types::Image>(), testing::ElementsAre(0, 8, 16, 40, 64, 68, 72, 76, 80, 84));
    EXPECT_EQ(getExtent<types::Image>().size, 88u);
}

TEST(TypelibTest, NavigationReadingsHaveRocksOffsets) {
    EXPECT_THAT(getOffsets<types::ImuSensors>(), testing::ElementsAre(0, 8, 32, 56));
    EXPECT_EQ(getExtent<types::ImuSensors>().size, 80u);
    EXPECT_EQ(typelibName<types::ImuSensors>(), "/base/samples/IMUSensors_m") << "of Eigen's vectors";
    EXPECT_THAT(getOffsets<types::Pressure>(), testing::ElementsAre(0, 8)) << "its base class first";
    EXPECT_EQ(getExtent<types::Pressure>().size, 16u);
    EXPECT_EQ(typelibName<types::Pressure>(), "/base/samples/Pressure");
}

TEST(TypelibTest, ScansAndBeamsHaveRocksOffsetsAndSize) {
    EXPECT_THAT(getOffsets<types::SonarBeam>(), testing::ElementsAre(0, 8, 16, 24, 28, 32, 40));
    EXPECT_EQ(getExtent<types::SonarBeam>().size, 64u);
    EXPECT_THAT(getOffsets<types::SonarScan>(),
                testing::ElementsAre(0, 8, 32, 56, 58, 64, 72, 80, 88, 96, 104, 112, 113));
    EXPECT_EQ(getExtent<types::SonarScan>().size, 120u);
}

TEST(TypelibTest, OnlyTypesWithOpaquesHaveASuffixAndOnlyOnTheLog) {
    EXPECT_EQ(typelibName<types::Pose>(), "/base/samples/RigidBodyState_m");
    EXPECT_EQ(cxxName<types::Pose>(), "/base/samples/RigidBodyState");
    EXPECT_EQ(typelibName<std::vector<types::Pose>>(), "/std/vector</base/samples/RigidBodyState_m>");
    EXPECT_EQ(typelibName<types::Sonar>(), "/base/samples/Sonar");
}

TEST(TypelibTest, NumbersHaveTypelibsNormalisedNames) {
    EXPECT_EQ(typelibName<double>(), "/double");
    EXPECT_EQ(typelibName<float>(), "/float");
    EXPECT_EQ(typelibName<int32_t>(), "/int32_t");
    EXPECT_EQ(typelibName<uint8_t>(), "/uint8_t");
    EXPECT_EQ(typelibName<int64_t>(), "/int64_t");
    EXPECT_EQ(typelibName<bool>(), "/bool");
    EXPECT_EQ(typelibName<std::string>(), "/std/string");
}

TEST(TypelibTest, TheRegistryOfSonarIsTheMinimalOneThatRocksReadersAccept) {
    EXPECT_EQ(makeRegistry<types::Sonar>(),
              R"(<?xml version="1.0"?>
<typelib>
  <numeric name="/int64_t" category="sint" size="8"/>
  <compound name="/base/Time" size="8">
    <field name="microseconds" type="/int64_t" offset="0"/>
  </compound>
  <container name="/std/vector&lt;/base/Time&gt;" of="/base/Time" size="24" kind="/std/vector"/>
  <numeric name="/double" category="float" size="8"/>
  <compound name="/base/Angle" size="8">
    <field name="rad" type="/double" offset="0"/>
  </compound>
  <container name="/std/vector&lt;/base/Angle&gt;" of="/base/Angle" size="24" kind="/std/vector"/>
  <numeric name="/float" category="float" size="4"/>
  <numeric name="/uint32_t" category="uint" size="4"/>
  <container name="/std/vector&lt;/float&gt;" of="/float" size="24" kind="/std/vector"/>
  <compound name="/base/samples/Sonar" size="120">
    <field name="time" type="/base/Time" offset="0"><metadata key="role"><![CDATA[logical_time]]></metadata></field>
    <field name="timestamps" type="/std/vector&lt;/base/Time&gt;" offset="8"/>
    <field name="bin_duration" type="/base/Time" offset="32"/>
    <field name="beam_width" type="/base/Angle" offset="40"/>
    <field name="beam_height" type="/base/Angle" offset="48"/>
    <field name="bearings" type="/std/vector&lt;/base/Angle&gt;" offset="56"/>
    <field name="speed_of_sound" type="/float" offset="80"/>
    <field name="bin_count" type="/uint32_t" offset="84"/>
    <field name="beam_count" type="/uint32_t" offset="88"/>
    <field name="bins" type="/std/vector&lt;/float&gt;" offset="96"/>
  </compound>
</typelib>
)");
}

TEST(TypelibTest, TheRegistryOfAPoseHasTheWrappersOfEigen) {
    const std::string xml = makeRegistry<types::Pose>();
    EXPECT_THAT(xml, HasSubstr("<compound name=\"/wrappers/Matrix&lt;/double,3,1&gt;\" size=\"24\">\n"
                               "    <field name=\"data\" type=\"/double[3]\" offset=\"0\"/>"));
    EXPECT_THAT(xml, HasSubstr("<compound name=\"/wrappers/Matrix&lt;/double,3,3&gt;\" size=\"72\">\n"
                               "    <field name=\"data\" type=\"/double[9]\" offset=\"0\"/>"));
    EXPECT_THAT(xml, HasSubstr("<field name=\"im\" type=\"/double[3]\" offset=\"0\"/>\n"
                               "    <field name=\"re\" type=\"/double\" offset=\"24\"/>"));
    EXPECT_THAT(xml, HasSubstr("<container name=\"/std/string\" of=\"/int8_t\" size=\"32\" kind=\"/std/string\"/>"));
    EXPECT_THAT(xml, testing::Not(HasSubstr("<array")));
}

TEST(TypelibTest, TheRegistryOfAFrameListsTheSymbolsOfItsEnums) {
    const std::string xml = makeRegistry<types::Image>();
    EXPECT_THAT(xml, HasSubstr("<enum name=\"/base/samples/frame/frame_mode_t\">"));
    EXPECT_THAT(xml, HasSubstr("<value symbol=\"MODE_BGR\" value=\"4\"/>"));
    EXPECT_THAT(xml, HasSubstr("<value symbol=\"STATUS_INVALID\" value=\"2\"/>"));
}

}  // namespace
}  // namespace insonify::log::pocolog
