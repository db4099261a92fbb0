#pragma once
// A simulation whose clock is paused, stepped, slowed, sped up and reset, as Gazebo's control of a world does it.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "tests/gazebo/HarmonicWorld.hpp"

namespace insonify::gazebo {

/** A crane whose joint turns an arm with a ball by 1 rad/s of simulated time, before a vehicle with a sonar.
 *
 *  Like Gazebo's scene broadcaster it sends the poses of all models, links and visuals, each in its parent and with its
 *  own name alone, 60 times a second of wall time, also while the world is paused. */
class SteppedWorld {
public:
    static constexpr double crane_x = 10, arm = 4, radius = 0.5;  ///< [m]
    static constexpr std::chrono::microseconds tick{16'667};

    SteppedWorld() : thread_([this] { run(); }) {}
    ~SteppedWorld() {
        stop_ = true;
        thread_.join();
    }
    SteppedWorld(const SteppedWorld&) = delete;
    SteppedWorld& operator=(const SteppedWorld&) = delete;

    /** Returns the SDF of the world; `sensor` is that of the vehicle's hull. */
    static std::string makeSdf(const std::string& sensor) {
        return "<sdf version='1.9'><world name='sea'>"
               "<model name='crane'><pose>10 0 0 0 0 0</pose><link name='base'/>"
               "<link name='boom'><visual name='crane'><pose>-4 0 0 0 0 0</pose><geometry><sphere><radius>0.5</radius>"
               "</sphere></geometry></visual></link>"
               "<joint name='hinge' type='revolute'><parent>base</parent><child>boom</child><axis><xyz>0 0 1</xyz>"
               "</axis></joint></model>"
               "<model name='rov'><link name='hull'>" +
               sensor + "</link></model></world></sdf>";
    }
    /** Returns the range of the ball's first echo at a time of the simulation [s], [m]. */
    static double computeRange(double time) {
        return std::sqrt(crane_x * crane_x + arm * arm - 2 * crane_x * arm * std::cos(time)) - radius;
    }

    void step(int milliseconds) {
        const std::lock_guard lock(mutex_);
        time_ += milliseconds * 1000;
    }
    /** Sets the simulated time per wall time; 0: paused. */
    void setFactor(double factor) {
        const std::lock_guard lock(mutex_);
        factor_ = factor;
    }
    void reset() {
        const std::lock_guard lock(mutex_);
        time_ = 0;
        sent_.clear();
    }
    /** Returns the stamps that were sent since the reset [us]. */
    std::set<int64_t> sent() const {
        const std::lock_guard lock(mutex_);
        return sent_;
    }

private:
    enum Number : uint32_t { Crane = 10, Base, Boom, Ball, Rov, Hull };

    static HarmonicWorld::Settings makeSettings() {
        wire::Scene scene;
        wire::Model& crane = *scene.add_model();
        crane.set_name("crane");
        crane.set_id(Crane);
        crane.mutable_pose()->mutable_position()->set_x(crane_x);
        for (const auto& [name, number] : {std::pair{"base", Base}, {"boom", Boom}}) {
            wire::Link& link = *crane.add_link();
            link.set_name(name);
            link.set_id(number);
        }
        wire::Visual& ball = *crane.mutable_link(1)->add_visual();
        ball.set_name("crane");  // as the model: Gazebo's names are unique among their siblings alone
        ball.mutable_pose()->mutable_position()->set_x(-arm);
        ball.mutable_geometry()->set_type(wire::Geometry::SPHERE);
        ball.mutable_geometry()->mutable_sphere()->set_radius(radius);
        wire::Model& rov = *scene.add_model();
        rov.set_name("rov");
        rov.set_id(Rov);
        wire::Link& hull = *rov.add_link();
        hull.set_name("hull");
        hull.set_id(Hull);
        return {.scene = scene.SerializeAsString()};
    }

    static std::string makePoses(int64_t time) {
        wire::PoseV message;
        message.mutable_header()->mutable_stamp()->set_sec(time / 1'000'000);
        message.mutable_header()->mutable_stamp()->set_nsec(static_cast<int32_t>(time % 1'000'000 * 1000));
        const auto add = [&](const char* name, Number number, double x, double yaw) {
            wire::Pose& pose = *message.add_pose();
            pose.set_name(name);
            pose.set_id(number);
            pose.mutable_position()->set_x(x);
            pose.mutable_orientation()->set_w(std::cos(yaw / 2));
            pose.mutable_orientation()->set_z(std::sin(yaw / 2));
        };
        add("crane", Crane, crane_x, 0);
        add("rov", Rov, 0, 0);
        add("base", Base, 0, 0);
        add("boom", Boom, 0, static_cast<double>(time) * 1e-6);
        add("hull", Hull, 0, 0);
        add("crane", Ball, -arm, 0);
        return message.SerializeAsString();
    }

    void run() {
        auto last = std::chrono::steady_clock::now();
        while (!stop_) {
            std::this_thread::sleep_until(last + tick);
            const auto now = std::chrono::steady_clock::now();
            const std::lock_guard lock(mutex_);
            time_ += std::llround(std::chrono::duration<double, std::micro>(now - last).count() * factor_);
            last = now;
            if (world_.publish(makePoses(time_))) sent_.insert(time_);
        }
    }

    HarmonicWorld world_{makeSettings()};
    mutable std::mutex mutex_;
    int64_t time_ = 0;  ///< Of the simulation [us].
    double factor_ = 0;
    std::set<int64_t> sent_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

}  // namespace insonify::gazebo
