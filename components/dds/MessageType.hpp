#pragma once
#include <array>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "components/ros/Samples.hpp"

namespace insonify::dds {

/** Appends the types of `More` that `List` lacks. */
template <class List, class More>
struct Joined;
template <class... Listed>
struct Joined<std::tuple<Listed...>, std::tuple<>> {
    using type = std::tuple<Listed...>;
};
template <class... Listed, class First, class... Rest>
struct Joined<std::tuple<Listed...>, std::tuple<First, Rest...>> {
    static constexpr bool known = (std::is_same_v<Listed, First> || ...);
    using Next = std::conditional_t<known, std::tuple<Listed...>, std::tuple<Listed..., First>>;
    using type = typename Joined<Next, std::tuple<Rest...>>::type;
};
template <class List, class Samples>
struct MessagesOfAll {
    using type = List;
};
template <class List, class First, class... Rest>
struct MessagesOfAll<List, std::tuple<First, Rest...>> {
    using Next = typename Joined<List, typename ros::MessagesOf<First>::type>::type;
    using type = typename MessagesOfAll<Next, std::tuple<Rest...>>::type;
};
/** All messages that samples can become, see ros/Samples.hpp. */
using SentMessages = MessagesOfAll<std::tuple<>, types::SampleTypes>::type;
inline constexpr size_t message_count = std::tuple_size_v<SentMessages>;

/** The type of a sent message: an index into SentMessages. */
enum class MessageType : size_t {};

/** Calls `use(std::type_identity<Message>{})` with the message of the given type. */
template <size_t i = 0, class Use>
decltype(auto) withMessage(MessageType type, Use&& use) {
    if constexpr (i + 1 < message_count)
        if (static_cast<size_t>(type) != i) return withMessage<i + 1>(type, use);
    return use(std::type_identity<std::tuple_element_t<i, SentMessages>>{});
}

template <class Message, size_t i = 0>
constexpr MessageType placeOf() {
    if constexpr (std::is_same_v<Message, std::tuple_element_t<i, SentMessages>>)
        return MessageType{i};
    else
        return placeOf<Message, i + 1>();
}
template <class Message>
inline constexpr MessageType message_type = placeOf<Message>();

/** Shortens "nav_msgs/msg/Odometry" to "nav_msgs/Odometry". */
template <class Message>
struct ShortName {
    static constexpr std::string_view whole{Message::type_name}, infix{"msg/"};
    static constexpr std::array<char, whole.size() - infix.size()> text = [] {
        std::array<char, whole.size() - infix.size()> kept{};
        const size_t cut = whole.find(infix);
        for (size_t i = 0; i < kept.size(); ++i) kept[i] = whole[i < cut ? i : i + infix.size()];
        return kept;
    }();
};
template <class Messages>
struct ShortNames;
template <class... Message>
struct ShortNames<std::tuple<Message...>> {
    static constexpr std::array<std::string_view, sizeof...(Message)> names{
        std::string_view(ShortName<Message>::text.data(), ShortName<Message>::text.size())...};
};

}  // namespace insonify::dds

template <>
struct insonify::types::EnumNames<insonify::dds::MessageType> {
    static constexpr auto names = insonify::dds::ShortNames<insonify::dds::SentMessages>::names;
};
