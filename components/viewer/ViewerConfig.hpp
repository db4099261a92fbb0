#pragma once
#include <arpa/inet.h>

#include <string>

#include "components/ros/Options.hpp"
#include "types/Describe.hpp"

namespace insonify::viewer {

struct ViewerConfig {
    int port = 8765;
    std::string address = "127.0.0.1";
    std::string token, token_file;
    int clients = 16;
    double idle_timeout = 30;
    bool control = true;
    int max_triangles = 500000;
    ros::WorldFrame world_frame = ros::WorldFrame::Enu;
    ros::SonarOptions messages;

    static void describe(auto& self, auto& visit) {
        visit({"port", "1", "TCP port of the page and of Foxglove; 0: any free port, printed in a notice", 0, 65535},
              self.port);
        visit({"address", "", "numeric address to listen on; an address other than loopback requires a token"},
              self.address);
        visit({"token", "", "required from clients: http://address:port/?token=...; empty: none"}, self.token);
        visit({"token_file", "",
               "a file whose first line is the token, relative to the deployment; logs then do not contain the token"},
              self.token_file);
        visit({"clients", "1", "max number of connected clients; others are refused", 1, 1000}, self.clients);
        visit({"idle_timeout", "s", "a client that has not answered for this long is disconnected", 1, 3600},
              self.idle_timeout);
        visit({"control", "", "whether pages may set properties, call operations and pause; else they only show"},
              self.control);
        visit({"max_triangles", "1",
               "max triangles of the page's scene; above, large meshes are coarse, small meshes omitted", 1000, 1e8},
              self.max_triangles);
        visit({"world_frame", "",
               "axes of poses for Foxglove: ours (x north, y west, z up), x east, y north, z up, or x north, y "
               "east, z down"},
              self.world_frame);
        visit({"messages", "", "how pings become messages for Foxglove; `scale` also applies to the page"},
              self.messages);
    }

    bool isLocal() const {
        in_addr v4{};
        return address == "::1" || (inet_pton(AF_INET, address.c_str(), &v4) == 1 && ntohl(v4.s_addr) >> 24 == 127);
    }
    bool isNumeric() const {
        in6_addr any{};
        return inet_pton(AF_INET, address.c_str(), &any) == 1 || inet_pton(AF_INET6, address.c_str(), &any) == 1;
    }
    void check(types::Diagnostics& diagnostics) const {
        if (!isNumeric())
            diagnostics.push_back(
                {"address", "is '" + address + "'; it must be a numeric address, such as 127.0.0.1, 0.0.0.0 or ::1"});
        else if (!isLocal() && token.empty() && token_file.empty())
            diagnostics.push_back({"token", "is missing; it is required because address is " + address +
                                                ", which other machines can reach"});
        if (!token.empty() && !token_file.empty())
            diagnostics.push_back({"token_file", "is given in addition to token; only one of them may be given"});
    }
};

}  // namespace insonify::viewer
