// `insonify gazebo`: sonars that a world's SDF describes, as programs of Gazebo Fortress read them.
#include <gmock/gmock.h>
#include <ignition/msgs/float_v.pb.h>
#include <ignition/msgs/image.pb.h>
#include <ignition/msgs/laserscan.pb.h>
#include <ignition/msgs/pointcloud_packed.pb.h>
#include <ignition/msgs/sdf_generator_config.pb.h>
#include <ignition/msgs/stringmsg.pb.h>
#include <signal.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <random>

#include "components/gazebo/Subscriptions.hpp"
#include "components/sdf/Sdf.hpp"
#include "tests/deployer/Command.hpp"
#include "tests/gazebo/FortressScene.hpp"
#include "tests/gazebo/FortressWorld.hpp"
#include "tests/support/Paths.hpp"

using namespace insonify;
using namespace insonify::deployer;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

const std::string properties =
    "<range>30</range><beam_count>64</beam_count><bin_count>200</bin_count><field_of_view_deg>120</field_of_view_deg>"
    "<beam_height_deg>20</beam_height_deg><water><depth>5</depth></water><noise><seed>7</seed></noise>";

/** The sensor of a sonar; `prefix` is gz, or ignition for Fortress. */
std::string sensor(const std::string& name, const std::string& block, const std::string& rest,
                   const std::string& prefix = "gz") {
    return "\n<sensor name='" + name + "' type='custom' " + prefix + ":type='insonify'>" + rest + "<" + prefix +
           ":insonify>" + block + "</" + prefix + ":insonify></sensor>\n";
}

/** The file of two vehicles with elements added to a link of red. */
std::string worldWith(const std::string& elements) {
    std::string text = readFile(test::sourceFile("deploy/scenes/two_vehicles.world"));
    const size_t old = text.find("<sensor");
    text.erase(old, text.find("</sensor>") + 9 - old);
    const size_t link = text.find("</link>", text.find("<model name=\"red\">"));
    return text.insert(link, elements);
}

/** Gives models and links numbers, as Gazebo does. */
void number(ignition::msgs::Scene& scene) {
    uint32_t next = 10;
    for (ignition::msgs::Model& model : *scene.mutable_model()) {
        model.set_id(next++);
        for (ignition::msgs::Link& link : *model.mutable_link()) link.set_id(next++);
    }
}

/** Keeps the messages of a topic. */
template <class Message>
struct Reader {
    Reader(ignition::transport::Node& node, const std::string& topic) {
        std::function<void(const Message&)> take = [this](const Message& message) {
            const std::lock_guard lock(mutex);
            messages.push_back(message);
        };
        EXPECT_TRUE(node.Subscribe(topic, take));
    }
    size_t count() const {
        const std::lock_guard lock(mutex);
        return messages.size();
    }
    mutable std::mutex mutex;
    std::vector<Message> messages;
};

std::map<std::string, std::vector<std::string>> header(const auto& message) {
    std::map<std::string, std::vector<std::string>> data;
    for (const auto& entry : message.header().data()) data[entry.key()] = {entry.value().begin(), entry.value().end()};
    return data;
}

std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> all;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) all.push_back(line);
    return all;
}

double stamp(const auto& message) {
    return static_cast<double>(message.header().stamp().sec()) + message.header().stamp().nsec() * 1e-9;
}

struct GazeboSensorTest : gazebo::OwnPartition {
    GazeboSensorTest() {
        world.serve("/world/two_vehicles/scene/info", [this](ignition::msgs::Scene& scene) {
            scene = gazebo::makeScene(test::sourceFile("deploy/scenes/two_vehicles.world"));
            number(scene);
            const std::lock_guard lock(mutex);
            described = scene;
            return true;
        });
    }
    /** Publishes the poses of all models and links by their numbers; red has moved by `x`. */
    void publish(double seconds, double x) {
        const std::lock_guard lock(mutex);
        ignition::msgs::Pose_V message;
        gazebo::setStamp(*message.mutable_header(), seconds);
        const auto add = [&](const auto& entity, double moved) {
            ignition::msgs::Pose& pose = *message.add_pose();
            pose = entity.pose();
            pose.set_name(entity.name());
            pose.set_id(entity.id());
            pose.mutable_position()->set_x(pose.position().x() + moved);
        };
        for (const ignition::msgs::Model& model : described.model()) {
            add(model, model.name() == "red" ? x : 0);
            for (const ignition::msgs::Link& link : model.link()) add(link, 0);
        }
        world.send(message);
    }
    fs::path write(const std::string& text) const {
        writeFile(folder / "w.world", text);
        return folder / "w.world";
    }
    Outcome call(const std::string& text, std::vector<std::string> more = {}) const {
        write(text);
        std::vector<std::string> words{"gazebo", "w.world", "--timeout", "20"};
        words.insert(words.end(), more.begin(), more.end());
        return callInsonify(folder, words);
    }

    std::mutex mutex;
    ignition::msgs::Scene described;
    gazebo::FortressWorld world{"/world/two_vehicles/pose/info"};
    ignition::transport::Node node;
    TestFolder folder;
};

}  // namespace

TEST_F(GazeboSensorTest, ASonarOfTheWorldIsReadOnGazebosTopicsInSimulatedTime) {
    const Reader<ignition::msgs::Float_V> pings(node, "/red/sonar");
    const Reader<ignition::msgs::LaserScan> scans(node, "/red/sonar/scan");
    const Reader<ignition::msgs::PointCloudPacked> points(node, "/red/sonar/points");
    const Reader<ignition::msgs::Image> pictures(node, "/red/sonar/image");
    write(worldWith(sensor("fls", properties,
                           "<pose>1.1 0 -0.1 0 0.1 0</pose><update_rate>10</update_rate><topic>/red/sonar</topic>")));
    const Process sonar(
        insonifyWords({"gazebo", "w.world", "--out", "out", "--set", "red_hull_fls_scene.pose_timeout=60"}),
        folder.path());
    int sent = 0;
    const auto step = [&] {
        ++sent;
        publish(0.02 * sent, 0.002 * sent);  // the simulation runs at half the speed of the wall clock
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
    };
    const bool came = gazebo::becomesTrue([&] {
        step();
        return std::min({pings.count(), scans.count(), points.count(), pictures.count()}) >= 8;
    });
    EXPECT_TRUE(came) << readFile(folder / "stderr.txt");
    const size_t before = pings.count();
    for (int i = 0; i < 20; ++i) {  // a paused simulation
        publish(0.02 * sent, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
    }
    EXPECT_LE(pings.count(), before + 2);
    sonar.signal(SIGINT);
    ASSERT_THAT(sonar.wait(), succeeds());
    if (!came) return;

    for (const auto& ping : pings.messages) {
        auto data = header(ping);
        EXPECT_EQ(data["frame_id"], std::vector<std::string>{"red::hull::fls"});
        EXPECT_EQ(data["beam_count"], std::vector<std::string>{"64"});
        EXPECT_EQ(data["bin_count"], std::vector<std::string>{"200"});
        EXPECT_EQ(data["bearings"].size(), 64u);
        EXPECT_EQ(ping.data_size(), 64 * 200);
        EXPECT_GT(*std::max_element(ping.data().begin(), ping.data().end()), 0);
        EXPECT_GE(stamp(ping), 0);
        EXPECT_LE(stamp(ping), 0.02 * sent + 0.1);
    }
    for (size_t i = 1; i < pings.messages.size(); ++i)
        EXPECT_GT(stamp(pings.messages[i]) - stamp(pings.messages[i - 1]), 0.07) << "10 Hz of simulated time";
    const auto& scan = scans.messages.back();
    EXPECT_EQ(scan.count(), 64u);
    EXPECT_EQ(scan.ranges_size(), 64);
    EXPECT_NEAR(scan.angle_max() - scan.angle_min(), 120 * M_PI / 180, 0.1);
    size_t returns = 0;
    for (const double range : scan.ranges()) returns += std::isfinite(range) && range > 0 && range < 30;
    EXPECT_GT(returns, 10u);
    EXPECT_GT(points.messages.back().width(), 10u);
    EXPECT_EQ(points.messages.back().data().size(), size_t(points.messages.back().row_step()));
    const auto& picture = pictures.messages.back();
    EXPECT_EQ(picture.pixel_format_type(), ignition::msgs::BGR_INT8);
    EXPECT_EQ(picture.data().size(), size_t(picture.step()) * picture.height());
}

TEST_F(GazeboSensorTest, EachVehicleHasItsSonarAndAResetBeginsAnew) {
    const Reader<ignition::msgs::Float_V> red(node, "/red/sonar"),
        blue(node, "/world/two_vehicles/model/blue/link/hull/sensor/s/insonify");
    std::string text = worldWith(sensor("fls", properties, "<update_rate>10</update_rate><topic>/red/sonar</topic>"));
    text.insert(text.find("</link>", text.find("<model name=\"blue\">")),
                sensor("s", properties, "<update_rate>5</update_rate>"));
    write(text);
    const Process sonar(
        insonifyWords({"gazebo", "w.world", "--out", "out", "--set", "red_hull_fls_scene.pose_timeout=60", "--set",
                       "blue_hull_s_scene.pose_timeout=60"}),
        folder.path());
    int sent = 0;
    const auto step = [&] {
        ++sent;
        publish(100 + 0.02 * sent, 0.002 * sent);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    };
    const bool came = gazebo::becomesTrue([&] { return step(), red.count() > 5 && blue.count() > 3; });
    EXPECT_TRUE(came) << readFile(folder / "stderr.txt");
    sent = -5000;  // the simulation begins anew, at 0 s
    const auto isAnew = [](const auto& reader) {
        const std::lock_guard lock(reader.mutex);
        return !reader.messages.empty() && stamp(reader.messages.back()) < 50;
    };
    EXPECT_TRUE(gazebo::becomesTrue([&] { return step(), isAnew(red) && isAnew(blue); }));
    sonar.signal(SIGINT);
    ASSERT_THAT(sonar.wait(), succeeds());
    ASSERT_TRUE(came);
    EXPECT_EQ(header(red.messages.front())["frame_id"], std::vector<std::string>{"red::hull::fls"});
    EXPECT_EQ(header(blue.messages.front())["frame_id"], std::vector<std::string>{"blue::hull::s"});
    const auto& pings = red.messages;
    EXPECT_NE(std::vector<float>(pings.front().data().begin(), pings.front().data().end()),
              std::vector<float>(blue.messages.front().data().begin(), blue.messages.front().data().end()));
}

TEST_F(GazeboSensorTest, AWorldThatRunsIsAskedForItsSdf) {
    const std::string text = worldWith(sensor("fls", properties, "<update_rate>5</update_rate>", "ignition"));
    ignition::transport::Node server;
    std::function<bool(const ignition::msgs::SdfGeneratorConfig&, ignition::msgs::StringMsg&)> answer =
        [&](const ignition::msgs::SdfGeneratorConfig& asked, ignition::msgs::StringMsg& reply) {
            EXPECT_TRUE(asked.global_entity_gen_config().expand_include_tags().data());
            reply.set_data(text);
            return true;
        };
    ASSERT_TRUE(server.Advertise("/world/two_vehicles/generate_world_sdf", answer));
    const Outcome outcome = callInsonify(folder, {"gazebo", "two_vehicles", "--print", "--timeout", "20"});
    ASSERT_THAT(outcome, succeeds());
    for (const char* part : {"entity: \"red::hull\", period: 0.2", "entity: \"mooring::float\", period: 0.2",
                             "topic: \"/world/two_vehicles/model/red/link/hull/sensor/fls/insonify\"", "range: 30",
                             "beam_count: 64", "{from: world.model_blue, to: \"red_hull_fls_scene.blue.pose\"}"})
        EXPECT_THAT(outcome.out, HasSubstr(part));
    EXPECT_THAT(outcome.out, Not(HasSubstr("pose_timeout")));
    writeFile(folder / "a.yml", outcome.out);
    EXPECT_THAT(callInsonify(folder, {"check", "a.yml"}), succeeds()) << outcome.out;

    const auto print = [&](const std::string& rates) { return call(worldWith(rates), {"--print"}).out; };
    const std::string slow = sensor("slow", properties, "<update_rate>0.5</update_rate>");
    EXPECT_THAT(print(slow), AllOf(HasSubstr("entity: \"blue\", period: 2}"), HasSubstr("pose_timeout: 4\n")));
    EXPECT_THAT(print(slow + sensor("all", properties, "")), HasSubstr("entity: \"blue\", period: 0}"));
}

TEST_F(GazeboSensorTest, EveryKindOfSonarAndAnyNamesMakeADeployment) {
    const std::string rest = "<update_rate>2</update_rate>", beam = "<range>20</range><noise><seed>3</seed></noise>";
    std::string sensors, other;
    int number = 0;
    for (const char* kind :
         {"SonarTask", "ScanningSonarTask", "SideScanTask", "ProfilerTask", "AltimeterTask", "Sonar3dTask"})
        sensors += sensor("s" + std::to_string(++number), "<type>sonar::" + std::string(kind) + "</type>" + beam, rest);
    for (const char* name : {"a b", "a_b_scene", "it&apos;s, {1}: #2", "\xC3\xA4"}) sensors += sensor(name, beam, rest);
    std::string text = worldWith(sensors);
    for (const char* name : {"my rov, 2", "my_rov_2", "{x}: y"})
        other += "<model name='" + std::string(name) + "'><link name='l'/></model>";
    text.insert(text.find("</world>"), other);
    write(text);
    const Outcome outcome = callInsonify(folder, {"gazebo", "w.world", "--print", "--ros"});
    ASSERT_THAT(outcome, succeeds());
    const scene::WorldSonars found = insonify::sdf::readSonars(folder / "w.world");
    EXPECT_EQ(found.sonars.size(), 10u);
    writeFile(folder / "a.yml", outcome.out);
    const Outcome checked = callInsonify(folder, {"check", "a.yml"});
    // The models that Gazebo does not have are the only errors.
    EXPECT_THAT(checked.err, Not(HasSubstr("is not a key"))) << outcome.out;
    for (const std::string& line : lines(checked.err))
        EXPECT_THAT(line, testing::AnyOf(HasSubstr("my rov, 2"), HasSubstr("my_rov_2"), HasSubstr("{x}: y"),
                                         HasSubstr("notice"), HasSubstr("warning"),
                                         HasSubstr("dds::PublisherTask, which needs the component library dds")))
            << outcome.out;
}

TEST_F(GazeboSensorTest, WrongSensorsAreRefusedWithTheirPlace) {
    const std::string rate = "<update_rate>10</update_rate>";
    const std::vector<std::pair<std::string, std::string>> wrong{
        {sensor("fls", "<rnge>30</rnge>", rate), "red::hull::fls.rnge: is not a key here; did you mean range?"},
        {sensor("fls", "<range>-3</range>", rate), "red::hull::fls.range: is -3"},
        {sensor("fls", "<range>far</range>", rate), "red::hull::fls.range: is far"},
        {sensor("fls", "<noise><sed>1</sed></noise>", rate), "red::hull::fls.noise.sed: is not a key here"},
        {sensor("fls", "<type>sonar::SonarTsk</type>", rate), "sonar::SonarTsk"},
        {sensor("fls", "<range>1 2</range>", rate), "red::hull::fls.range: is"},
        {sensor("fls", properties, "<update_rate>-1</update_rate>"), "red::hull::fls.update_rate: is -1 Hz"},
        {sensor("fls", properties, "<update_rate>1e9</update_rate>"), "red::hull::fls.update_rate: is 1000000000 Hz"},
        {sensor("a", properties, "<topic>/s</topic>") + sensor("b", properties, "<topic>/s</topic>"),
         "is /s a second time"},
        {"<sensor name='c' type='camera'><camera/></sensor>",
         "has no sonar, <sensor type=\"custom\" gz:type=\"insonify\">"},
        {"<sensor name='c' type='custom' gz:type='odometer'/>", "its sensors are red::hull::c (odometer)"},
        {sensor("fls", properties, "<update_rate>ten</update_rate>"), "Unable to set value [ten"},
        {sensor("fls", properties, "<pose>nan 0 0 0 0 0</pose>" + rate), "has no sonar"},
        {"", "has no sonar"}};
    for (const auto& [elements, message] : wrong)
        EXPECT_THAT(call(worldWith(elements)), isRefused(AllOf(HasSubstr(message), Not(HasSubstr("is not offered")))));
    EXPECT_THAT(call("<sdf version='1.9'><model name='m'><link name='l'/></model></sdf>"),
                isRefused(HasSubstr("has no <world>")));
    EXPECT_THAT(call("no xml"), isRefused(HasSubstr("w.world")));
    EXPECT_THAT(callInsonify(folder, {"gazebo", "lake", "--timeout", "0.5"}),
                isRefused(HasSubstr("is lake; its service /world/lake/generate_world_sdf is not offered")));
}

TEST_F(GazeboSensorTest, ALinkThatGazeboDoesNotHaveIsNamed) {
    std::string text = worldWith(sensor("fls", properties, "<update_rate>10</update_rate>"));
    const size_t hull = text.find("<link name=\"hull\">", text.find("<model name=\"red\">"));
    text.replace(hull, 18, "<link name=\"hul\">");
    EXPECT_THAT(call(text, {"--pings", "1"}),
                isRefused(HasSubstr("entity: is red::hul, which world two_vehicles does not have; did you mean")));
}

TEST(SonarSensorsTest, ValuesAreListsBlocksAndTexts) {
    const TestFolder folder;
    const std::string block =
        "<type>sonar::ScanningSonarTask</type><a>1 2.5 -3e2</a><b><c>x: y</c><d/></b><e>1</e><e>2</e><e>3</e>"
        "<f>[1, 2]</f><g>it's</g><h> plain text </h>";
    writeFile(folder / "w.world", worldWith(sensor("s", block, "<pose>0 0 0 0 0 1.5707963267948966</pose>")));
    const scene::WorldSonars found = insonify::sdf::readSonars(folder / "w.world");
    ASSERT_EQ(found.sonars.size(), 1u);
    const scene::SonarSensor& sonar = found.sonars[0];
    EXPECT_EQ(sonar.type, "sonar::ScanningSonarTask");
    EXPECT_NEAR(sonar.mount.yaw_deg, 90, 1e-9);
    std::map<std::string, std::string> values;
    for (const auto& setting : sonar.settings) values[setting.path] = setting.value;
    EXPECT_THAT(values, testing::ElementsAre(testing::Pair("a", "[1, 2.5, -3e2]"), testing::Pair("b.c", "'x: y'"),
                                             testing::Pair("b.d", "''"), testing::Pair("e", "[1, 2, 3]"),
                                             testing::Pair("f", "[1, 2]"), testing::Pair("g", "'it''s'"),
                                             testing::Pair("h", "plain text")));
    EXPECT_THAT(found.moving, testing::ElementsAre("mooring", "mooring::float", "red", "blue"));
}

TEST(SonarSensorsTest, LinksMoveThatNoFixedJointAttachesToTheBodyOfTheirModel) {
    const TestFolder folder;
    const auto link = [](const std::string& name) {
        return "<link name='" + name +
               "'><visual name='v'><geometry><box><size>1 1 1</size></box></geometry></visual></link>";
    };
    const auto joint = [](const std::string& type, const std::string& parent, const std::string& child) {
        return "<joint name='to_" + child.substr(0, child.find(':')) + "' type='" + type + "'><parent>" + parent +
               "</parent><child>" + child + "</child>" +
               (type == "fixed" || type == "ball" ? "" : "<axis><xyz>0 0 1</xyz></axis>") + "</joint>";
    };
    const auto model = [](const std::string& name, const std::string& content) {
        return "<model name='" + name + "'>" + content + "</model>";
    };
    const std::string gripper = model("gripper", link("palm") + link("finger") + joint("prismatic", "palm", "finger"));
    const std::string rov = model(
        "rov", link("base") + link("arm") + link("wrist") + link("cage") + "<link name='tether'/>" + gripper +
                   model("lamp", link("bulb")) + joint("revolute", "base", "arm") + joint("fixed", "wrist", "arm") +
                   joint("fixed", "base", "cage") + joint("ball", "cage", "tether") +
                   joint("fixed", "wrist", "gripper::palm") + joint("fixed", "lamp::bulb", "base"));
    const std::string quay = model("quay", "<static>true</static>" + link("stone"));
    const std::string rudder = model("rudder", link("a") + link("b") + joint("fixed", "world", "b"));
    writeFile(folder / "w.world", "<sdf version='1.9'><world name='sea'>" + rov + quay + rudder + "</world></sdf>");
    EXPECT_THAT(insonify::sdf::readSonars(folder / "w.world").moving,
                testing::ElementsAre("rov", "rov::arm", "rov::wrist", "rov::gripper::palm", "rov::gripper::finger",
                                     "rudder", "rudder::b"));
}

TEST(ChainTest, APoseInTheWorldIsTheProductOfThoseOfTheParents) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-10, 10);
    for (int round = 0; round < 200; ++round) {
        gazebo::PoseMessage message;
        gazebo::Chain chain;
        glm::dvec3 position(0);
        glm::dquat orientation(1, 0, 0, 0);
        const uint32_t depth = 1 + uint32_t(round % 4);
        for (uint32_t id = 1; id <= depth; ++id) {
            const gazebo::Place place{{any(random), any(random), any(random)},
                                      glm::dquat(any(random), any(random), any(random), any(random))};
            const bool is_sent = any(random) > -5;
            if (is_sent) message.entities.insert(message.entities.begin(), {"link", {}, id, place});
            chain.parts.push_back({id, is_sent ? gazebo::Place{{9, 9, 9}, {1, 0, 0, 0}} : place});
            position += orientation * place.position;
            orientation = orientation * glm::normalize(place.orientation);
        }
        const types::Pose pose = gazebo::poseOfChain(message, chain, types::WorldFrame::AsIs);
        EXPECT_LT(glm::distance(pose.position, position), 1e-9);
        EXPECT_GT(std::abs(glm::dot(glm::normalize(pose.orientation), orientation)), 1 - 1e-12);
        const types::Pose kept = gazebo::poseOfChain({}, chain, types::WorldFrame::AsIs);
        EXPECT_EQ(kept.position, pose.position) << "of entities that a later message omits";
    }
}

TEST(FindStampTest, ATimeOfOurClockIsThatOfItsPosesOrBetweenThem) {
    const auto at = [](double seconds) { return types::Time::fromSeconds(seconds); };
    EXPECT_EQ(gazebo::findStamp("of_stamps", "", at(1)), std::nullopt);
    gazebo::noteStamp("of_stamps", "", at(1000), at(5));
    gazebo::noteStamp("of_stamps", "", at(1001), at(5.3));  // slower
    gazebo::noteStamp("of_stamps", "", at(1001.5), at(6.8));
    gazebo::noteStamp("of_stamps", "", at(1002), at(0));  // a reset
    gazebo::noteStamp("of_stamps", "", at(1003), at(1));
    for (const auto& [time, stamp] : std::vector<std::pair<double, double>>{{999, 4},
                                                                            {1000, 5},
                                                                            {1000.5, 5.15},
                                                                            {1001, 5.3},
                                                                            {1001.25, 6.05},
                                                                            {1001.5, 6.8},
                                                                            {1001.75, 7.05},
                                                                            {1002, 0},
                                                                            {1002.5, 0.5},
                                                                            {1003, 1},
                                                                            {1004, 2}})
        EXPECT_EQ(gazebo::findStamp("of_stamps", "", at(time)), at(stamp)) << time;
    EXPECT_EQ(gazebo::findStamp("of_stamps", "other", at(1000)), std::nullopt);
    gazebo::noteStamp("of_stamps", "", at(1001), at(3));  // our clock was set back
    EXPECT_EQ(gazebo::findStamp("of_stamps", "", at(1002)), at(4));
    for (int i = 0; i < 10'000; ++i) gazebo::noteStamp("of_stamps", "", at(2000 + i), at(i));
    EXPECT_EQ(gazebo::findStamp("of_stamps", "", at(11'000)), at(9000));
}
